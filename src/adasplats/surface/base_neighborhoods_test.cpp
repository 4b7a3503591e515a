// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/base_neighborhoods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

std::vector<Vec3f> in_curve_order(const std::vector<Vec3f>& points, const Executor& executor) {
  std::vector<Vec3f> sorted;
  for (const std::uint32_t i : hilbert_order(points, executor)) sorted.push_back(points[i]);
  return sorted;
}

/// Random points on z = 0.1 x, a plane with normal (-0.1, 0, 1) / |.|, with Gaussian noise along z.
std::vector<Vec3f> noisy_plane(std::size_t n, double noise_m) {
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i < n; ++i) {
    Random random(7, 1, i);
    const double x = random.uniform(0, 4), y = random.uniform(0, 4);
    points.push_back(vec_cast<float>(Vec3d{x, y, 0.1 * x + noise_m * random.normal()}));
  }
  return points;
}

/// Neighbourhoods by sorting all distances: the oracle for R, E, votes and memberships.
struct Oracle {
  double radius_m = 0, error_m = 0;
  std::vector<std::uint32_t> memberships, votes;
};

Oracle by_brute_force(const std::vector<Vec3f>& points, std::uint32_t k, double sigmas) {
  const auto n = static_cast<std::uint32_t>(points.size());
  std::vector<std::vector<std::pair<float, std::uint32_t>>> nearest(n);
  Oracle oracle{0, 0, std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(n)};
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const Vec3f d = points[j] - points[i];
      nearest[i].push_back({(d.x * d.x + d.y * d.y) + d.z * d.z, j});
    }
    std::sort(nearest[i].begin(), nearest[i].end());
    nearest[i].resize(std::min<std::size_t>(k, n));
    oracle.radius_m += std::sqrt(static_cast<double>(nearest[i].back().first)) / n;
  }
  const float radius = static_cast<float>(oracle.radius_m);
  double pairs = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    std::erase_if(nearest[i], [&](const auto& d) { return d.first > radius * radius; });
    Moments moments;
    for (const auto& [d2, j] : nearest[i]) moments.add(points[j] - points[i]);
    const Vec3f normal = local_shape(moments).normal;
    double sum = 0, squares = 0;
    for (const auto& [d2, j] : nearest[i]) {
      const double d = std::fabs(dot(normal, points[j] - points[i]));
      sum += d;
      squares += d * d;
    }
    const double count = static_cast<double>(nearest[i].size());
    const double sigma = std::sqrt(std::max(0.0, squares / count - sum / count * sum / count));
    for (const auto& [d2, j] : nearest[i]) {
      ++oracle.memberships[j];
      if (std::fabs(dot(normal, points[j] - points[i])) > sigmas * sigma) ++oracle.votes[j];
    }
    oracle.error_m += sum;
    pairs += count;
  }
  oracle.error_m /= pairs;
  return oracle;
}

TEST(BaseNeighborhoods, EqualBruteForce) {
  const Executor executor(2);
  const std::vector<Vec3f> points = in_curve_order(noisy_plane(700, 0.01), executor);
  const PointIndex index = PointIndex::from_sorted(points, executor);
  const BaseNeighborhoods found = base_neighborhoods(points, index, {20, {}, 3}, executor);
  const Oracle oracle = by_brute_force(points, 20, 3);
  EXPECT_NEAR(found.radius_m, oracle.radius_m, 1e-7);
  EXPECT_NEAR(found.error_m, oracle.error_m, 1e-7);
  EXPECT_EQ(found.memberships, oracle.memberships);
  EXPECT_EQ(found.votes, oracle.votes);
  EXPECT_GT(*std::max_element(found.votes.begin(), found.votes.end()), 0U);
}

TEST(BaseNeighborhoods, NormalsOfAPlane) {
  const Executor executor(2);
  const std::vector<Vec3f> points = in_curve_order(noisy_plane(3000, 0), executor);
  const PointIndex index = PointIndex::from_sorted(points, executor);
  const BaseNeighborhoods found = base_neighborhoods(points, index, {40, {}, 0}, executor);
  const Vec3f expected = normalized(Vec3f{-0.1F, 0, 1});
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_GT(std::fabs(dot(found.normals[i], expected)), 1 - 1e-6F);
  EXPECT_LT(found.error_m, 1e-6);
  EXPECT_TRUE(found.votes.empty());
}

TEST(BaseNeighborhoods, KindsOfLinePlaneAndBall) {
  const Executor executor(1);
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i < 600; ++i) {
    Random random(3, 2, i);
    const double t = random.uniform();
    if (i % 3 == 0) points.push_back({static_cast<float>(t), 0, 0});
    if (i % 3 == 1)
      points.push_back({static_cast<float>(t), 50 + static_cast<float>(random.uniform()), 0});
    if (i % 3 == 2)
      points.push_back({static_cast<float>(t), 100 + static_cast<float>(random.uniform()),
                        static_cast<float>(random.uniform())});
  }
  points = in_curve_order(points, executor);
  const PointIndex index = PointIndex::from_sorted(points, executor);
  const BaseNeighborhoods found = base_neighborhoods(points, index, {200, 10.0, 0}, executor);
  for (std::size_t i = 0; i < points.size(); ++i) {
    // The whole ball is in every neighbourhood of it: descriptors of a cube, 1/3 each at most.
    const ShapeKind expected = points[i].y < 25   ? ShapeKind::linear
                               : points[i].y < 75 ? ShapeKind::planar
                                                  : ShapeKind::spherical;
    ASSERT_EQ(found.kinds[i], expected) << points[i].y;
  }
}

TEST(BaseNeighborhoods, OnePointAndEqualPoints) {
  const Executor executor(1);
  for (const std::size_t n : {1, 50}) {
    const std::vector<Vec3f> points(n, {1, 2, 3});
    const PointIndex index = PointIndex::from_sorted(points, executor);
    const BaseNeighborhoods found = base_neighborhoods(points, index, {40, {}, 3}, executor);
    EXPECT_EQ(found.radius_m, 0);
    EXPECT_EQ(found.error_m, 0);
    for (const Vec3f normal : found.normals) EXPECT_NEAR(length(normal), 1, 1e-6);
  }
}

TEST(LocalShape, OrientedNormalsFaceTheSensor) {
  EXPECT_TRUE(oriented({0, 0, 1}, {0, 0, -5}) == (Vec3f{0, 0, -1}));
  EXPECT_TRUE(oriented({0, 0, 1}, {3, 0, 5}) == (Vec3f{0, 0, 1}));
  EXPECT_TRUE(with_canonical_sign({0.6F, 0, -0.8F}) == (Vec3f{-0.6F, 0, 0.8F}));
}

}  // namespace
}  // namespace adasplats
