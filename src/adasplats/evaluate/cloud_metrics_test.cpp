// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/cloud_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

/// A square grid of side * side points, `spacing_m` apart, at height z.
PointCloud grid(int side, float spacing_m, float z) {
  PointCloud cloud;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      cloud.positions.push_back(
          {static_cast<float>(i) * spacing_m, static_cast<float>(j) * spacing_m, z});
    }
  }
  return cloud;
}

PointCloud random_cloud(std::size_t count, std::uint64_t stream) {
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(7, stream, i);
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-5, 5)); };
    const float x = coordinate();
    const float y = coordinate();
    cloud.positions.push_back({x, y, coordinate()});
    cloud.classes.push_back(static_cast<std::uint16_t>(random.next_bits() % 3));
  }
  return cloud;
}

// Analytic: every point of one plane has its twin straight above at the planes' distance.
TEST(CloudDistance, PlanesAreTheirDistanceApart) {
  const Executor executor(2);
  const CloudDistance d = cloud_distance(grid(20, 1.0F, 0.25F), grid(20, 1.0F, 0.0F), executor);
  EXPECT_DOUBLE_EQ(d.c2c_m, 0.25);
  EXPECT_DOUBLE_EQ(d.completeness_m, 0.25);
  EXPECT_DOUBLE_EQ(d.chamfer_m, 0.25);
  EXPECT_DOUBLE_EQ(d.chamfer_m2, 2 * 0.0625);
  ASSERT_EQ(d.f_score.size(), 3U);
  EXPECT_DOUBLE_EQ(d.f_score.at(0.05), 0.0);
  EXPECT_DOUBLE_EQ(d.f_score.at(std::sqrt(0.05)), 0.0);
  EXPECT_EQ(d.simulated_points, 400U);
  EXPECT_EQ(d.original_points, 400U);
}

// Analytic: 0.2 m is within sqrt(0.05) = 0.2236 m and not within 0.1 m.
TEST(CloudDistance, FScoreBoundsAreInMetres) {
  const Executor executor(1);
  const CloudDistance d = cloud_distance(grid(5, 1.0F, 0.2F), grid(5, 1.0F, 0.0F), executor);
  EXPECT_DOUBLE_EQ(d.f_score.at(0.10), 0.0);
  EXPECT_DOUBLE_EQ(d.f_score.at(std::sqrt(0.05)), 1.0);
}

// Analytic: of 100 points in a row at 1 m the last 10 are missing, 1, 2, ... 10 m from the rest.
TEST(CloudDistance, HoleCountsInCompletenessAlone) {
  PointCloud original;
  for (int i = 0; i < 100; ++i) original.positions.push_back({static_cast<float>(i), 0, 0});
  PointCloud simulated = original;
  simulated.positions.resize(90);
  const CloudDistance d = cloud_distance(simulated, original, Executor(1));
  EXPECT_DOUBLE_EQ(d.c2c_m, 0.0);
  EXPECT_DOUBLE_EQ(d.completeness_m, 0.55);
  EXPECT_DOUBLE_EQ(d.chamfer_m2, 3.85);
  EXPECT_DOUBLE_EQ(d.f_score.at(0.05), 2 * 0.9 / 1.9);  // precision 1, recall 0.9
}

