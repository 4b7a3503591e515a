// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/label_boxes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/traffic/fit_boxes.h"
#include "adasplats/traffic/recorded_street_test.h"

namespace adasplats {
namespace {

constexpr std::uint16_t kCar = 10, kMovingCar = 252;

/// The street with two cars: instance 7 moves, instance 7 of another class is parked.
KittiSequence labelled_street(const DrivingBox& moving, const DrivingBox& parked) {
  KittiSequence drive = recorded_street({moving, parked}, 12);
  std::vector<KittiScan> scans;
  for (std::size_t k = 0; k < drive.scans.size(); ++k) {
    KittiScan scan = read_kitti_points(drive, k);
    const auto is_on = [&](const DrivingBox& box, const Vec3f& p) {
      const Vec3d off = drive.trajectory[k].world_from_sensor * vec_cast<double>(p) -
                        box.at(drive.trajectory[k].time_s);
      return std::fabs(off.x) < box.size_m.x / 2 + 1e-3 &&
             std::fabs(off.y) < box.size_m.y / 2 + 1e-3 &&
             std::fabs(off.z) < box.size_m.z / 2 + 1e-3;
    };
    for (const Vec3f& p : scan.positions) {
      const bool on_moving = is_on(moving, p), on_parked = is_on(parked, p);
      scan.classes.push_back(on_moving ? kMovingCar : (on_parked ? kCar : std::uint16_t{40}));
      scan.instances.push_back(on_moving || on_parked ? 7 : 0);
    }
    scans.push_back(std::move(scan));
  }
  drive.reader = std::make_shared<MemoryReader>(std::move(scans));
  return drive;
}

TEST(LabelBoxes, MovingAndParkedVehiclesHaveBoxes) {
  const DrivingBox moving{{-8, 3.5, 0.95}, {4.4, 1.8, 1.5}, 12};
  const DrivingBox parked{{14, -5, 0.95}, {4.4, 1.8, 1.5}, 0};
  const KittiSequence drive = labelled_street(moving, parked);
  ProgressSink quiet;
  const BoxContent content = boxes_of_labels(drive, semantickitti_labels(), Executor(1), quiet);
  ASSERT_EQ(content.moving.size(), 1U);
  const BoxTrack& track = content.moving[0];
  EXPECT_EQ(track.id, 7U);
  EXPECT_EQ(track.label, "car");
  EXPECT_FALSE(track.is_at_rest);
  for (const TimedBox& box : track.boxes) {
    EXPECT_NEAR(box.middle.x, moving.at(box.time_s).x, 0.3);
    EXPECT_NEAR(box.middle.y, moving.middle.y, 0.2);
  }
  ASSERT_EQ(content.at_rest.size(), 1U);
  const BoxTrack& rest = content.at_rest[0];
  EXPECT_EQ(rest.id, 8U);  // 7 is taken
  EXPECT_TRUE(rest.is_at_rest);
  ASSERT_EQ(rest.boxes.size(), 1U);
  EXPECT_NEAR(rest.boxes[0].middle.x, parked.middle.x, 0.2);
  EXPECT_NEAR(rest.boxes[0].middle.y, parked.middle.y, 0.2);
  EXPECT_NEAR(rest.boxes[0].half_size.x, 2.2, 0.15);
  EXPECT_NEAR(std::sin(rest.boxes[0].yaw_rad), 0, 0.03);
  EXPECT_EQ(
      boxes_of_labels(drive, semantickitti_labels(), Executor(3), quiet).at_rest[0].boxes[0].middle,
      rest.boxes[0].middle);
}

// Nothing that labels call moving is lost: what hardly moves is at rest.
TEST(LabelBoxes, AMovingClassThatStandsIsAtRest) {
  const DrivingBox waiting{{9, 3.5, 0.95}, {4.4, 1.8, 1.5}, 0};
  const DrivingBox parked{{14, -5, 0.95}, {4.4, 1.8, 1.5}, 0};
  const KittiSequence drive = labelled_street(waiting, parked);
  RecordedProgress progress;
  const BoxContent content = boxes_of_labels(drive, semantickitti_labels(), Executor(1), progress);
  EXPECT_TRUE(content.moving.empty());
  ASSERT_EQ(content.at_rest.size(), 2U);
  for (const BoxTrack& track : content.at_rest) EXPECT_TRUE(track.is_at_rest);
  EXPECT_TRUE(progress.warnings.empty());
}

TEST(LabelBoxes, MovingPointsOfNoObjectAreStated) {
  KittiSequence drive =
      labelled_street({{-8, 3.5, 0.95}, {4.4, 1.8, 1.5}, 12}, {{14, -5, 0.95}, {4.4, 1.8, 1.5}, 0});
  std::vector<KittiScan> scans;
  for (std::size_t k = 0; k < drive.scans.size(); ++k) {
    scans.push_back(read_kitti_points(drive, k));
    if (k > 1) continue;
    for (std::size_t i = 0; i < scans[k].classes.size(); ++i)
      if (scans[k].classes[i] == kMovingCar) scans[k].instances[i] = 0;
  }
  drive.reader = std::make_shared<MemoryReader>(std::move(scans));
  RecordedProgress progress;
  boxes_of_labels(drive, semantickitti_labels(), Executor(1), progress);
  ASSERT_EQ(progress.warnings.size(), 1U);
  EXPECT_NE(progress.warnings[0].find("of no object"), std::string::npos) << progress.warnings[0];
}

TEST(LabelBoxes, WithoutInstancesThereAreNone) {
  ProgressSink quiet;
  const BoxContent content =
      boxes_of_labels(recorded_street({}, 2), semantickitti_labels(), Executor(1), quiet);
  EXPECT_TRUE(content.moving.empty() && content.at_rest.empty());
}

/// Points every 10 cm on the sides of a rectangle that a sensor sees.
std::vector<Vec3d> two_sides(double length, double width, double yaw_rad) {
  std::vector<Vec3d> points;
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  const auto add = [&](double x, double y) {
    for (int k = 0; k < 10; ++k) points.push_back({c * x - s * y, s * x + c * y, 0.15 * k});
  };
  for (double x = -length / 2; x <= length / 2; x += 0.1) add(x, -width / 2);
  for (double y = -width / 2; y <= width / 2; y += 0.1) add(-length / 2, y);
  return points;
}

TEST(FitBoxAtRest, TheTurnIsThatOfTheSides) {
  const double yaw_rad = 20 * std::numbers::pi / 180;
  const TimedBox box =
      fit_box_at_rest(two_sides(4.4, 1.8, yaw_rad), std::vector<Vec3d>{{0, -9, 2}}, "car");
  EXPECT_NEAR(box.yaw_rad, yaw_rad, 0.02);
  EXPECT_NEAR(box.half_size.x, 2.2, 0.1);
  EXPECT_NEAR(box.half_size.y, 0.9, 0.1);
  EXPECT_NEAR(length(Vec3d{box.middle.x, box.middle.y, 0}), 0, 0.15);
}

TEST(FitBoxAtRest, AHiddenSideOfAVehicleHasTheUsualLengthAwayFromTheSensor) {
  std::vector<Vec3d> side;
  for (const Vec3d& point : two_sides(4.4, 1.8, 0))
    if (point.y < -0.8) side.push_back(point);
  const TimedBox car = fit_box_at_rest(side, std::vector<Vec3d>{{0, -9, 2}}, "car");
  EXPECT_NEAR(car.middle.y, -0.9 + 1.75 / 2, 0.1);
  EXPECT_NEAR(car.half_size.y, 1.75 / 2, 0.05);
  const TimedBox other = fit_box_at_rest(side, std::vector<Vec3d>{{0, -9, 2}}, "fence");
  EXPECT_LT(other.half_size.y, 0.2);
}

}  // namespace
}  // namespace adasplats
