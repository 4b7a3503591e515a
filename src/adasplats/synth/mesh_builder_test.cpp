// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/mesh_builder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "adasplats/core/constants.h"

namespace adasplats {
namespace {

double area_of(const BuiltMesh& built) {
  double area = 0;
  for (std::size_t i = 0; i < built.mesh.triangles.size(); ++i) {
    const Triangle t = built.mesh.triangle(i);
    area += 0.5 * static_cast<double>(length(cross(t.b - t.a, t.c - t.a)));
  }
  return area;
}

// Oracle: the area of a box.
TEST(MeshBuilder, BoxHasSixSides) {
  MeshBuilder builder;
  builder.box({1, 2, 3}, {3, 5, 7}, {50, 0.5F, 9});
  const BuiltMesh built = builder.take();
  EXPECT_EQ(built.mesh.triangles.size(), 12U);
  EXPECT_NEAR(area_of(built), 2 * (2 * 3 + 3 * 4 + 4 * 2), 1e-5);
  for (const std::uint16_t c : built.mesh.classes) EXPECT_EQ(c, 50);
  for (const std::uint16_t i : built.instances) EXPECT_EQ(i, 9);
  for (const float r : built.reflectances) EXPECT_EQ(r, 0.5F);
}

// Oracle: a box turned by 30 degrees keeps its area and its corners' distances from the center.
TEST(MeshBuilder, TurnedBoxKeepsItsSize) {
  const double c = std::cos(0.5236);
  const double s = std::sin(0.5236);
  MeshBuilder builder;
  builder.box(Vec3d{10, 20, 30}, Vec3d{c, s, 0} * 2.0, Vec3d{-s, c, 0}, Vec3d{0, 0, 0.5}, {});
  const BuiltMesh built = builder.take();
  EXPECT_NEAR(area_of(built), 2 * (4 * 2 + 2 * 1 + 1 * 4), 1e-4);
  for (const Vec3f& v : built.mesh.vertices)
    EXPECT_NEAR(length(vec_cast<double>(v) - Vec3d{10, 20, 30}), std::sqrt(4 + 1 + 0.25), 1e-5);
}

// Oracle: the area of a prism over a regular polygon.
TEST(MeshBuilder, TubeIsAPrism) {
  constexpr int kSides = 12;
  const double side = 2 * std::sin(std::numbers::pi / kSides);
  const double cap = 0.5 * kSides * std::sin(2 * std::numbers::pi / kSides);
  for (const Vec3d to : {Vec3d{0, 0, 3}, Vec3d{3, 0, 0}, Vec3d{1, 2, -2}}) {
    MeshBuilder builder;
    builder.tube({0, 0, 0}, to, 1, 1, kSides, {});
    EXPECT_NEAR(area_of(builder.take()), kSides * side * 3 + 2 * cap, 1e-5);
  }
}

TEST(MeshBuilder, BeamHasFourSidesWhereverItPoints) {
  for (const Vec3d to : {Vec3d{0, 0, 2}, Vec3d{2, 0, 0}, Vec3d{0, -2, 0}}) {
    MeshBuilder builder;
    builder.beam({0, 0, 0}, to, 0.1, 0.05, {});
    EXPECT_NEAR(area_of(builder.take()), 2 * (0.2 + 0.1) * 2, 1e-6);
  }
}

// Oracle: the analytic area of a sphere, approached from below.
TEST(MeshBuilder, FineEllipsoidIsASphere) {
  MeshBuilder builder;
  builder.ellipsoid({5, 5, 5}, {2, 2, 2}, 60, 120, {});
  const double area = area_of(builder.take());
  EXPECT_LT(area, 4 * std::numbers::pi * 4);
  EXPECT_GT(area, 4 * std::numbers::pi * 4 * 0.998);
}

TEST(MeshBuilder, DropsDegenerateTriangles) {
  MeshBuilder builder;
  builder.triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {});
  builder.triangle({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {});
  builder.triangle({0, 0, 0}, {1, 0, 0}, {0, kNaN, 0}, {});
  builder.beam({1, 1, 1}, {1, 1, 1}, 0.1, 0.1, {});
  EXPECT_EQ(builder.triangle_count(), 0U);
  builder.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {});  // one half has no area
  EXPECT_EQ(builder.triangle_count(), 1U);
  const BuiltMesh built = builder.take();
  for (const auto& t : built.mesh.triangles)
    for (const std::uint32_t v : t) EXPECT_LT(v, built.mesh.vertices.size());
}

}  // namespace
}  // namespace adasplats
