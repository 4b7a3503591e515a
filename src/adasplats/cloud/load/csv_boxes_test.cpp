// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "adasplats/cloud/load/box_files.h"
#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

MovingBoxes boxes_of(const std::filesystem::path& file) {
  return MovingBoxes(read_box_file(file, {}));
}

constexpr const char* kBoxNames = "frame,time,id,label,stationary,x,y,z,size_x,size_y,size_z,yaw\n";

// A car of 4 x 2 x 1.5 m that goes 1 m in 0.1 s along x, and a parked one.
TEST(MovingBoxes, HoldWhatMovesAtItsTime) {
  const TemporaryFolder folder;
  const MovingBoxes boxes = boxes_of(
      folder.write("boxes.csv", std::string(kBoxNames) + "0,1.0,7,Car,0,0,0,1,4,2,1.5,0\n"
                                                         "0,1.0,8,Car,1,0,20,1,4,2,1.5,0\n"
                                                         "1,1.1,7,Car,0,1,0,1,4,2,1.5,0\n"));
  EXPECT_EQ(boxes.object_at(1.0, {2.1, 0, 1}), 1);
  EXPECT_EQ(boxes.object_at(1.0, {2.6, 0, 1}), 0);
  EXPECT_EQ(boxes.object_at(1.05, {2.6, 0, 1}), 1);  // half way
  EXPECT_EQ(boxes.object_at(1.05, {-1.8, 0, 1}), 0);
  EXPECT_EQ(boxes.object_at(1.15, {3.1, 0, 1}), 1);  // stays for 0.1 s after the last
  EXPECT_EQ(boxes.object_at(1.25, {1, 0, 1}), 0);
  EXPECT_EQ(boxes.object_at(1.0, {0, 20, 1}), 0);  // parked
  EXPECT_EQ(boxes.object_at(1.0, {0, 0, 2.1}), 0);
}

TEST(MovingBoxes, OneAtRestIsThereAtAllTimesWithoutTheGround) {
  const TemporaryFolder folder;
  BoxContent content = read_box_file(
      folder.write("boxes.csv", std::string(kBoxNames) + "0,1.0,8,Car,1,0,20,1,4,2,1.5,0\n"
                                                         "1,1.1,8,Car,1,0,20,1,4,2,1.5,0\n"),
      {});
  EXPECT_TRUE(content.moving.empty());
  ASSERT_EQ(content.at_rest.size(), 1U);
  EXPECT_EQ(content.at_rest[0].boxes.size(), 1U);
  content.moving = content.at_rest;
  const MovingBoxes boxes(content);
  EXPECT_EQ(boxes.object_at(99, {2.05, 20, 1}), 1);
  EXPECT_EQ(boxes.object_at(99, {2.15, 20, 1}), 0);
  EXPECT_EQ(boxes.object_at(99, {0, 20, 0.45}), 1);
  EXPECT_EQ(boxes.object_at(99, {0, 20, 0.35}), 0);  // the lower side is at 0.25 m
}

// PandaSet has a box of each LiDAR. Another car passes through the place later.
TEST(MovingBoxes, OneOfTwoBoxesOfTheSameObjectIsLeftOut) {
  const TemporaryFolder folder;
  std::string rows(kBoxNames);
  for (int k = 0; k < 10; ++k) {
    const std::string time = std::to_string(k), x = std::to_string(10 * k);
    rows += "0," + time + ",1,Car,0," + x + ",0,0,4,2,1.5,0\n";
    if (k < 8) rows += "0," + time + ",2,Car,0," + x + ",0.5,0,4,2,1.5,0\n";
    rows += "0," + time + ",3,Car,0,20,0.1,0,4,2,1.5,0\n";
  }
  const BoxContent content = read_box_file(folder.write("boxes.csv", rows), {});
  EXPECT_EQ(content.twins, 1U);
  ASSERT_EQ(content.moving.size(), 2U);
  EXPECT_EQ(content.moving[0].id, 1U);
  EXPECT_EQ(content.moving[1].id, 3U);
}

