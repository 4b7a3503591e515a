// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "adasplats/core/constants.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

LidarModel rosette_of(double deflection_1_deg, double deflection_2_deg) {
  LidarModel model;
  model.rosette = RosettePattern{{7294 / 60.0, -4664 / 60.0},
                                 {deflection_1_deg * kDegree, deflection_2_deg * kDegree},
                                 100'000,
                                 {}};
  return model;
}

double off_axis_deg(Vec3f direction) {
  const auto d = vec_cast<double>(direction);
  return std::atan2(std::hypot(d.y, d.z), d.x) / kDegree;
}

// Oracle: the two deflections add as vectors.
TEST(Rosette, StaysWithinItsFieldOfView) {
  double nearest_deg = 90, farthest_deg = 0;
  for (const Firing& firing : firings_of(rosette_of(9.6, 7.6))) {
    ASSERT_NEAR(length(vec_cast<double>(firing.direction)), 1.0, 2e-7);
    nearest_deg = std::min(nearest_deg, off_axis_deg(firing.direction));
    farthest_deg = std::max(farthest_deg, off_axis_deg(firing.direction));
  }
  EXPECT_NEAR(nearest_deg, 9.6 - 7.6, 1e-3);
  EXPECT_NEAR(farthest_deg, 9.6 + 7.6, 1e-3);
}

// Oracle: the formula at two times, by hand.
TEST(Rosette, PrismsTurnAtTheirSpeeds) {
  LidarModel model = rosette_of(3, 1);
  model.rosette->prism_hz[0] = 10;
  model.rosette->prism_hz[1] = -20;
  model.rosette->points_per_s = 4000;
  const auto firings = firings_of(model);
  ASSERT_EQ(firings.size(), 400U);
  EXPECT_NEAR(static_cast<double>(firings[0].direction.y), std::sin(4 * kDegree), 1e-7);
  // After 1/40 s the first prism has turned by a quarter (z), the second by half a turn back (-y).
  const Vec3f later = firings[100].direction;
  EXPECT_FLOAT_EQ(firings[100].time_s, 0.025F);
  const double angle = std::hypot(3.0, 1.0) * kDegree;
  EXPECT_NEAR(static_cast<double>(later.x), std::cos(angle), 1e-7);
  EXPECT_NEAR(static_cast<double>(later.y), -std::sin(angle) / std::hypot(3.0, 1.0), 1e-7);
  EXPECT_NEAR(static_cast<double>(later.z), 3 * std::sin(angle) / std::hypot(3.0, 1.0), 1e-7);
}

std::size_t cells_seen(const LidarModel& model, std::uint64_t scans) {
  std::set<std::pair<int, int>> cells;
  for (std::uint64_t scan = 0; scan < scans; ++scan)
    for (const Firing& firing : firings_of(model, scan)) {
      const auto d = vec_cast<double>(firing.direction);
      cells.emplace(static_cast<int>(std::floor(d.y * 200)),
                    static_cast<int>(std::floor(d.z * 200)));
    }
  return cells.size();
}

// Oracle: the property that gives these sensors their use.
TEST(Rosette, DoesNotRepeatAndSeesMoreWithTime) {
  const LidarModel model = rosette_of(9.6, 9.6);
  EXPECT_FALSE(repeats(model));
  const auto first = firings_of(model, 0);
  const auto second = firings_of(model, 1);
  ASSERT_EQ(first.size(), 10'000U);
  ASSERT_EQ(model.rays_per_scan(), 10'000U);
  EXPECT_GT(length(vec_cast<double>(first[0].direction - second[0].direction)), 1e-3);
  EXPECT_EQ(first[77].time_s, second[77].time_s);
  const std::size_t one = cells_seen(model, 1);
  const std::size_t five = cells_seen(model, 5);
  const std::size_t twenty = cells_seen(model, 20);
  EXPECT_GT(five, one * 3 / 2);
  EXPECT_GT(twenty, five);
}

// Oracle: scans are parts of one pattern without a gap.
TEST(Rosette, AScanGoesOnWhereTheLastEnded) {
  LidarModel ten_hz = rosette_of(9.6, 9.6);
  LidarModel five_hz = ten_hz;
  five_hz.rotation_hz = 5;
  const auto long_scan = firings_of(five_hz, 3);
  const auto second_half = firings_of(ten_hz, 7);
  for (std::size_t i = 0; i < second_half.size(); ++i)
    ASSERT_EQ(second_half[i].direction, long_scan[i + 10'000].direction);
}

// Oracle: the lasers' tilts add to the prisms' deflection; zero prisms leave the tilts alone.
TEST(Rosette, LasersFireInTurn) {
  LidarModel model = rosette_of(0, 0);
  model.rosette->laser_tilts_rad = {2 * kDegree, 0, -1 * kDegree};
  EXPECT_EQ(model.rings(), 3U);
  const auto firings = firings_of(model);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(firings[i].ring, i % 3);
    EXPECT_EQ(firings[i].column, i / 3);
    const double tilt_deg = i % 3 == 0 ? 2 : (i % 3 == 1 ? 0 : -1);
    EXPECT_NEAR(std::asin(static_cast<double>(firings[i].direction.z)) / kDegree, tilt_deg, 1e-5);
  }
}

TEST(Rosette, NoPointsGiveNoRaysAndNoRateIsABug) {
  LidarModel model = rosette_of(9.6, 9.6);
  model.rosette->points_per_s = 0;
  EXPECT_TRUE(firings_of(model).empty());
  model.rotation_hz = 0;
  EXPECT_THROW(firings_of(model), std::logic_error);
}

}  // namespace
}  // namespace adasplats
