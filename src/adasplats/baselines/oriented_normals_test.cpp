// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/oriented_normals.h"

#include <gtest/gtest.h>

#include "adasplats/baselines/nearest_classes.h"
#include "adasplats/baselines/shapes_test.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

const Executor& three_threads() {
  static const Executor threads(3);
  return threads;
}

/// Minimum dot product of normals and the expected ones.
float worst(const std::vector<Vec3f>& normals, const OrientedPoints& points, float sign = 1) {
  float min_dot = 2;
  for (std::size_t i = 0; i < normals.size(); ++i)
    min_dot = std::min(min_dot, sign * dot(normals[i], points.normals[i]));
  return min_dot;
}

// Oracle of the next three: the sphere's normals.
TEST(OrientedNormals, FaceTheSensor) {
  const OrientedPoints points = sphere({1, 2, 3}, 2, 5000);
  const std::vector<Vec3f> center(points.positions.size(), {1, 2, 3});
  const auto inside = oriented_normals(points.positions, center, {}, three_threads());
  EXPECT_TRUE(inside.from_sensors);
  EXPECT_GT(worst(inside.normals, points, -1), 0.99F);
  std::vector<Vec3f> around;
  for (std::size_t i = 0; i < points.positions.size(); ++i)
    around.push_back(points.positions[i] + 3.0F * points.normals[i]);
  EXPECT_GT(worst(oriented_normals(points.positions, around, {}, three_threads()).normals, points),
            0.99F);
}

TEST(OrientedNormals, SpreadOverASphere) {
  const OrientedPoints points = sphere({1, 2, 3}, 2, 5000);
  const auto spread = oriented_normals(points.positions, {}, {}, three_threads());
  EXPECT_FALSE(spread.from_sensors);
  EXPECT_EQ(spread.components, 1U);
  EXPECT_GT(worst(spread.normals, points), 0.99F);
}

TEST(OrientedNormals, SpreadOverSeveralParts) {
  OrientedPoints points = sphere({0, 0, 0}, 1, 2000);
  points.add(sphere({10, 0, 0}, 2, 3000));
  points.add(square(1, 30, -20));
  const auto spread = oriented_normals(points.positions, {}, {}, three_threads());
  EXPECT_EQ(spread.components, 3U);
  EXPECT_GT(worst(spread.normals, points), 0.98F);
}

TEST(OrientedNormals, SameForEveryNumberOfThreads) {
  OrientedPoints points = sphere({0, 0, 0}, 1, 20000);
  points.add(square(3, 100, 0.5F));
  const auto first = oriented_normals(points.positions, {}, {}, Executor(1));
  for (const int threads : {2, 5})
    EXPECT_EQ(oriented_normals(points.positions, {}, {}, Executor(threads)).normals, first.normals);
}

TEST(OrientedNormals, FewAndEqualPoints) {
  EXPECT_TRUE(oriented_normals({}, {}, {}, three_threads()).normals.empty());
  for (const std::size_t count : {1U, 2U, 1000U}) {
    const std::vector<Vec3f> points(count, {1, 1, 1});
    for (const auto& sensors : {std::vector<Vec3f>{}, std::vector<Vec3f>(count, {1, 1, 1})}) {
      const auto found = oriented_normals(points, sensors, {}, three_threads());
      ASSERT_EQ(found.normals.size(), count);
      for (const Vec3f n : found.normals) EXPECT_NEAR(length(n), 1, 1e-5F);
    }
  }
  EXPECT_THROW(oriented_normals({}, {}, {2, 10}, three_threads()), Error);
}

// Oracle: nearest by hand.
TEST(NearestClasses, UsesTheCentroid) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {9, 9, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  const std::vector<Vec3f> points = {{0, 0, 0}, {1.1F, 1, 0}, {4, 4, 0.5F}};
  const std::vector<std::uint16_t> classes = {40, 50, 80};
  EXPECT_EQ(nearest_classes(mesh, points, classes, three_threads()),
            (std::vector<std::uint16_t>{50, 80}));
  EXPECT_TRUE(nearest_classes(mesh, {}, {}, three_threads()).empty());
  EXPECT_TRUE(nearest_classes({}, points, classes, three_threads()).empty());
}

}  // namespace
}  // namespace adasplats
