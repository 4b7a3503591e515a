// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "adasplats/evaluate/echoes/echo_accuracy.h"

namespace adasplats {
namespace {

KittiSequence drive_along_x(std::initializer_list<double> places_m) {
  KittiSequence sequence;
  for (const double x : places_m) {
    sequence.trajectory.emplace_back();
    sequence.trajectory.back().world_from_sensor.translation = {x, 0, 0};
  }
  return sequence;
}

using Places = std::vector<std::uint32_t>;

// Oracle: by hand; a new standpoint begins 2 m from the start of the last one.
TEST(Standpoints, ScansOfAStandingVehicleShareAStandpoint) {
  const KittiSequence drive = drive_along_x({0, 0, 0.5, 1.9, 2.1, 3.0, 4.2, 4.1, 50});
  const std::vector<std::size_t> all = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(standpoints_of(drive, all), (Places{0, 0, 0, 0, 1, 1, 2, 2, 3}));
}

TEST(Standpoints, OnlyTheChosenScansCount) {
  const KittiSequence drive = drive_along_x({0, 1, 2, 3, 4});
  const std::vector<std::size_t> some = {1, 2, 4};
  EXPECT_EQ(standpoints_of(drive, some), (Places{0, 0, 1}));
  EXPECT_TRUE(standpoints_of(drive, {}).empty());
}

}  // namespace
}  // namespace adasplats
