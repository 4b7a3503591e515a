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

/// Where scans are simulated: a model or a mesh in memory (ModelScene), or a city whose tiles come
/// and go (CityScene), with what was put there.
class ScanScene {
 public:
  virtual ~ScanScene() = default;

  /// World coordinates of the local origin, m.
  virtual Vec3d origin() const = 0;
  /// Of the place without its objects.
  virtual const SceneCaster& scan_caster() const = 0;
  /// What was put into the place; null where nothing was.
  virtual const World* world() const = 0;
  /// What the classes mean; null where that is not known.
  virtual const LabelScheme* labels() const = 0;
  /// What primitives carry; shared by all sensors in the place.
  virtual std::shared_ptr<const PrimitiveTable> primitive_table() const = 0;
  /// Of place and objects; 0 where there is none.
  virtual float highest_intensity() const = 0;
  /// World box of the middle 98 % of the splats or vertices along each axis, or a larger one.
  virtual std::pair<Vec3d, Vec3d> middle_box() const = 0;

  /// Makes ready what the first of some scans meet whose rays are `reach_m` long, and gives how
  /// many of them, at least one where there is one. To be called before they are cast, while
  /// nothing is.
  virtual std::size_t prefetch(std::span<const ScanMotion> scans, double reach_m) const = 0;
};

}  // namespace adasplats
