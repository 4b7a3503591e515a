// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/scene/intersect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Ray ray_from(Vec3f origin, Vec3f direction) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  return ray;
}

Vec3d random_unit(Random& random) {
  Vec3d v;
  do {
    v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  } while (dot(v, v) > 1 || dot(v, v) < 1e-3);
  return normalized(v);
}

// Oracle of the tests here, unless stated otherwise: analytic.

TEST(IntersectDisk, HitsInsideTheRadiusFromBothSides) {
  const Disk disk = {{0, 0, 5}, 2.0F, {0, 0, 1}};
  EXPECT_EQ(intersect_disk(ray_from({0, 0, 0}, {0, 0, 1}), disk), 5.0F);
  EXPECT_EQ(intersect_disk(ray_from({0, 0, 9}, {0, 0, -1}), disk), 4.0F);
  EXPECT_EQ(intersect_disk(ray_from({1.99F, 0, 0}, {0, 0, 1}), disk), 5.0F);
  EXPECT_EQ(intersect_disk(ray_from({2.01F, 0, 0}, {0, 0, 1}), disk), kInfinity);
}

TEST(IntersectDisk, TheRimItselfIsOutside) {
  const Disk disk = {{0, 0, 5}, 2.0F, {0, 0, 1}};
  EXPECT_EQ(intersect_disk(ray_from({2, 0, 0}, {0, 0, 1}), disk), kInfinity);
}

TEST(IntersectDisk, NothingBehindTheOriginCounts) {
  const Disk disk = {{0, 0, 5}, 2.0F, {0, 0, 1}};
  EXPECT_EQ(intersect_disk(ray_from({0, 0, 0}, {0, 0, -1}), disk), kInfinity);
  EXPECT_EQ(intersect_disk(ray_from({0, 0, 5}, {0, 0, 1}), disk), kInfinity) << "t = 0";
}

TEST(IntersectDisk, TheRangeIsOpenBelowAndClosedAbove) {
  const Disk disk = {{0, 0, 5}, 2.0F, {0, 0, 1}};
  Ray ray = ray_from({0, 0, 0}, {0, 0, 1});
  ray.t_max = 5.0F;
  EXPECT_EQ(intersect_disk(ray, disk), 5.0F);
  ray.t_min = 5.0F;
  EXPECT_EQ(intersect_disk(ray, disk), kInfinity);
  ray.t_min = 0.0F;
  ray.t_max = std::nextafter(5.0F, 0.0F);
  EXPECT_EQ(intersect_disk(ray, disk), kInfinity);
}

TEST(IntersectDisk, ARayInThePlaneOrParallelToItMisses) {
  const Disk disk = {{5, 0, 0}, 2.0F, {0, 0, 1}};
  EXPECT_EQ(intersect_disk(ray_from({0, 0, 0}, {1, 0, 0}), disk), kInfinity) << "0 / 0";
  EXPECT_EQ(intersect_disk(ray_from({0, 0, 1}, {1, 0, 0}), disk), kInfinity) << "x / 0";
}

TEST(IntersectDisk, NaNIsAMiss) {
  const Disk disk = {{0, 0, 5}, 2.0F, {0, 0, 1}};
  const Ray ray = ray_from({0, 0, 0}, {0, 0, 1});
  EXPECT_EQ(intersect_disk(ray_from({kNaN, 0, 0}, {0, 0, 1}), disk), kInfinity);
  EXPECT_EQ(intersect_disk(ray_from({0, 0, 0}, {0, kNaN, 1}), disk), kInfinity);
  EXPECT_EQ(intersect_disk(ray, {{0, 0, kNaN}, 2.0F, {0, 0, 1}}), kInfinity);
  EXPECT_EQ(intersect_disk(ray, {{0, 0, 5}, kNaN, {0, 0, 1}}), kInfinity);
  EXPECT_EQ(intersect_disk(ray, {{0, 0, 5}, 2.0F, {0, 0, 0}}), kInfinity) << "no normal";
}

TEST(DiskHalfExtent, IsExactUpToItsMarginForOneTiltedDisk) {
  const Disk disk = {{0, 0, 0}, 2.0F, {0.6F, 0, 0.8F}};
  const Vec3f half = disk_half_extent(disk);
  const float margin = box_margin(2.0F);
  EXPECT_NEAR(half.x, 1.6F + margin, 1e-6);
  EXPECT_NEAR(half.y, 2.0F + margin, 1e-6);
  EXPECT_NEAR(half.z, 1.2F + margin, 1e-6);
}

