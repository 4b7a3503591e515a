// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

/// Triangles, with a semantic class each.
struct TriangleMesh {
  std::vector<Vec3f> vertices;                          ///< relative to the scene's origin, m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertex indices
  std::vector<std::uint16_t> classes;                   ///< one per triangle, or empty

  Triangle triangle(std::size_t i) const {
    const auto& t = triangles[i];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

/// The geometry that tracers build their trees from. Holds views; the owner must outlive it.
/// Primitive indices: splats first, then triangles.
struct SceneView {
  std::span<const Disk> disks;
  const TriangleMesh* mesh = nullptr;
  /// One per disk, of its centre (scene/soft_disk.h); empty: disks are opaque.
  std::span<const float> opacities = {};

  std::size_t disk_count() const { return disks.size(); }
  std::size_t triangle_count() const { return mesh == nullptr ? 0 : mesh->triangles.size(); }
  std::size_t primitive_count() const { return disk_count() + triangle_count(); }

  /// A disk's normal, or the unit normal of a triangle: 0 if it has no area.
  Vec3f unit_normal(std::size_t primitive) const {
    if (primitive < disk_count()) return disks[primitive].normal;
    if (mesh == nullptr) return {};
    const Triangle t = mesh->triangle(primitive - disk_count());
    const Vec3f normal = cross(t.b - t.a, t.c - t.a);
    const float doubled_area = length(normal);
    return doubled_area > 0 ? normal / doubled_area : Vec3f{};
  }
};

}  // namespace adasplats
