// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// Class, reflectance and instance of a surface.
struct Material {
  std::uint16_t class_id = 0;  ///< SemanticKITTI
  float reflectance = 0.3F;    ///< 0..1
  std::uint16_t instance = 0;  ///< 0 = none
};

/// A mesh with reflectances and instances, one value per triangle.
struct BuiltMesh {
  TriangleMesh mesh;
  std::vector<std::uint16_t> instances;
  std::vector<float> reflectances;
};

/// Collects triangles shape by shape. Metres. Surfaces are two-sided, so the order of corners does
/// not matter. Triangles under 1e-8 m2 are dropped.
class MeshBuilder {
 public:
  /// Sets the frame of the following shapes; `scale` stretches them along the frame's axes.
  void set_frame(const RigidTransform& world_from_shape, Vec3d scale = {1, 1, 1});
  /// Resets the frame to world coordinates, the initial state.
  void reset_frame() { stand_.reset(); }

  void triangle(Vec3d a, Vec3d b, Vec3d c, const Material& material);
  /// Corners in order around the quad.
  void quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, const Material& material);
  /// A convex polygon.
  void polygon(std::span<const Vec3d> corners, const Material& material);
  /// A box (parallelepiped) by its center and three half edges.
  void box(Vec3d center, Vec3d half_u, Vec3d half_v, Vec3d half_w, const Material& material);
  /// An axis-aligned box.
  void box(Vec3d low, Vec3d high, const Material& material);
  /// A rectangular beam without end faces. `half_side`: half width across the beam (horizontal
  /// unless the beam is vertical); `half_other`: half of the other width.
  void beam(Vec3d from, Vec3d to, double half_side, double half_other, const Material& material);
  /// A cone frustum along from-to, with end faces where the radius exceeds 2 mm.
  void tube(Vec3d from, Vec3d to, double radius_from, double radius_to, int sides,
            const Material& material);
  /// The surface through closed rings of equal size, with end faces.
  void loft(std::span<const std::vector<Vec3d>> rings, const Material& material);
  void ellipsoid(Vec3d center, Vec3d radii, int stacks, int slices, const Material& material);

  std::size_t triangle_count() const { return built_.mesh.triangles.size(); }
  BuiltMesh take() { return std::move(built_); }

 private:
  struct Stand {
    RigidTransform world_from_shape;
    Vec3d scale;
  };

  BuiltMesh built_;
  std::optional<Stand> stand_;
};

}  // namespace adasplats
