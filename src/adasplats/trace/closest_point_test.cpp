// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

Vec3f random_point(Random& random, double half_m, Vec3d center = {}) {
  const double x = random.uniform(-half_m, half_m);
  const double y = random.uniform(-half_m, half_m);
  return vec_cast<float>(center + Vec3d{x, y, random.uniform(-half_m, half_m)});
}

/// Triangles of all sizes around `center`; a part of them has no area, and some occur twice.
TriangleMesh random_mesh(std::size_t count, Vec3d center) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    Random random(3, 0, i);
    const double half_m = std::exp(random.uniform(-5, 2));
    const Vec3d middle = vec_cast<double>(random_point(random, 10, center));
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(random_point(random, half_m, middle));
    if (i % 10 == 7) mesh.vertices.back() = mesh.vertices[mesh.vertices.size() - 2];
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    if (i % 10 == 9) mesh.triangles.back() = mesh.triangles[i - 1];
  }
  return mesh;
}

/// Two triangles a cell of a grid in the plane z = 0: edges and corners are shared.
TriangleMesh grid(std::uint32_t side) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= side; ++i)
    for (std::uint32_t j = 0; j <= side; ++j)
      mesh.vertices.push_back({static_cast<float>(i), static_cast<float>(j), 0});
  for (std::uint32_t i = 0; i < side; ++i) {
    for (std::uint32_t j = 0; j < side; ++j) {
      const std::uint32_t corner = i * (side + 1) + j;
      mesh.triangles.push_back({corner, corner + 1, corner + side + 1});
      mesh.triangles.push_back({corner + 1, corner + side + 2, corner + side + 1});
    }
  }
  return mesh;
}

/// The oracle: all triangles, the first of the nearest.
SurfaceDistance brute_force(const TriangleMesh& mesh, Vec3f point) {
  float best = HUGE_VALF;
  SurfaceDistance result;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const float squared = squared_distance(point, mesh.triangle(i));
    if (squared < best) {
      best = squared;
      result = {std::sqrt(squared), i};
    }
  }
  return result;
}

void expect_brute_force(const TriangleMesh& mesh, const std::vector<Vec3f>& points) {
  for (const int threads : {1, 3}) {
    const Executor executor(threads);
    const std::vector<SurfaceDistance> found = ClosestPoint(mesh, executor).of(points, executor);
    ASSERT_EQ(found.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const SurfaceDistance expected = brute_force(mesh, points[i]);
      ASSERT_EQ(found[i].distance_m, expected.distance_m) << "point " << i;
      ASSERT_EQ(found[i].triangle, expected.triangle) << "point " << i;
    }
  }
}

// Analytic: one point for each part of a triangle that can be the nearest.
TEST(SquaredDistance, InsideEdgesAndCorners) {
  const Triangle t = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  EXPECT_EQ(squared_distance({1, 1, 3}, t), 9.0F);
  EXPECT_EQ(squared_distance({1, 1, 0}, t), 0.0F);
  EXPECT_EQ(squared_distance({2, -3, 0}, t), 9.0F);
  EXPECT_EQ(squared_distance({-3, 1, -4}, t), 25.0F);
  EXPECT_EQ(squared_distance({4, 4, 0}, t), 8.0F);
  EXPECT_EQ(squared_distance({-1, -2, 2}, t), 9.0F);
  EXPECT_EQ(squared_distance({7, 0, 4}, t), 25.0F);
  EXPECT_EQ(squared_distance({0, 6, 0}, t), 4.0F);
}

TEST(SquaredDistance, TrianglesWithoutArea) {
  EXPECT_EQ(squared_distance({1, 3, 0}, {{0, 0, 0}, {4, 0, 0}, {2, 0, 0}}), 9.0F);
  EXPECT_EQ(squared_distance({7, 4, 0}, {{0, 0, 0}, {4, 0, 0}, {2, 0, 0}}), 25.0F);
  EXPECT_EQ(squared_distance({1, 2, 4}, {{1, 2, 2}, {1, 2, 2}, {1, 2, 2}}), 4.0F);
}

// Oracle: the smallest distance to a fine sample of the triangle, which is at most a step too far.
TEST(SquaredDistance, EqualsSampling) {
  constexpr int kSteps = 200;
  for (std::uint64_t i = 0; i < 100; ++i) {
    Random random(5, 0, i);
    const Triangle t = {random_point(random, 2), random_point(random, 2), random_point(random, 2)};
    const Vec3f p = random_point(random, 3);
    double nearest_m = static_cast<double>(HUGE_VALF);
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; u + v <= kSteps; ++v) {
        const Vec3d a = vec_cast<double>(t.a);
        const Vec3d sample = a + (vec_cast<double>(t.b) - a) * (u * 1.0 / kSteps) +
                             (vec_cast<double>(t.c) - a) * (v * 1.0 / kSteps);
        nearest_m = std::min(nearest_m, length(sample - vec_cast<double>(p)));
      }
    }
    const double found_m = std::sqrt(static_cast<double>(squared_distance(p, t)));
    EXPECT_LE(found_m, nearest_m + 1e-6);
    EXPECT_GE(found_m, nearest_m - 7.0 / kSteps);
  }
}

TEST(ClosestPoint, EqualsBruteForce) {
  for (const Vec3d center : {Vec3d{}, Vec3d{800, -900, 100}}) {
    const TriangleMesh mesh = random_mesh(400, center);
    std::vector<Vec3f> points = mesh.vertices;  // at distance 0 from one or more triangles
    for (std::uint64_t i = 0; i < 500; ++i) {
      Random random(4, 0, i);
      points.push_back(random_point(random, std::exp(random.uniform(-3, 14)), center));
    }
    expect_brute_force(mesh, points);
  }
}

TEST(ClosestPoint, SharedEdgesAndCornersGoToTheSmallerIndex) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j)
      for (const float z : {0.0F, 0.25F, -30.0F})
        points.push_back({static_cast<float>(i) * 0.25F, static_cast<float>(j) * 0.25F, z});
  expect_brute_force(grid(10), points);
}

TEST(ClosestPoint, ManyEqualTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(1000, {0, 1, 2});
  expect_brute_force(mesh, {{0.25F, 0.25F, 1}, {0.25F, 0.25F, 0}, {5, 5, 5}});
}

TEST(ClosestPoint, MeshesWithoutTrianglesAndPointsOutOfRange) {
  const Executor executor(1);
  const TriangleMesh empty;
  const SurfaceDistance none =
      ClosestPoint(empty, executor).of(std::vector<Vec3f>{{1, 2, 3}}, executor)[0];
  EXPECT_EQ(none.triangle, SurfaceDistance::kNone);
  EXPECT_EQ(none.distance_m, HUGE_VALF);
  const TriangleMesh mesh = grid(1);
  const ClosestPoint closest(mesh, executor);
  EXPECT_TRUE(closest.of({}, executor).empty());
  for (const Vec3f bad : {Vec3f{kNaN, 0, 0}, Vec3f{0, HUGE_VALF, 0}, Vec3f{0, 0, -2e18F}})
    EXPECT_EQ(closest.of(std::vector<Vec3f>{bad}, executor)[0].triangle, SurfaceDistance::kNone);
}

}  // namespace
}  // namespace adasplats
