// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/vehicle/driven_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace adasplats {
namespace {

constexpr float kHeight_m = 1.7F;

/// A drive along x, scans `step_m` apart, over a road that rises by `slope`.
struct RoadDrive {
  PointCloud cloud;
  float step_m = 2, slope = 0;
  int scans = 12;

  Vec3f sensor(int scan) const {
    const float x = step_m * static_cast<float>(scan);
    return {x, 0, slope * x + kHeight_m};
  }
  void add(int scan, Vec3f point) {
    cloud.positions.push_back(point);
    cloud.sensor_positions.push_back(sensor(scan));
    cloud.scan_indices.push_back(static_cast<std::uint32_t>(scan));
  }
  void add_road() {
    for (int scan = 0; scan < scans; ++scan)
      for (int x = -60; x <= 60; ++x)
        for (int y = -20; y <= 20; ++y) {
          const float at = sensor(scan).x + 0.1F * static_cast<float>(x);
          add(scan, {at, 0.15F * static_cast<float>(y), slope * at});
        }
  }
  /// How many points of those added last are in the path, and of those before.
  std::pair<std::size_t, std::size_t> found(std::size_t before, DrivenPathOptions options = {}) {
    const auto flags = find_in_driven_path(cloud, options, Executor(2));
    if (flags.empty()) return {0, 0};
    EXPECT_EQ(flags.size(), cloud.size());
    const auto middle = flags.begin() + static_cast<std::ptrdiff_t>(before);
    return {std::count(middle, flags.end(), 1), std::count(flags.begin(), middle, 1)};
  }
};

TEST(DrivenPath, WhatWasAheadIsFoundAndTheRoadStays) {
  for (const float slope : {0.0F, 0.12F}) {
    RoadDrive drive;
    drive.slope = slope;
    drive.add_road();
    const std::size_t road = drive.cloud.size();
    // The back of a car ahead, always 5 m before the sensor.
    for (int scan = 0; scan < drive.scans; ++scan)
      for (int y = -5; y <= 5; ++y) {
        const float x = drive.sensor(scan).x + 5;
        drive.add(scan, {x, 0.1F * static_cast<float>(y), slope * x + 1});
      }
    // The last three were beyond the end of the path; of the others all within 0.6 m.
    EXPECT_EQ(drive.found(road), (std::pair<std::size_t, std::size_t>(9 * 11, 0))) << slope;
  }
}

TEST(DrivenPath, WhatStandsBesideOrAboveStays) {
  RoadDrive drive;
  drive.add_road();
  const std::size_t road = drive.cloud.size();
  for (int scan = 0; scan < drive.scans; ++scan) {
    const float x = drive.sensor(scan).x;
    drive.add(scan, {x, 0.7F, 1});     // a car beside
    drive.add(scan, {x, 0, 2.5F});     // a bridge
    drive.add(scan, {x, 0.2F, 0.3F});  // a hump of the road
  }
  EXPECT_EQ(drive.found(road), (std::pair<std::size_t, std::size_t>(0, 0)));
}

TEST(DrivenPath, NothingWithoutADriveOnTheGround) {
  const auto with_trail = [](RoadDrive drive) {
    drive.add_road();
    const std::size_t road = drive.cloud.size();
    for (int scan = 0; scan < drive.scans; ++scan)
      drive.add(scan, drive.sensor(scan) + Vec3f{0, 0.3F, -0.5F});
    return std::make_pair(drive, road);
  };
  auto [moving, road] = with_trail({});
  EXPECT_EQ(moving.found(road).first, 12U);
  DrivenPathOptions none;
  none.half_width_m = 0;
  EXPECT_EQ(moving.found(road, none).first, 0U);

  auto [resting, rest_road] = with_trail({.step_m = 0.01F});
  EXPECT_EQ(resting.found(rest_road).first, 0U) << "a sensor at rest";

  RoadDrive flying = moving;
  for (Vec3f& sensor : flying.cloud.sensor_positions) sensor.z += 20;
  EXPECT_EQ(flying.found(road).first, 0U) << "a drone above what it saw";

  RoadDrive guessed = moving;
  guessed.cloud.origin_kinds.assign(guessed.cloud.size(), OriginKind::guessed);
  EXPECT_EQ(guessed.found(road).first, 0U);

  RoadDrive scanless = moving;
  scanless.cloud.scan_indices.clear();
  EXPECT_EQ(scanless.found(road).first, 0U);
}

}  // namespace
}  // namespace adasplats