// 1 - n_z^2 is 0 in float where n_z rounds to 1; the disk still rises by r n_x.
TEST(DiskHalfExtent, KeepsTheSlopeOfADiskThatNearlyFacesAnAxis) {
  const Disk disk = {{0, 0, 0}, 1000.0F, {1e-4F, 0, 1.0F}};
  EXPECT_GE(disk_half_extent(disk).z, 0.1F);
  EXPECT_LE(disk_half_extent(disk).z, 0.11F);
}

// Oracle: points of the rim in double precision.
TEST(DiskHalfExtent, HoldsEveryPointOfTheRimAndIsTight) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Random random(1, 0, i);
    const Vec3d n = random_unit(random);
    const double r = std::pow(10.0, random.uniform(-3, 3));
    const Vec3d side = normalized(cross(n, std::fabs(n.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
    const Vec3d up = cross(n, side);
    const Vec3f half = disk_half_extent({{0, 0, 0}, static_cast<float>(r), vec_cast<float>(n)});
    Vec3d reached;
    for (int k = 0; k < 720; ++k) {
      const double angle = k * 3.141592653589793 / 360;
      const Vec3d p = r * (std::cos(angle) * side + std::sin(angle) * up);
      reached = max(reached, p);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double margin = static_cast<double>(box_margin(static_cast<float>(r)));
      EXPECT_GE(static_cast<double>(half[axis]), reached[axis]);
      EXPECT_LE(static_cast<double>(half[axis]), reached[axis] + 1.1 * margin + 1e-4 * r);
    }
  }
}

// The margin suffices: every hit of intersect_disk is in the padded box.
TEST(DiskHalfExtent, HoldsEveryHitOfGrazingRays) {
  int hits = 0;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    Random random(2, 0, i);
    const Vec3d n = random_unit(random);
    const Disk disk = {vec_cast<float>(800.0 * random_unit(random)),
                       static_cast<float>(random.uniform(0.01, 5)), vec_cast<float>(n)};
    const Vec3d along = normalized(cross(n, random_unit(random)));
    const double slope = std::pow(10.0, random.uniform(-6, 0));
    const Vec3d d = normalized(along + slope * n);
    const Vec3d target = vec_cast<double>(disk.center) +
                         random.uniform(-1, 1) * static_cast<double>(disk.radius) * along;
    const Ray ray =
        ray_from(vec_cast<float>(target - random.uniform(1, 1000) * d), vec_cast<float>(d));
    const float t = intersect_disk(ray, disk);
    if (t == kInfinity) continue;
    ++hits;
    const Vec3d p =
        vec_cast<double>(ray.origin) + static_cast<double>(t) * vec_cast<double>(ray.direction);
    const Vec3f half = disk_half_extent(disk);
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_LT(std::fabs(p[axis] - static_cast<double>(disk.center[axis])),
                static_cast<double>(half[axis]))
          << "ray " << i;
  }
  EXPECT_GT(hits, 10'000);
}

TEST(IntersectTriangle, HitsInsideOnTheRimAndFromBothSides) {
  const Triangle triangle = {{0, 0, 5}, {4, 0, 5}, {0, 4, 5}};
  EXPECT_EQ(intersect_triangle(ray_from({1, 1, 0}, {0, 0, 1}), triangle), 5.0F);
  EXPECT_EQ(intersect_triangle(ray_from({1, 1, 7}, {0, 0, -1}), triangle), 2.0F);
  EXPECT_EQ(intersect_triangle(ray_from({0, 0, 0}, {0, 0, 1}), triangle), 5.0F) << "corner";
  EXPECT_EQ(intersect_triangle(ray_from({2, 2, 0}, {0, 0, 1}), triangle), 5.0F) << "edge";
  EXPECT_EQ(intersect_triangle(ray_from({2.1F, 2, 0}, {0, 0, 1}), triangle), kInfinity);
  EXPECT_EQ(intersect_triangle(ray_from({1, 1, 0}, {0, 0, -1}), triangle), kInfinity);
  EXPECT_EQ(intersect_triangle(ray_from({1, 1, 0}, {1, 0, 0}), triangle), kInfinity) << "parallel";
}

TEST(IntersectTriangle, EveryAxisMayBeTheLongest) {
  EXPECT_EQ(intersect_triangle(ray_from({0, 1, 1}, {1, 0, 0}), {{5, 0, 0}, {5, 4, 0}, {5, 0, 4}}),
            5.0F);
  EXPECT_EQ(
      intersect_triangle(ray_from({1, 0, 1}, {0, -1, 0}), {{0, -5, 0}, {4, -5, 0}, {0, -5, 4}}),
      5.0F);
}

TEST(IntersectTriangle, DegenerateTrianglesAndNaNMiss) {
  const Ray ray = ray_from({0, 0, 0}, {0, 0, 1});
  EXPECT_EQ(intersect_triangle(ray, {{0, 0, 5}, {0, 0, 5}, {0, 0, 5}}), kInfinity) << "a point";
  EXPECT_EQ(intersect_triangle(ray, {{-1, 0, 5}, {0, 0, 5}, {1, 0, 5}}), kInfinity) << "a line";
  EXPECT_EQ(intersect_triangle(ray, {{kNaN, -1, 5}, {1, -1, 5}, {0, 1, 5}}), kInfinity);
  EXPECT_EQ(
      intersect_triangle(ray_from({0, 0, kNaN}, {0, 0, 1}), {{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}}),
      kInfinity);
}

// Oracle: Moeller and Trumbore's test in double precision, away from the rim.
TEST(IntersectTriangle, AgreesWithTheVolumeTestInDouble) {
  int hits = 0;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    Random random(3, 0, i);
    const auto corner = [&] { return vec_cast<float>(10.0 * random_unit(random)); };
    const Triangle triangle = {corner(), corner(), corner()};
    const Ray ray =
        ray_from(vec_cast<float>(20.0 * random_unit(random)), vec_cast<float>(random_unit(random)));
    const Vec3d a = vec_cast<double>(triangle.a);
    const Vec3d e1 = vec_cast<double>(triangle.b) - a, e2 = vec_cast<double>(triangle.c) - a;
    const Vec3d d = vec_cast<double>(ray.direction), s = vec_cast<double>(ray.origin) - a;
    const Vec3d p = cross(d, e2), q = cross(s, e1);
    const double det = dot(e1, p);
    const double u = dot(s, p) / det, v = dot(d, q) / det, t = dot(e2, q) / det;
    const double rim = std::min({u, v, 1 - u - v});
    if (std::fabs(rim) < 1e-4 || std::fabs(det) < 0.1 || std::fabs(t) < 1e-3) continue;
    const bool hit = rim > 0 && t > 0;
    const float ours = intersect_triangle(ray, triangle);
    ASSERT_EQ(ours < kInfinity, hit) << i;
    if (!hit) continue;
    EXPECT_NEAR(static_cast<double>(ours), t, 1e-4);
    ++hits;
  }
  EXPECT_GT(hits, 1000);
}

