// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/find_moving.h"

#include <gtest/gtest.h>

#include <numeric>

#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/traffic/recorded_street_test.h"

namespace adasplats {
namespace {

constexpr std::size_t kScans = 30;

std::vector<BoxTrack> find_in(const std::vector<DrivingBox>& boxes, int threads = 0) {
  const KittiSequence drive = recorded_street(boxes, kScans);
  std::vector<std::size_t> scans(kScans);
  std::iota(scans.begin(), scans.end(), 0U);
  RecordedProgress progress;
  return find_moving(drive, scans, {}, Executor(threads), progress);
}

/// Worst distance on the ground between found and true middles, m.
double worst_m(const BoxTrack& found, const DrivingBox& truth) {
  double worst = 0;
  for (const TimedBox& box : found.boxes) {
    const Vec3d off = box.middle - truth.at(box.time_s);
    worst = std::max(worst, std::hypot(off.x, off.y));
  }
  return worst;
}

TEST(FindMoving, ACarThatOvertakes) {
  const DrivingBox car = {{-15, 3.5, 0.75}, {4.4, 1.8, 1.5}, 15};
  const std::vector<BoxTrack> found = find_in({car});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].id, 1U);
  EXPECT_EQ(found[0].label, "car");
  EXPECT_GE(found[0].boxes.size(), kScans - 4);
  EXPECT_LT(worst_m(found[0], car), 0.3);
  const TimedBox &first = found[0].boxes.front(), &last = found[0].boxes.back();
  EXPECT_NEAR((last.middle.x - first.middle.x) / (last.time_s - first.time_s), 15, 0.3);
  EXPECT_NEAR(last.yaw_rad, 0, 0.03);
  EXPECT_NEAR(2 * last.half_size.x, 4.4, 0.3);
  EXPECT_NEAR(2 * last.half_size.y, 1.8, 0.2);
  EXPECT_NEAR(last.middle.z - last.half_size.z, 0, 0.1);
  EXPECT_NEAR(last.middle.z + last.half_size.z, 1.5, 0.15);
}

TEST(FindMoving, APedestrianBesideAParkedCar) {
  const DrivingBox walker = {{12, 6, 0.85}, {0.5, 0.5, 1.7}, 1.5};
  const DrivingBox parked = {{8, -6, 0.75}, {4.4, 1.8, 1.5}, 0};
  const std::vector<BoxTrack> found = find_in({walker, parked});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].label, "pedestrian");
  EXPECT_LT(worst_m(found[0], walker), 0.3);
}

TEST(FindMoving, NothingInAStreetAtRest) {
  EXPECT_TRUE(find_in({{{8, 6, 0.75}, {4.4, 1.8, 1.5}, 0}}).empty());
  EXPECT_TRUE(find_in({}).empty());
}

TEST(FindMoving, CarsThatPassEachOtherStayTwo) {
  const DrivingBox there = {{-10, 3.5, 0.75}, {4.4, 1.8, 1.5}, 14};
  const DrivingBox back = {{50, 6.5, 0.75}, {4.6, 1.9, 1.6}, -12};
  const std::vector<BoxTrack> found = find_in({there, back});
  ASSERT_EQ(found.size(), 2U);
  const bool is_first = found[0].boxes.back().middle.x > found[0].boxes.front().middle.x;
  EXPECT_LT(worst_m(found[is_first ? 0 : 1], there), 0.4);
  EXPECT_LT(worst_m(found[is_first ? 1 : 0], back), 0.4);
}

TEST(FindMoving, SameOnAnyNumberOfThreads) {
  const std::vector<DrivingBox> boxes = {{{-15, 3.5, 0.75}, {4.4, 1.8, 1.5}, 15},
                                         {{12, 6, 0.85}, {0.5, 0.5, 1.7}, 1.5}};
  const std::vector<BoxTrack> one = find_in(boxes, 1), four = find_in(boxes, 4);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    ASSERT_EQ(one[k].boxes.size(), four[k].boxes.size());
    for (std::size_t b = 0; b < one[k].boxes.size(); ++b)
      EXPECT_EQ(one[k].boxes[b].middle.x, four[k].boxes[b].middle.x);
  }
}

}  // namespace
}  // namespace adasplats
