// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/seen_space.h"

#include <gtest/gtest.h>

#include "adasplats/traffic/ground_heights.h"
#include "adasplats/traffic/loose_points.h"
#include "adasplats/traffic/recorded_street_test.h"

namespace adasplats {
namespace {

TEST(SeenSpace, FreeOccupiedAndUnknown) {
  const KittiSequence drive = recorded_street({{{20, 0, 1}, {4, 2, 2}, 0}}, 1);
  const SeenSpace seen(drive, 0, read_all_returns(drive, 0), {});
  EXPECT_EQ(seen.at({10, 0, 1}), Seen::free);
  EXPECT_EQ(seen.at({18, 0, 1}), Seen::occupied);
  EXPECT_EQ(seen.at({25, 0, 1}), Seen::unknown);   // behind the box
  EXPECT_EQ(seen.at({10, 0, 30}), Seen::unknown);  // no beams
  EXPECT_EQ(seen.at({3, 12, 1}), Seen::occupied);
  EXPECT_EQ(seen.at({15, 3, 0}), Seen::occupied);  // ground
}

TEST(LoosePoints, OnlyThoseOnWhatMoves) {
  const DrivingBox car = {{10, 3.5, 0.75}, {4.4, 1.8, 1.5}, 15};
  const KittiSequence drive = recorded_street({car, {{8, -6, 0.75}, {4.4, 1.8, 1.5}, 0}}, 12);
  std::vector<SeenSpace> seen;
  for (std::size_t k = 0; k < 12; ++k)
    seen.emplace_back(drive, k, read_all_returns(drive, k), SeenSpaceOptions{});
  std::vector<const SeenSpace*> others;
  for (std::size_t k = 4; k < 12; ++k) others.push_back(&seen[k]);
  const LoosePoints loose =
      loose_points(drive, 0, read_all_returns(drive, 0), others, {}, Executor(2));
  ASSERT_GT(loose.points.size(), 50U);
  EXPECT_EQ(loose.times_s.size(), loose.points.size());
  for (const Vec3d& point : loose.points) {
    EXPECT_NEAR(point.x, 10, 2.3);
    EXPECT_NEAR(point.y, 3.5, 1);
  }
}

TEST(GroundHeights, LowestPointsCountAndUnknownIsNaN) {
  const KittiSequence drive = recorded_street({{{10, 3.5, 0.75}, {4.4, 1.8, 1.5}, 0}}, 3);
  GroundHeights ground;
  for (std::size_t k = 0; k < 3; ++k) ground.add(ScanHeights(drive, k, read_all_returns(drive, k)));
  EXPECT_NEAR(ground.at(5.5, -2.5), 0, 0.06);
  EXPECT_TRUE(std::isnan(ground.at(500, 0)));
}

}  // namespace
}  // namespace adasplats
