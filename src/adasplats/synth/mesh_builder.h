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

/// What a surface is made of and what it belongs to.
struct Material {
  std::uint16_t class_id = 0;  ///< SemanticKITTI
  float reflectance = 0.3F;    ///< 0..1
  std::uint16_t instance = 0;  ///< 0 = none
};

/// A mesh with what its triangles carry besides their class, one value a triangle.
struct BuiltMesh {
  TriangleMesh mesh;
  std::vector<std::uint16_t> instances;
  std::vector<float> reflectances;
};

/// Collects triangles shape by shape. Metres; both sides of a surface count, so the order of
/// corners does not matter. Triangles under 1e-8 m2 are left out.
class MeshBuilder {
 public:
  /// Where the shapes that follow stand: they are given in a frame of their own, stretched by
  /// `scale` along its axes.
  void stand_at(const RigidTransform& world_from_shape, Vec3d scale = {1, 1, 1});
  /// Shapes are given in world coordinates again, as they are at first.
  void stand_in_world() { stand_.reset(); }

  void triangle(Vec3d a, Vec3d b, Vec3d c, const Material& material);
  /// Corners in order around the quad.
  void quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, const Material& material);
  /// A convex polygon.
  void polygon(std::span<const Vec3d> corners, const Material& material);
  /// A box (parallelepiped) by its centre and three half edges.
  void box(Vec3d center, Vec3d half_u, Vec3d half_v, Vec3d half_w, const Material& material);
  /// A box along the axes.
  void box(Vec3d low, Vec3d high, const Material& material);
  /// A beam of rectangular section without end faces: `half_side` is half the section's edge across
  /// the beam (level where the beam is not upright), half_other the other.
  void beam(Vec3d from, Vec3d to, double half_side, double half_other, const Material& material);
  /// A cone frustum about the axis from-to, with end faces where the radius is more than 2 mm.
  void tube(Vec3d from, Vec3d to, double radius_from, double radius_to, int sides,
            const Material& material);
  /// The skin over closed rings of equal size, end faces included.
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