// Rays aimed at the common edge of two triangles never slip between them.
TEST(IntersectTriangle, NeighboursAreWatertight) {
  for (std::uint64_t i = 0; i < 50'000; ++i) {
    Random random(4, 0, i);
    const Vec3d edge_a = 50.0 * random_unit(random), edge_b = 50.0 * random_unit(random);
    const Vec3d middle = 0.5 * (edge_a + edge_b);
    const Vec3d side = 30.0 * random_unit(random);
    const Vec3f a = vec_cast<float>(edge_a), b = vec_cast<float>(edge_b);
    const Triangle one = {a, b, vec_cast<float>(middle + side)};
    const Triangle other = {b, a, vec_cast<float>(middle - side)};
    const Vec3d target = edge_a + random.uniform(0.01, 0.99) * (edge_b - edge_a);
    const Vec3d eye = target + 100.0 * random_unit(random);
    const Ray ray = ray_from(vec_cast<float>(eye), vec_cast<float>(normalized(target - eye)));
    // Across the ray the two must lie on both sides of the edge for a ray at the edge to be caught.
    const Vec3d across = cross(edge_b - edge_a, vec_cast<double>(ray.direction));
    if (std::fabs(dot(across, side)) < 1e-2 * length(across) * length(side)) continue;
    if (length(across) < 1e-2 * length(edge_b - edge_a)) continue;
    ASSERT_TRUE(intersect_triangle(ray, one) < kInfinity ||
                intersect_triangle(ray, other) < kInfinity)
        << i;
  }
}

}  // namespace
}  // namespace adasplats