// Analytic: the same points in another order, with another origin.
TEST(CloudDistance, PermutedCloudIsNoDistanceAway) {
  const PointCloud cloud = random_cloud(5'000, 5);
  PointCloud permuted = cloud;
  std::reverse(permuted.positions.begin(), permuted.positions.end());
  permuted.origin = {0, 64, 0};
  for (Vec3f& p : permuted.positions) p.y -= 64.0F;
  const CloudDistance d = cloud_distance(permuted, cloud, Executor(2));
  EXPECT_NEAR(d.c2c_m, 0.0, 1e-5);  // 64 m off, a float holds 4 micrometres
  permuted.origin = {};
  permuted.positions.assign(cloud.positions.rbegin(), cloud.positions.rend());
  const CloudDistance exact = cloud_distance(permuted, cloud, Executor(2));
  EXPECT_EQ(exact.c2c_m, 0.0);
  EXPECT_EQ(exact.completeness_m, 0.0);
  EXPECT_EQ(exact.chamfer_m2, 0.0);
  for (const auto& [bound_m, score] : exact.f_score) EXPECT_EQ(score, 1.0) << bound_m;
}

// Analytic: a bound itself is not within; 0.125 m is between two of the three bounds.
TEST(CloudDistance, FScoresOfPlanesOnBothSidesOfTheirBounds) {
  const auto scores_at = [](float height_m) {
    return cloud_distance(grid(10, 1.0F, height_m), grid(10, 1.0F, 0.0F), Executor(1)).f_score;
  };
  const std::vector<std::pair<float, std::array<double, 3>>> expected = {
      {0.04F, {1, 1, 1}}, {0.0625F, {0, 1, 1}}, {0.125F, {0, 0, 1}}, {0.25F, {0, 0, 0}}};
  for (const auto& [height_m, of_bounds] : expected) {
    const auto scores = scores_at(height_m);
    EXPECT_EQ(scores.at(0.05), of_bounds[0]) << height_m;
    EXPECT_EQ(scores.at(0.10), of_bounds[1]) << height_m;
    EXPECT_EQ(scores.at(std::sqrt(0.05)), of_bounds[2]) << height_m;
  }
}

// Oracle: the definition, by brute force in double.
TEST(CloudDistance, EqualsBruteForce) {
  const PointCloud a = random_cloud(500, 1);
  const PointCloud b = random_cloud(400, 2);
  double sum = 0;
  for (const Vec3f p : a.positions) {
    double best = std::numeric_limits<double>::infinity();
    for (const Vec3f q : b.positions) {
      best = std::min(best, length(vec_cast<double>(p) - vec_cast<double>(q)));
    }
    sum += best;
  }
  EXPECT_NEAR(cloud_distance(a, b, Executor(1)).c2c_m, sum / 500, 1e-6);
}

TEST(CloudDistance, SameBitsForAnyOrderAndThreads) {
  const PointCloud a = random_cloud(40'000, 3);
  const PointCloud b = random_cloud(30'000, 4);
  PointCloud shuffled = a;
  std::reverse(shuffled.positions.begin(), shuffled.positions.end());
  std::rotate(shuffled.positions.begin(), shuffled.positions.begin() + 12'345,
              shuffled.positions.end());
  const CloudDistance one = cloud_distance(a, b, Executor(1));
  for (const int threads : {1, 2, 3}) {
    const CloudDistance other = cloud_distance(shuffled, b, Executor(threads));
    EXPECT_EQ(one.c2c_m, other.c2c_m);
    EXPECT_EQ(one.completeness_m, other.completeness_m);
    EXPECT_EQ(one.chamfer_m2, other.chamfer_m2);
    EXPECT_EQ(one.f_score, other.f_score);
  }
  const CloudDistance self = cloud_distance(a, shuffled, Executor(2));
  EXPECT_EQ(self.c2c_m, 0.0);
  EXPECT_EQ(self.completeness_m, 0.0);
}

// Oracle: the definition, by brute force.
TEST(DistancesTo, AreInTheOrderOfThePoints) {
  const PointCloud a = random_cloud(300, 8);
  const PointCloud b = random_cloud(200, 9);
  const std::vector<float> distances_m = distances_to(a, b, Executor(2));
  ASSERT_EQ(distances_m.size(), a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (const Vec3f q : b.positions)
      best = std::min(best, length(vec_cast<double>(a.positions[i]) - vec_cast<double>(q)));
    ASSERT_NEAR(distances_m[i], best, 1e-5);
  }
  EXPECT_THROW(distances_to({}, b, Executor(1)), Error);
  EXPECT_THROW(distances_to(a, {}, Executor(1)), Error);
}

TEST(CloudDistance, UsesBothOrigins) {
  PointCloud here = grid(4, 1.0F, 0.5F);
  here.origin = {449'000, 5'411'000, 0};
  PointCloud there = grid(4, 1.0F, 0.0F);
  there.origin = {449'000, 5'410'000, 0};
  for (Vec3f& p : there.positions) p.y += 1000.0F;
  EXPECT_DOUBLE_EQ(cloud_distance(here, there, Executor(1)).c2c_m, 0.5);
}

TEST(CloudDistance, OnePointAndEqualPoints) {
  PointCloud one;
  one.positions = {{1, 2, 3}};
  PointCloud many;
  many.positions.assign(1000, {1, 2, 4});
  const CloudDistance d = cloud_distance(one, many, Executor(1));
  EXPECT_DOUBLE_EQ(d.c2c_m, 1.0);
  EXPECT_DOUBLE_EQ(d.completeness_m, 1.0);
}

ErrorKind kind_of_error(const PointCloud& a, const PointCloud& b, bool by_class) {
  try {
    if (by_class) {
      cloud_distance_by_class(a, b, Executor(1));
    } else {
      cloud_distance(a, b, Executor(1));
    }
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::software;  // nothing was thrown
}

TEST(CloudDistance, EmptyCloudsAreAnError) {
  const PointCloud full = grid(2, 1.0F, 0.0F);
  for (const bool by_class : {false, true}) {
    EXPECT_EQ(kind_of_error({}, full, by_class), ErrorKind::data);
    EXPECT_EQ(kind_of_error(full, {}, by_class), ErrorKind::data);
  }
}

// Oracle: brute force.
TEST(NearestClasses, AreThoseOfTheNearestOriginalPoint) {
  PointCloud simulated = random_cloud(500, 1);
  simulated.classes.clear();
  simulated.origin = {100, 0, 0};
  for (Vec3f& p : simulated.positions) p.x -= 100;
  const PointCloud original = random_cloud(700, 2);
  const auto found = nearest_classes(simulated, original, Executor(2));
  ASSERT_EQ(found.size(), simulated.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::size_t best = 0;
    const auto distance = [&](std::size_t k) {
      return length(simulated.world(i) - original.world(k));
    };
    for (std::size_t k = 1; k < original.size(); ++k)
      if (distance(k) < distance(best)) best = k;
    EXPECT_EQ(found[i], original.classes[best]);
  }
  EXPECT_THROW(nearest_classes(original, simulated, Executor(1)), Error);
  EXPECT_THROW(nearest_classes(simulated, PointCloud(), Executor(1)), Error);
}

TEST(CloudDistanceByClass, NeedsClasses) {
  const PointCloud bare = grid(2, 1.0F, 0.0F);
  PointCloud labelled = bare;
  labelled.classes.assign(4, 1);
  EXPECT_EQ(kind_of_error(labelled, bare, true), ErrorKind::data);
  EXPECT_EQ(kind_of_error(bare, labelled, true), ErrorKind::data);
}

// Analytic: class 1 moved by 0.5 m; class 2 simulated on the plane of class 1 (3 m off its own);
// class 3 is simulated only, class 4 measured only.
TEST(CloudDistanceByClass, ComparesWithTheSameClassAndWithAll) {
  PointCloud simulated;
  simulated.positions = {{0, 0, 0.5F}, {1, 0, 0.5F}, {2, 0, 0}, {3, 0, 0}};
  simulated.classes = {1, 1, 2, 3};
  PointCloud original;
  original.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {2, 0, 3}, {9, 9, 9}};
  original.classes = {1, 1, 1, 1, 2, 4};
  const auto classes = cloud_distance_by_class(simulated, original, Executor(1));
  ASSERT_EQ(classes.size(), 4U);
  EXPECT_EQ(classes[0].class_id, 1);
  EXPECT_DOUBLE_EQ(classes[0].c2c_m, 0.5);
  EXPECT_EQ(classes[0].simulated_points, 2U);
  EXPECT_EQ(classes[0].original_points, 4U);
  EXPECT_DOUBLE_EQ(classes[1].c2c_m, 3.0);
  EXPECT_DOUBLE_EQ(classes[1].c2c_to_all_m, 0.0);
  EXPECT_TRUE(std::isnan(classes[2].c2c_m));
  EXPECT_DOUBLE_EQ(classes[2].c2c_to_all_m, 0.0);
  EXPECT_TRUE(std::isnan(classes[3].c2c_m));
  EXPECT_TRUE(std::isnan(classes[3].c2c_to_all_m));
  EXPECT_EQ(classes[3].original_points, 1U);
}

}  // namespace
}  // namespace adasplats
