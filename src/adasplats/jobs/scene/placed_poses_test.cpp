// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/placed_poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/jobs/scene/drive.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {
namespace {

constexpr Vec3d kOrigin = {448262, 5411932, 110};  // UTM

/// A street that rises by a tenth along x, relative to the origin, with a hole of 1.4 m about zero
/// where the vehicle stood, a roof 4 m above it from x = 10 on, a wall at y = 8, and two disks far
/// below, as reflections make them.
SplatModel street() {
  SplatModel model;
  model.origin = kOrigin;
  const float slope = 1 / std::sqrt(1.01F);
  for (int i = -100; i < 100; ++i) {
    for (int k = -40; k < 40; ++k) {
      const float x = 0.2F * static_cast<float>(i), y = 0.2F * static_cast<float>(k);
      if (std::hypot(x, y) > 1.4F)
        model.disks.push_back({{x, y, 0.1F * x}, 0.2F, {-0.1F * slope, 0, slope}});
      if (x > 10) model.disks.push_back({{x, y, 0.1F * x + 4}, 0.2F, {0, 0, -1}});
      if (k >= 0) model.disks.push_back({{x, 8, 0.1F * x + y}, 0.2F, {0, 1, 0}});
    }
  }
  model.disks.push_back({{5, 0, -6}, 0.3F, {0, 0, 1}});
  model.disks.push_back({{15, 0, -5}, 0.1F, {0, 0, 1}});
  return model;
}

class PlacedPoses : public testing::Test {
 protected:
  OwnSession session_{{.kind = DeviceKind::cpu}, 2};
  ModelScene scene_{street(), std::nullopt, session_};
  const Executor& executor_ = session_.executor;
  ProgressSink progress_;
};

// Oracle: the plane that the street is.
TEST_F(PlacedPoses, GroundIsTheLowestLevelThatManyRaysMeet) {
  for (const double x : {-15.0, -3.0, 0.0, 5.0, 15.0}) {
    const auto ground = find_ground(scene_, kOrigin.x + x, kOrigin.y, executor_);
    ASSERT_TRUE(ground) << x;
    EXPECT_NEAR(ground->z_m - kOrigin.z, 0.1 * x, 0.12) << x;
  }
  EXPECT_NEAR(find_ground(scene_, kOrigin.x - 3, kOrigin.y + 3, executor_)->z_m, kOrigin.z - 0.3,
              0.03);
  EXPECT_FALSE(find_ground(scene_, kOrigin.x + 40, kOrigin.y, executor_));
  EXPECT_FALSE(find_ground(scene_, 0, 0, executor_));
}

TEST_F(PlacedPoses, PlacesStandAboveTheGroundOrWhereTheySay) {
  const std::vector<SensorPlace> places = {{kOrigin.x - 5, kOrigin.y + 2, {}, 90},
                                           {kOrigin.x + 90, kOrigin.y, 300.25, 0}};
  const Trajectory poses = poses_at(scene_, places, 2, executor_, progress_);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_NEAR(poses[0].world_from_sensor.translation.z, kOrigin.z - 0.5 + 2, 0.05);
  EXPECT_NEAR(poses[0].world_from_sensor.rotation.rows[1].x, 1, 1e-12);
  EXPECT_EQ(poses[1].world_from_sensor.translation.z, 300.25);
  EXPECT_EQ(poses[1].time_s, 0.1);
  const SensorPlace outside{kOrigin.x + 90.5, kOrigin.y, {}, 0};
  expect_error(ErrorKind::data, {"no ground at 448352.50,5411932.00"},
               [&] { poses_at(scene_, std::span(&outside, 1), 2, executor_, progress_); });
}

/// As a standing vehicle leaves it: no ground within 6 m.
TEST(PlacedPosesInHole, HeightIsOfTheGroundAround) {
  SplatModel model;
  for (int i = -80; i < 80; ++i)
    for (int k = -60; k < 60; ++k) {
      const float x = 0.25F * static_cast<float>(i), y = 0.25F * static_cast<float>(k);
      if (std::hypot(x, y) > 6) model.disks.push_back({{x, y, -1.7F}, 0.25F, {0, 0, 1}});
    }
  class Warnings : public ProgressSink {
   public:
    void warn(std::string_view message) override { text += message; }
    std::string text;
  } warnings;
  OwnSession session({.kind = DeviceKind::cpu}, 2);
  const ModelScene scene(std::move(model), std::nullopt, session);
  const SensorPlace place{0, 0, {}, 0};
  const Trajectory poses = poses_at(scene, std::span(&place, 1), 2, session.executor, warnings);
  EXPECT_NEAR(poses.front().world_from_sensor.translation.z, 0.3, 1e-3);
  EXPECT_NE(warnings.text.find("at 0.00,0.00: the model has no ground within 1 m"),
            std::string::npos)
      << warnings.text;
}

// Oracle: the corners, the way and the speed by hand.
TEST_F(PlacedPoses, PathsAreDrivenAtASpeed) {
  const std::vector<PathCorner> corners = {{kOrigin.x - 10, kOrigin.y - 4},
                                           {kOrigin.x - 10, kOrigin.y - 4},
                                           {kOrigin.x - 2, kOrigin.y - 4},
                                           {kOrigin.x - 2, kOrigin.y + 4}};
  PathDrive drive;
  drive.speed_mps = 5;
  const Trajectory poses = poses_on_path(scene_, corners, drive, executor_, progress_);
  ASSERT_EQ(poses.size(), 33U);  // 16 m, a pose every half metre
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double way = 0.5 * static_cast<double>(k);
    const Vec3d t = poses[k].world_from_sensor.translation - kOrigin;
    EXPECT_NEAR(poses[k].time_s, way / 5, 1e-9);
    EXPECT_NEAR(t.x, way < 8 ? way - 10 : -2, 1e-6);
    EXPECT_NEAR(t.y, way < 8 ? -4 : way - 12, 1e-6);
    EXPECT_NEAR(t.z, 0.1 * t.x + kRoofHeight_m, 0.05);
    const double yaw = std::atan2(poses[k].world_from_sensor.rotation.rows[1].x,
                                  poses[k].world_from_sensor.rotation.rows[0].x);
    if (way < 7) {
      EXPECT_NEAR(yaw, 0, 1e-9);
    } else if (way > 9) {
      EXPECT_NEAR(yaw, std::numbers::pi / 2, 1e-9);
    } else {
      EXPECT_TRUE(yaw >= 0 && yaw <= std::numbers::pi / 2);
    }
  }
  drive.spacing_m = 4;
  EXPECT_EQ(poses_on_path(scene_, corners, drive, executor_, progress_).size(), 5U);
  drive.spacing_m = 1e-7;
  expect_error(ErrorKind::usage, {"path", "ten million"},
               [&] { poses_on_path(scene_, corners, drive, executor_, progress_); });
  expect_error(ErrorKind::usage, {"two corners"}, [&] {
    poses_on_path(scene_, std::span(corners).first(2), drive, executor_, progress_);
  });
}

