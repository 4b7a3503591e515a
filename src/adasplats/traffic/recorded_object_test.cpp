// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/recorded_object.h"

#include <gtest/gtest.h>

#include <numbers>

namespace adasplats {
namespace {

BoxTrack track_to(Vec3d end, double yaw_rad, Vec3d half_size) {
  return {7, "Car", {{0, {}, half_size, yaw_rad}, {1, end, half_size, yaw_rad}}};
}

Vec3d ahead_of(const RecordedObject& object) {
  return object.world_from_object.front().world_from_sensor.rotation * Vec3d{1, 0, 0};
}

TEST(ObjectOf, XIsWhereItDrives) {
  // PandaSet's boxes have their length along y.
  const RecordedObject object = object_of(track_to({0, 5, 0}, 0, {1, 2.2, 0.8}));
  EXPECT_EQ(object.id, 7U);
  EXPECT_NEAR(length(ahead_of(object) - Vec3d{0, 1, 0}), 0, 1e-12);
  EXPECT_NEAR(object.size_m.x, 4.4, 1e-12);
  EXPECT_NEAR(object.size_m.y, 2, 1e-12);
  const RecordedObject back = object_of(track_to({-5, 0, 0}, 0, {2.2, 1, 0.8}));
  EXPECT_NEAR(length(ahead_of(back) - Vec3d{-1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(back.size_m.x, 4.4, 1e-12);
}

TEST(ObjectOf, AtRestXIsTheLongerSide) {
  const RecordedObject object = object_of(track_to({0, 0.2, 0}, 0.3, {1, 2.2, 0.8}));
  EXPECT_NEAR(object.size_m.x, 4.4, 1e-12);
}

TEST(ObjectCollector, PointsAreInTheFrameOfTheirObjectAtTheirTime) {
  const BoxTrack track = track_to({10, 0, 0}, 0, {2, 1, 1});
  ObjectCollector collector(MovingBoxes({{track}, 0, 1, false}));
  KittiSequence drive;
  drive.scans = {"a"};
  drive.trajectory = {{0.5, {{}, {0, -20, 0}}}};
  KittiScan scan;
  scan.positions = {{0, 20, 0}, {10, 20, 0}, {5, 20, -0.97F}, {50, 50, 0}};
  scan.origins.resize(4);
  scan.lasers.resize(4);
  scan.times_s = {0, 1, 0.5, 0.5};
  scan.in_boxes = {1, 1, 1, 0};  // the third is ground
  collector.add(collector.parts_of(drive, 0, scan));
  const std::vector<RecordedObject> objects = collector.take();
  ASSERT_EQ(objects.size(), 1U);
  ASSERT_EQ(objects[0].scans.size(), 1U);
  const ObjectScan& of_scan = objects[0].scans[0];
  ASSERT_EQ(of_scan.points.size(), 2U);
  EXPECT_NEAR(length(of_scan.points[0]), 0, 1e-6);
  EXPECT_NEAR(length(of_scan.points[1]), 0, 1e-6);
  EXPECT_NEAR(length(of_scan.origins[1] - Vec3d{-10, -20, 0}), 0, 1e-6);
  EXPECT_NEAR(of_scan.time_s, 0.5, 1e-12);
}

}  // namespace
}  // namespace adasplats
