// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/kitti_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// A car of 4 x 2 x 1.5 m, 10 m ahead of and 3 m left of a sensor that looks along the world's y;
/// turned left by `yaw` against the sensor.
ObjectBox car_ahead(double yaw) {
  ObjectBox box;
  box.class_id = 252;
  box.instance = 7;
  box.world_from_box = {rotation_from_yaw_pitch_roll(kQuarter + yaw, 0, 0), {97, 110, 1}};
  box.size_m = {4, 2, 1.5};
  return box;
}

Scan scan_at_100_100() {
  Scan scan;
  scan.world_from_sensor = {rotation_from_yaw_pitch_roll(kQuarter, 0, 0), {100, 100, 2}};
  // The middle, 4 cm beyond the front face, 6 cm beyond it, beside the box.
  scan.positions = {{10, 3, -1}, {12.04F, 3, -1}, {12.06F, 3, -1}, {10, 4.2F, -1}};
  return scan;
}

// Oracle: by hand.
TEST(KittiBoxes, BoxesAreInTheSensorFrame) {
  const ObjectBox boxes[] = {car_ahead(0), car_ahead(kQuarter)};
  const auto sensed = sensed_boxes(boxes, scan_at_100_100(), &semantickitti_labels());
  ASSERT_EQ(sensed.size(), 2U);
  EXPECT_EQ(sensed[0].type, "Car");
  EXPECT_EQ(sensed[0].instance, 7);
  EXPECT_LT(length(sensed[0].center_m - Vec3d{10, 3, -1}), 1e-12);
  EXPECT_NEAR(sensed[0].yaw_rad, 0, 1e-12);
  EXPECT_EQ(sensed[0].points, 2U);
  EXPECT_NEAR(sensed[1].yaw_rad, kQuarter, 1e-12);
  EXPECT_EQ(sensed[1].points, 2U);  // across: the middle and the one beside
  EXPECT_EQ(sensed_boxes(boxes, {}, nullptr)[0].type, "Misc");
  EXPECT_EQ(sensed_boxes(boxes, {}, nullptr)[0].points, 0U);
}

// Oracle: the development kit of KITTI's object benchmark: rotation_y is 0 where the car's length
// is along the camera's x (right); a car that faces as the camera looks has -pi/2.
TEST(KittiBoxes, LinesOfBothFrames) {
  const TemporaryFolder folder;
  const ObjectBox boxes[] = {car_ahead(0), car_ahead(-kQuarter)};
  auto sensed = sensed_boxes(boxes, scan_at_100_100(), &semantickitti_labels());
  write_kitti_boxes(folder.path(), 12, sensed);
  EXPECT_EQ(read_file(folder.path() / "label_2/000012.txt"),
            "Car -1 3 -10 -1 -1 -1 -1 1.500 2.000 4.000 -3.000 1.750 10.000 -1.571\n"
            "Car -1 3 -10 -1 -1 -1 -1 1.500 2.000 4.000 -3.000 1.750 10.000 0.000\n");
  EXPECT_EQ(read_file(folder.path() / "label_velodyne/000012.txt"),
            "Car 7 10.0000 3.0000 -1.0000 4.0000 2.0000 1.5000 0.0000 2\n"
            "Car 7 10.0000 3.0000 -1.0000 4.0000 2.0000 1.5000 -1.5708 2\n");
  sensed[0].points = 0;
  write_kitti_boxes(folder.path(), 12, sensed);
  const std::string fewer = read_file(folder.path() / "label_2/000012.txt");
  EXPECT_EQ(std::count(fewer.begin(), fewer.end(), '\n'), 1);
  write_kitti_boxes(folder.path(), 13, {});
  EXPECT_EQ(read_file(folder.path() / "label_velodyne/000013.txt"), "");
}

// Oracle: the 8 types of the benchmark against SemanticKITTI's names.
TEST(KittiBoxes, Types) {
  const std::pair<const char*, const char*> expected[] = {{"moving-car", "Car"},
                                                          {"truck", "Truck"},
                                                          {"on-rails", "Tram"},
                                                          {"moving-person", "Pedestrian"},
                                                          {"bicyclist", "Cyclist"},
                                                          {"moving-motorcyclist", "Cyclist"},
                                                          {"bus", "Misc"},
                                                          {"other-vehicle", "Misc"},
                                                          {"", "Misc"},
                                                          {"pedestrian", "Pedestrian"},
                                                          {"moving-bicyclist", "Cyclist"}};
  for (const auto& [name, type] : expected) EXPECT_EQ(kitti_type(name), type) << name;
}

}  // namespace
}  // namespace adasplats
