// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/mesh_builder.h"

#include <array>
#include <cmath>
#include <numbers>

namespace adasplats {
namespace {

constexpr double kMinArea_m2 = 1e-8;  // m2
constexpr double kCircle = 2 * std::numbers::pi;

double area(Vec3f a, Vec3f b, Vec3f c) {
  return 0.5 * length(vec_cast<double>(cross(b - a, c - a)));
}

/// A horizontal unit vector perpendicular to `axis`, or +x for a vertical axis.
Vec3d level_side(Vec3d axis) {
  const Vec3d side = cross(axis, Vec3d{0, 0, 1});
  return length(side) < 1e-6 * length(axis) ? Vec3d{1, 0, 0} : normalized(side);
}

std::vector<Vec3d> ring_about(Vec3d center, Vec3d u, Vec3d v, int sides) {
  std::vector<Vec3d> ring(static_cast<std::size_t>(sides));
  for (int k = 0; k < sides; ++k) {
    const double angle = kCircle * k / sides;
    ring[static_cast<std::size_t>(k)] = center + std::cos(angle) * u + std::sin(angle) * v;
  }
  return ring;
}

}  // namespace

void MeshBuilder::set_frame(const RigidTransform& world_from_shape, Vec3d scale) {
  stand_ = {world_from_shape, scale};
}

void MeshBuilder::triangle(Vec3d a, Vec3d b, Vec3d c, const Material& material) {
  const std::array<Vec3d, 3> corners = {a, b, c};
  polygon(corners, material);
}

void MeshBuilder::quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, const Material& material) {
  const std::array<Vec3d, 4> corners = {a, b, c, d};
  polygon(corners, material);
}

void MeshBuilder::polygon(std::span<const Vec3d> corners, const Material& material) {
  TriangleMesh& mesh = built_.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& corner : corners) {
    const Vec3d in_world = stand_ ? stand_->world_from_shape * Vec3d{stand_->scale.x * corner.x,
                                                                     stand_->scale.y * corner.y,
                                                                     stand_->scale.z * corner.z}
                                  : corner;
    mesh.vertices.push_back(vec_cast<float>(in_world));
  }
  bool any = false;
  for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) {
    const std::array<std::uint32_t, 3> t = {first, first + k, first + k + 1};
    // Tested after rounding to float: far from zero a sliver may lose its area.
    if (!(area(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) > kMinArea_m2))
      continue;
    any = true;
    mesh.triangles.push_back(t);
    mesh.classes.push_back(material.class_id);
    built_.instances.push_back(material.instance);
    built_.reflectances.push_back(material.reflectance);
  }
  if (!any) mesh.vertices.resize(first);
}

void MeshBuilder::box(Vec3d center, Vec3d half_u, Vec3d half_v, Vec3d half_w,
                      const Material& material) {
  const auto side = [&](Vec3d out, Vec3d a, Vec3d b) {
    quad(center + out - a - b, center + out + a - b, center + out + a + b, center + out - a + b,
         material);
  };
  side(half_u, half_v, half_w);
  side(-half_u, half_v, half_w);
  side(half_v, half_u, half_w);
  side(-half_v, half_u, half_w);
  side(half_w, half_u, half_v);
  side(-half_w, half_u, half_v);
}

void MeshBuilder::box(Vec3d low, Vec3d high, const Material& material) {
  const Vec3d half = (high - low) * 0.5;
  box(low + half, {half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z}, material);
}

void MeshBuilder::beam(Vec3d from, Vec3d to, double half_side, double half_other,
                       const Material& material) {
  const Vec3d axis = to - from;
  const Vec3d u = level_side(axis) * half_side;
  const Vec3d v = normalized(cross(axis, u)) * half_other;
  const std::array<Vec3d, 4> corners = {u + v, u - v, -u - v, v - u};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3d a = corners[k];
    const Vec3d b = corners[(k + 1) % 4];
    quad(from + a, from + b, to + b, to + a, material);
  }
}

void MeshBuilder::tube(Vec3d from, Vec3d to, double radius_from, double radius_to, int sides,
                       const Material& material) {
  const Vec3d axis = to - from;
  const Vec3d u = level_side(axis);
  const Vec3d v = normalized(cross(axis, u));
  const std::array<std::vector<Vec3d>, 2> rings = {
      ring_about(from, radius_from * u, radius_from * v, sides),
      ring_about(to, radius_to * u, radius_to * v, sides)};
  loft(rings, material);
}

void MeshBuilder::loft(std::span<const std::vector<Vec3d>> rings, const Material& material) {
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    const std::size_t n = rings[r].size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = (k + 1) % n;
      quad(rings[r][k], rings[r][next], rings[r + 1][next], rings[r + 1][k], material);
    }
  }
  polygon(rings.front(), material);
  polygon(rings.back(), material);
}

void MeshBuilder::ellipsoid(Vec3d center, Vec3d radii, int stacks, int slices,
                            const Material& material) {
  const auto at = [&](int stack, int slice) {
    const double polar = std::numbers::pi * stack / stacks;
    const double azimuth = kCircle * slice / slices;
    return center + Vec3d{radii.x * std::sin(polar) * std::cos(azimuth),
                          radii.y * std::sin(polar) * std::sin(azimuth), radii.z * std::cos(polar)};
  };
  for (int i = 0; i < stacks; ++i)
    for (int k = 0; k < slices; ++k)
      quad(at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k), material);
}

}  // namespace adasplats
