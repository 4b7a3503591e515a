// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/align_object.h"

#include <gtest/gtest.h>

#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/traffic/object_cloud.h"

namespace adasplats {
namespace {

/// Points on the rear and the left side of a box of 4 x 2 x 1.5 m, in its frame.
std::vector<Vec3d> points_on_box(Random& random, int count) {
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    const double z = random.uniform(-0.7, 0.75);
    points.push_back({random.uniform(-2, 2), 1, z});
    points.push_back({-2, random.uniform(-1, 1), z});
    points.push_back({random.uniform(-2, 2), random.uniform(-1, 1), 0.75});
  }
  return points;
}

/// A car that drives along x at 10 m/s. Its boxes are wrong by `errors` (x, y: m, z: turn in rad).
RecordedObject wrong_boxes(const std::vector<Vec3d>& errors) {
  Random random(7, 0, 0);
  RecordedObject object;
  object.size_m = {4, 2, 1.5};
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const double time_s = 0.1 * static_cast<double>(k);
    const RigidTransform truth = {{}, {10 * time_s, 0, 0.75}};
    const RigidTransform box = {rotation_from_yaw_pitch_roll(errors[k].z, 0, 0),
                                truth.translation + Vec3d{errors[k].x, errors[k].y, 0}};
    object.world_from_object.push_back({time_s, box});
    ObjectScan scan;
    scan.scan = k;
    scan.time_s = time_s;
    scan.world_from_object = box;
    for (const Vec3d& point : points_on_box(random, 200)) {
      scan.points.push_back(box.inverse() * (truth * point));
      scan.origins.push_back(box.inverse() * Vec3d{-20, 10, 2});
    }
    object.scans.push_back(std::move(scan));
  }
  return object;
}

// Oracle: the true motion. What all scans have in common stays unknown, so poses are compared with
// each other.
TEST(AlignScans, PosesAgreeAfterwards) {
  RecordedObject object = wrong_boxes(
      {{0.1, -0.05, 0.01}, {-0.08, 0.06, -0.02}, {0.05, 0.1, 0}, {0, -0.1, 0.02}, {-0.07, 0, 0}});
  const AlignReport report = align_scans(object, {}, Executor(2));
  EXPECT_EQ(report.scans, 5U);
  EXPECT_GT(report.median_shift_m, 0.03);
  ASSERT_EQ(object.world_from_object.size(), 5U);
  const RigidTransform first = object.world_from_object.front().world_from_sensor;
  for (std::size_t k = 1; k < 5; ++k) {
    const RigidTransform step = first.inverse() * object.world_from_object[k].world_from_sensor;
    EXPECT_NEAR(length(step.translation), static_cast<double>(k), 0.01);
    EXPECT_NEAR(angle_between(step.rotation, {}), 0, 0.003);
  }
}

TEST(AlignScans, PointsStayWhereTheyWereInTheWorld) {
  RecordedObject object = wrong_boxes({{0.1, 0, 0.01}, {0, 0.1, 0}, {0, 0, -0.02}});
  const auto world = [&](std::size_t scan, std::size_t i) {
    return interpolate(object.world_from_object, object.scans[scan].time_s) *
           object.scans[scan].points[i];
  };
  const Vec3d before = world(1, 5);
  align_scans(object, {}, Executor(1));
  EXPECT_NEAR(length(world(1, 5) - before), 0, 1e-9);
}

TEST(AlignScans, SameOnAnyNumberOfThreads) {
  const std::vector<Vec3d> errors = {{0.1, 0, 0.01}, {0, 0.1, 0}, {0, 0, -0.02}};
  RecordedObject one = wrong_boxes(errors), four = wrong_boxes(errors);
  align_scans(one, {}, Executor(1));
  align_scans(four, {}, Executor(4));
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(one.world_from_object[k].world_from_sensor.translation,
              four.world_from_object[k].world_from_sensor.translation);
}

TEST(AlignScans, FewPointsOrScansAreNotMoved) {
  RecordedObject none;
  EXPECT_EQ(align_scans(none, {}, Executor(1)).scans, 0U);
  RecordedObject one = wrong_boxes({{0.1, 0, 0.01}});
  const Vec3d before = one.world_from_object.front().world_from_sensor.translation;
  align_scans(one, {}, Executor(1));
  EXPECT_EQ(one.world_from_object.front().world_from_sensor.translation, before);
}

TEST(ObjectCloud, MirroredPointsFillTheHiddenSide) {
  RecordedObject object = wrong_boxes({{0, 0, 0}, {0, 0, 0}});
  PointCloud cloud = cloud_of(object);
  const std::size_t measured = cloud.size();
  const std::size_t added = add_mirrored(cloud, 0.2F, Executor(1));
  EXPECT_EQ(cloud.size(), measured + added);
  EXPECT_GT(added, measured / 4);  // of the left side, a third
  for (std::size_t i = measured; i < cloud.size(); ++i) EXPECT_LT(cloud.positions[i].y, -0.7F);
  EXPECT_EQ(cloud.sensor_positions.size(), cloud.size());
}

}  // namespace
}  // namespace adasplats
