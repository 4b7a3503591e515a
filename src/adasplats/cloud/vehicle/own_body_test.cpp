// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/vehicle/own_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr float kSensorHeight_m = 1.7F;

struct BodyDrive {
  PointCloud cloud;
  std::vector<bool> is_body;

  void add(Vec3f point, Vec3f sensor, bool body = false) {
    cloud.positions.push_back(point);
    cloud.sensor_positions.push_back(sensor);
    is_body.push_back(body);
  }
};

/// Scans `step_m` apart of a plane, a wall to the left, and with `body` a bonnet in front of a
/// sensor that turns with the road.
BodyDrive drive(int scans, float step_m, bool body) {
  BodyDrive drive;
  for (int s = 0; s < scans; ++s) {
    const Vec3f sensor = {static_cast<float>(s) * step_m, 0, kSensorHeight_m};
    const double heading = 0.02 * s;
    for (int a = 0; a < 360; a += 2) {
      const double azimuth = a * std::numbers::pi / 180;
      const Vec3f across = {static_cast<float>(std::cos(azimuth)),
                            static_cast<float>(std::sin(azimuth)), 0};
      for (float range_m = 2.1F; range_m < 16; range_m += 0.2F) {
        drive.add(sensor + across * range_m - Vec3f{0, 0, kSensorHeight_m}, sensor);
      }
      if (across.y > 0.3F) drive.add(sensor + across * (3 / across.y) + Vec3f{0, 0, 0.5F}, sensor);
    }
    for (int k = 0; body && k < 8; ++k) {
      const double azimuth = heading + 0.05 * (k - 4);
      drive.add(sensor + Vec3f{1.5F * static_cast<float>(std::cos(azimuth)),
                               1.5F * static_cast<float>(std::sin(azimuth)), -0.65F},
                sensor, true);
    }
  }
  return drive;
}

std::size_t count(const std::vector<std::uint8_t>& flags) {
  return static_cast<std::size_t>(std::ranges::count(flags, 1));
}

TEST(OwnBody, IsFoundAndNothingElse) {
  const BodyDrive with = drive(30, 0.8F, true);
  const auto flags = find_own_body(with.cloud, {}, Executor(2));
  ASSERT_EQ(flags.size(), with.cloud.size());
  for (std::size_t i = 0; i < flags.size(); ++i) ASSERT_EQ(flags[i] != 0, with.is_body[i]) << i;
}

TEST(OwnBody, NoneOfAVehicleThatShowsNone) {
  EXPECT_TRUE(find_own_body(drive(30, 0.8F, false).cloud, {}, Executor(2)).empty());
}

TEST(OwnBody, ASensorAtRestKeepsWhatStandsBesideIt) {
  EXPECT_TRUE(find_own_body(drive(30, 0.01F, true).cloud, {}, Executor(2)).empty());
}

TEST(OwnBody, RoomsOfABuildingKeepTheirFloors) {
  BodyDrive rooms;
  for (int room = 0; room < 9; ++room) {
    const Vec3f station = {20.0F * static_cast<float>(room), 0, kSensorHeight_m};
    for (int y = -30; y <= 30; ++y)
      for (int x = -30; x <= 30; ++x)
        rooms.add({station.x + 0.2F * static_cast<float>(x), 0.2F * static_cast<float>(y), 0},
                  station);
  }
  EXPECT_TRUE(find_own_body(rooms.cloud, {}, Executor(2)).empty());
}

TEST(OwnBody, AScannerOfProfilesKeepsTheRoad) {
  BodyDrive profiles;
  for (int k = 0; k < 2000; ++k) {
    const Vec3f sensor = {0.02F * static_cast<float>(k), 0, 2.5F};
    for (int y = -80; y <= 80; ++y)
      profiles.add({sensor.x, 0.1F * static_cast<float>(y), 0}, sensor);
  }
  EXPECT_TRUE(find_own_body(profiles.cloud, {}, Executor(2)).empty());
}

TEST(OwnBody, AMapThatIsSeenFromNearbyAloneKeepsTheRoad) {
  // Each point from within 1.5 m along the road, as a mobile scanner with two profiles measures.
  BodyDrive map;
  for (std::uint64_t k = 0; k < 200'000; ++k) {
    Random random(1, 0, k);
    const double along = random.uniform(0, 40), across = random.uniform(-9, 9);
    const Vec3f sensor = {static_cast<float>(along + random.uniform(-1.5, 1.5)), 0, 2};
    const bool wall = std::fabs(across) > 7;
    map.add(
        {static_cast<float>(along), static_cast<float>(wall ? std::copysign(7, across) : across),
         wall ? static_cast<float>(std::fabs(across) - 7) : 0},
        sensor);
  }
  EXPECT_TRUE(find_own_body(map.cloud, {}, Executor(2)).empty());
}

TEST(OwnBody, OnlyMeasuredOriginsTell) {
  BodyDrive guessed = drive(30, 0.8F, true);
  guessed.cloud.origin_kinds.assign(guessed.cloud.size(), OriginKind::guessed);
  EXPECT_TRUE(find_own_body(guessed.cloud, {}, Executor(2)).empty());
  guessed.cloud.origin_kinds.assign(guessed.cloud.size(), OriginKind::stated);
  EXPECT_TRUE(find_own_body(guessed.cloud, {}, Executor(2)).empty());
}

TEST(OwnBody, TheSameOnAnyNumberOfThreads) {
  const BodyDrive with = drive(40, 0.8F, true);
  EXPECT_EQ(find_own_body(with.cloud, {}, Executor(1)), find_own_body(with.cloud, {}, Executor(3)));
}

TEST(OwnBody, AGivenRadiusTakesWhatIsNearer) {
  BodyDrive with = drive(3, 0.8F, true);
  EXPECT_EQ(count(points_within(with.cloud, 2, Executor(2))), 3U * 8);
  with.cloud.origin_kinds.assign(with.cloud.size(), OriginKind::guessed);
  EXPECT_EQ(count(points_within(with.cloud, 2, Executor(2))), 0U);
}

}  // namespace
}  // namespace adasplats
