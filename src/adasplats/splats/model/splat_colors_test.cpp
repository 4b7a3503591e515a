// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/splat_colors.h"

#include <gtest/gtest.h>

namespace adasplats {
namespace {

using Colors = std::vector<ColorBytes>;

Disk disk_at(Vec3f center, float radius) { return {center, radius, {0, 0, 1}}; }

TEST(SplatColors, AreMeansOfThePointsWithinTheDisk) {
  const std::vector<Disk> disks = {disk_at({0, 0, 0}, 1), disk_at({3, 0, 0}, 1)};
  const std::vector<Vec3f> points = {{0.5F, 0, 0}, {-0.5F, 0, 0}, {3, 0.9F, 0}, {1.4F, 0, 0}};
  // The last point is nearest to the first disk, and outside it.
  const Colors colors = {{10, 0, 200}, {21, 0, 100}, {7, 8, 9}, {255, 255, 255}};
  for (const int threads : {1, 3})
    EXPECT_EQ(colors_of_disks(disks, points, colors, Executor(threads)),
              (Colors{{16, 0, 150}, {7, 8, 9}}));
}

TEST(SplatColors, AreOfTheNearestPointWhereADiskHasNone) {
  const std::vector<Disk> disks = {disk_at({0, 0, 0}, 0.1F), disk_at({5, 0, 0}, 0.1F)};
  const std::vector<Vec3f> points = {{1, 0, 0}, {4, 0, 0}};
  const Colors colors = {{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(colors_of_disks(disks, points, colors, Executor(1)), colors);
}

TEST(SplatColors, AreNoneWithoutPointsOrDisks) {
  const std::vector<Disk> disk = {disk_at({0, 0, 0}, 1)};
  const std::vector<Vec3f> point = {{0, 0, 0}};
  EXPECT_TRUE(colors_of_disks(disk, {}, {}, Executor(1)).empty());
  EXPECT_TRUE(colors_of_disks({}, point, Colors(1), Executor(1)).empty());
  EXPECT_THROW(colors_of_disks(disk, point, {}, Executor(1)), std::logic_error);
}

}  // namespace
}  // namespace adasplats
