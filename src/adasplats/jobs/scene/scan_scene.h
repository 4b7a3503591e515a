// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/world/scene_caster.h"

namespace adasplats {

/// A scene that scans are simulated in: a model or a mesh in memory (ModelScene), or a city whose
/// tiles are loaded on demand (CityScene), with the objects that were added.
class ScanScene {
 public:
  virtual ~ScanScene() = default;

  /// World coordinates of the local origin, m.
  virtual Vec3d origin() const = 0;
  /// Casts rays into the model or mesh, without the objects.
  virtual const SceneCaster& scan_caster() const = 0;
  /// The objects; null if there are none.
  virtual const World* world() const = 0;
  /// The scheme of the classes; null if there is none.
  virtual const LabelScheme* labels() const = 0;
  /// The attributes of primitives, shared by all sensors.
  virtual std::shared_ptr<const PrimitiveTable> primitive_table() const = 0;
  /// Whether a ray ends at the most likely surface of soft splats (SoftHits).
  virtual bool has_opacities() const { return false; }
  /// Of model and objects; 0 if there are no intensities.
  virtual float highest_intensity() const = 0;
  /// World box of the middle 98 % of the splats or vertices along each axis, or a larger one.
  virtual std::pair<Vec3d, Vec3d> middle_box() const = 0;

  /// Loads what the rays of the first of these scans, `reach_m` long, can hit, and returns for how
  /// many scans: at least one unless `scans` is empty. To be called before they are cast, while no
  /// rays are cast.
  virtual std::size_t prefetch(std::span<const ScanMotion> scans, double reach_m) const = 0;
};

/// The smallest usual scale of intensities that the scene does not exceed: 1, 255 or 65535.
double scale_of_intensities(const ScanScene& scene);

}  // namespace adasplats