TEST_F(PlacedPoses, WaysThereAndBackTurnAtTheTip) {
  const std::vector<PathCorner> corners = {{kOrigin.x - 10, kOrigin.y + 3},
                                           {kOrigin.x - 4, kOrigin.y + 3},
                                           {kOrigin.x - 10, kOrigin.y + 3}};
  PathDrive drive;
  const Trajectory poses = poses_on_path(scene_, corners, drive, executor_, progress_);
  ASSERT_EQ(poses.size(), 13U);
  EXPECT_NEAR(poses[2].world_from_sensor.rotation.rows[0].x, 1, 1e-12);
  EXPECT_NEAR(poses[10].world_from_sensor.rotation.rows[0].x, -1, 1e-12);
}

TEST_F(PlacedPoses, OneSourceOfPoses) {
  DriveOptions drive;
  expect_error(ErrorKind::usage, {"trajectory", "at", "path", "exactly one of"},
               [&] { check_drive(drive); });
  drive.at = {{kOrigin.x, kOrigin.y, 113, 0}};
  check_drive(drive);
  drive.speed_mps = 3;
  expect_error(ErrorKind::usage, {"speed", "path"}, [&] { check_drive(drive); });
  drive.speed_mps.reset();
  drive.rolling_shutter = true;
  expect_error(ErrorKind::usage, {"rolling_shutter"}, [&] { check_drive(drive); });
  drive.rolling_shutter = false;
  drive.path = {{0, 0}, {1, 0}};
  expect_error(ErrorKind::usage, {"exactly one of"}, [&] { check_drive(drive); });
  drive.path.clear();
  drive.trajectory = "poses.csv";
  expect_error(ErrorKind::usage, {"exactly one of"}, [&] { check_drive(drive); });
  drive.at.clear();
  drive.height_m = 2;
  expect_error(ErrorKind::usage, {"height"}, [&] { check_drive(drive); });
  drive.trajectory.clear();
  drive.at = {{std::nan(""), 0, {}, 0}};
  expect_error(ErrorKind::usage, {"finite"}, [&] { check_drive(drive); });
}

// A path moves the sensor while it turns as a trajectory does.
TEST_F(PlacedPoses, RollingShutterOnAPath) {
  DriveOptions drive;
  drive.path = {{kOrigin.x - 10, kOrigin.y + 3}, {kOrigin.x - 4, kOrigin.y + 3}};
  drive.every = 2;
  drive.rolling_shutter = true;
  ProgressSink quiet;
  const LidarModel sensor = load_lidar_model("velodyne-vlp-16");
  const auto scans = scans_along(drive, sensor, scene_, executor_, quiet);
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_FALSE(scans[1].knots.empty());
  LidarModel flash = sensor;  // all rays fire at the time of the pose
  flash.free_pattern = {{{1, 0, 0}, 0, 0, 0, {}}, {{0, 1, 0}, 0, 1, 0, {}}};
  for (const ScanMotion& scan : scans_along(drive, flash, scene_, executor_, quiet))
    EXPECT_TRUE(scan.knots.empty());
  drive.path.pop_back();
  expect_error(ErrorKind::usage, {"two corners"},
               [&] { scans_along(drive, sensor, scene_, executor_, quiet); });
}

}  // namespace
}  // namespace adasplats
