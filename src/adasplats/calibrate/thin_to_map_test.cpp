// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/thin_to_map.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace adasplats {
namespace {

/// `count` points from `from` to `to`, in order.
void add_line(PointCloud& cloud, Vec3f from, Vec3f to, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k)
    cloud.positions.push_back(from +
                              (static_cast<float>(k) / static_cast<float>(count)) * (to - from));
}

// Oracle: the density of the map, by construction. The origins differ by 10 m along x.
TEST(ThinToMap, ThinsWhereTheMapIsSparser) {
  PointCloud points, map;
  map.origin = {10, 0, 0};
  add_line(points, {0, 0, 0}, {4, 0, 0}, 4000);    // the map has 20 points in 0.4 m
  add_line(points, {0, 20, 0}, {4, 20, 0}, 100);   // it has 100
  add_line(points, {0, 40, 0}, {4, 40, 0}, 4000);  // it has none
  add_line(map, {-10, 0, 0}, {-6, 0, 0}, 200);
  add_line(map, {-10, 20, 0}, {-6, 20, 0}, 1000);
  const PointCloud thinned = thinned_to_map(points, map);
  std::size_t counts[3] = {};
  for (const Vec3f position : thinned.positions)
    ++counts[static_cast<std::size_t>(position.y) / 20];
  EXPECT_NEAR(static_cast<double>(counts[0]), 200, 20);
  EXPECT_EQ(counts[1], 100U);
  EXPECT_NEAR(static_cast<double>(counts[2]), 40, 4);
  EXPECT_EQ(thinned.positions.front(), points.positions.front());
}

}  // namespace
}  // namespace adasplats