TEST(MovingBoxes, CoverTheTimesOfAllBoxes) {
  const TemporaryFolder folder;
  const MovingBoxes boxes = boxes_of(
      folder.write("boxes.csv", std::string(kBoxNames) + "0,-2,8,Car,1,0,20,1,4,2,1.5,0\n"
                                                         "0,-1.5,7,Car,0,0,0,1,4,2,1.5,0\n"));
  EXPECT_TRUE(boxes.overlaps(-3, -2));
  EXPECT_TRUE(boxes.overlaps(-1.9, -1.8));
  EXPECT_FALSE(boxes.overlaps(-1.4, 5));
  EXPECT_FALSE(boxes.overlaps(-9, -2.1));
  EXPECT_FALSE(MovingBoxes().overlaps(-1e9, 1e9));
}

TEST(MovingBoxes, TurnByTheirYawTheShortWay) {
  const TemporaryFolder folder;
  const MovingBoxes boxes = boxes_of(
      folder.write("boxes.csv", std::string(kBoxNames) + "0,0,1,Car,0,0,0,0,4,1,1,3.1\n"
                                                         "1,1,1,Car,0,0,0,0,4,1,1,-3.1\n"));
  EXPECT_EQ(boxes.object_at(0.5, {1.9, 0, 0}), 1);  // at pi, not at 0 turned the long way round
  EXPECT_EQ(boxes.object_at(0.25, {0, 1.9, 0}), 0);
}

TEST(MovingBoxes, NumberTheObjectsByTheirIdsAndTheNearestCounts) {
  const TemporaryFolder folder;
  const MovingBoxes boxes = boxes_of(
      folder.write("boxes.csv", std::string(kBoxNames) + "0,0,9,Truck,0,0,0,0,8,2,3,0\n"
                                                         "0,0,4,Person,0,3,0,0,1,1,2,0\n"));
  ASSERT_EQ(boxes.tracks().size(), 2U);
  EXPECT_EQ(boxes.tracks()[0].id, 4U);
  EXPECT_EQ(boxes.tracks()[1].label, "Truck");
  EXPECT_EQ(boxes.object_at(0, {3, 0, 0}), 1);  // in both
  EXPECT_EQ(boxes.object_at(0, {0, 0, 0}), 2);
}

TEST(MovingBoxes, WhatIsWrongIsNamed) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::data, {"d.csv:2", "must be in radians"}, [&] {
    boxes_of(folder.write("d.csv", std::string(kBoxNames) + "0,0,1,Car,0,0,0,0,4,1,1,90\n"));
  });
  expect_error(ErrorKind::data, {"has no column 'stationary'"},
               [&] { boxes_of(folder.write("a.csv", std::string("time,id,x,y,z\n0,1,0,0,0\n"))); });
  expect_error(ErrorKind::data, {"b.csv:3", "'yaw' is not a finite number"}, [&] {
    boxes_of(folder.write("b.csv", std::string(kBoxNames) + "0,0,1,Car,0,0,0,0,4,1,1,0\n"
                                                            "0,0,1,Car,0,0,0,0,4,1,1,left\n"));
  });
  const auto reject = [&](const std::string& row, const std::string& said) {
    expect_error(ErrorKind::data, {"c.csv", said}, [&] {
      boxes_of(folder.write("c.csv", kBoxNames + ("0,0,1,Car,0,0,0,0,4,1,1,0\n" + row)));
    });
  };
  reject("1,1,1,Car,0,0,0,0,4,0,1,0\n", "the size of the box is not positive");
  reject("1,1,1.5,Car,0,0,0,0,4,1,1,0\n", "'id' is not a whole number");
  reject("1,0,1,Car,0,5,0,0,4,1,1,0\n", "object 1 has two boxes at 0.000000 s");
  expect_error(ErrorKind::no_input, {"cannot be opened"},
               [&] { boxes_of(folder.path() / "none.csv"); });
}

}  // namespace
}  // namespace adasplats
