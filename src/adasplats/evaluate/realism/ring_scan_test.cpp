// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/ring_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "adasplats/evaluate/realism/drawn_scan_test.h"

namespace adasplats {
namespace {

using test::DrawnReturn;

TEST(RingScan, HasEveryReturnInItsPlace) {
  KittiScan points = test::drawn_points([](std::size_t ring, std::size_t column) {
    return DrawnReturn{5 + 0.1 * static_cast<double>(ring), 0.001F * static_cast<float>(column)};
  });
  // The order of the file is irrelevant; what is not finite, at the origin or of no laser is no
  // return.
  std::ranges::reverse(points.positions);
  std::ranges::reverse(points.intensities);
  std::ranges::reverse(points.lasers);
  points.positions[0].x = std::numeric_limits<float>::quiet_NaN();
  points.positions[1] = {};
  points.lasers[2] = kNoLaser;
  const RingScan scan = arrange_in_rings({}, 0, points, test::kDrawnHeights_m);
  ASSERT_EQ(scan.rings(), test::kDrawnRings);
  ASSERT_EQ(scan.size(), test::kDrawnRings * test::kDrawnColumns - 3);
  for (std::size_t ring = 0; ring + 1 < scan.rings(); ++ring) {
    ASSERT_EQ(scan.begins[ring + 1] - scan.begins[ring], test::kDrawnColumns);
    for (std::size_t column = 0; column < test::kDrawnColumns; ++column) {
      const std::size_t i = scan.begins[ring] + column;
      EXPECT_NEAR(scan.azimuths_rad[i], (static_cast<double>(column) + 0.5) * test::kDrawnStep_rad,
                  1e-5);
      EXPECT_NEAR(scan.ranges_m[i], 5 + 0.1 * static_cast<double>(ring), 1e-5);
      EXPECT_EQ(scan.intensities[i], 0.001F * static_cast<float>(column));
    }
  }
}

TEST(RingScan, RangesBeginAtTheLaser) {
  // The sensor's origin is at (1, 2, 3), its second laser 0.2 m above; 3, 4, 12 is 13 long.
  KittiScan points;
  points.positions = {{4, 6, 15.2F}};
  points.origins = {{1, 2, 3}};
  points.lasers = {1};
  const std::vector<double> heights_m = {0.1, 0.2};
  const RingScan scan = arrange_in_rings({}, 0, points, heights_m);
  ASSERT_EQ(scan.size(), 1U);
  EXPECT_NEAR(scan.ranges_m[0], 13, 1e-6);
}

TEST(RingScan, WithoutPointsIsEmpty) {
  const std::vector<double> heights_m(4, 0);
  RingScan scan = arrange_in_rings({}, 0, {}, heights_m);
  EXPECT_EQ(scan.rings(), 4U);
  EXPECT_EQ(scan.size(), 0U);
  EXPECT_EQ(azimuth_step_rad(scan), 0);
  count_missing(scan, 0.01);
  EXPECT_TRUE(scan.missing.empty());
}

TEST(RingScan, TheStepIsTheMeanOfEncoderSteps) {
  // An HDL-64E fires every 1.86 steps of its encoder and reports whole ones; some return nothing.
  RingScan scan;
  scan.begins = {0};
  constexpr double kEncoder_rad = 2 * std::numbers::pi / 4000;
  for (int k = 0; k < 2150; ++k) {
    if (k % 11 == 3 || (k > 500 && k < 540)) continue;
    const double step = std::floor(k * 4000.0 / 2150);
    scan.azimuths_rad.push_back(static_cast<float>(step * kEncoder_rad));
    scan.ranges_m.push_back(10);
  }
  scan.begins.push_back(scan.size());
  const double step_rad = azimuth_step_rad(scan);
  EXPECT_NEAR(step_rad, 2 * std::numbers::pi / 2150, 0.01 * 2 * std::numbers::pi / 2150);
  // Runs of one, and one of 39 (with those that k % 11 adds); the seam has one whole step.
  count_missing(scan, step_rad);
  std::vector<std::uint32_t> runs = scan.missing;
  std::erase(runs, 0U);
  EXPECT_EQ(std::ranges::count(runs, 1U), static_cast<std::ptrdiff_t>(runs.size()) - 1);
  EXPECT_NEAR(*std::ranges::max_element(runs), 39, 1);
}

TEST(RingScan, MissingBeamsOverTheSeamCount) {
  const RingScan scan =
      test::drawn_scan([](std::size_t ring, std::size_t column) -> std::optional<DrawnReturn> {
        if (ring > 0) return {};
        if (column < 3 || column >= test::kDrawnColumns - 2 || column == 100) return {};
        return DrawnReturn{10};
      });
  EXPECT_EQ(scan.missing.back(), 5U);
  EXPECT_EQ(std::accumulate(scan.missing.begin(), scan.missing.end(), 0U), 6U);
}

TEST(UnfoldedRings, AreThoseOfTheFilesOrder) {
  std::vector<Vec3f> kitti, from_rear;
  for (int ring = 0; ring < 5; ++ring) {
    for (int k = 0; k < 360; ++k) {
      const double azimuth_rad = (k + 0.5) * std::numbers::pi / 180;
      kitti.push_back({static_cast<float>(std::cos(azimuth_rad)),
                       static_cast<float>(std::sin(azimuth_rad)), 0});
      from_rear.push_back({static_cast<float>(-std::cos(azimuth_rad)),
                           static_cast<float>(std::sin(azimuth_rad)), 0});
    }
  }
  EXPECT_EQ(unfolded_rings(kitti), 5U);
  EXPECT_EQ(unfolded_rings(from_rear), 1U);
  EXPECT_EQ(unfolded_rings({}), 0U);
}

}  // namespace
}  // namespace adasplats
