// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/kitti_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

/// What a sensor sees of a ball of 10 m around it, but for a share of its beams; azimuths have
/// noise.
Scan scan_of(const LidarModel& sensor, double dropped = 0, double noise_rad = 0) {
  Scan scan;
  for (const Firing& firing : firings_of(sensor)) {
    Random random(3, 0, scan.rays++);
    const double turn = noise_rad * random.normal(), u = random.uniform();
    if (u < dropped) continue;
    const auto s = static_cast<float>(std::sin(turn)), c = static_cast<float>(std::cos(turn));
    const Vec3f d = firing.direction;
    scan.positions.push_back(10.0F * Vec3f{c * d.x - s * d.y, s * d.x + c * d.y, d.z});
    scan.rings.push_back(firing.ring);
    scan.columns.push_back(firing.column);
  }
  return scan;
}

/// From 0 to a whole turn.
double azimuth_of(Vec3f p) {
  const double azimuth = std::atan2(static_cast<double>(p.y), static_cast<double>(p.x));
  return azimuth < 0 ? azimuth + 2 * std::numbers::pi : azimuth;
}

/// Oracle: rings as readers of KITTI's files find them, where azimuths pass 0.
std::vector<std::size_t> unfolded_begins(const Scan& scan) {
  std::vector<std::size_t> begins = {0};
  for (std::size_t i = 1; i < scan.size(); ++i)
    if (azimuth_of(scan.positions[i - 1]) > std::numbers::pi &&
        azimuth_of(scan.positions[i]) <= std::numbers::pi && scan.positions[i].x > 0)
      begins.push_back(i);
  return begins;
}

void expect_rings_by_unfolding(const Scan& scan, std::size_t rings) {
  const std::vector<std::size_t> begins = unfolded_begins(scan);
  ASSERT_EQ(begins.size(), rings);
  for (std::size_t k = 0; k < begins.size(); ++k) {
    const std::size_t end = k + 1 < begins.size() ? begins[k + 1] : scan.size();
    for (std::size_t i = begins[k]; i < end; ++i) ASSERT_EQ(scan.rings[i], k);
  }
}

TEST(KittiOrder, UnfoldingFindsTheRingsOfSensorsThatTurnEitherWay) {
  for (const char* name : {"velodyne-hdl-64e-kitti", "hdl-64-paper", "velodyne-vlp-16"}) {
    const LidarModel sensor = load_lidar_model(name);
    const Scan fired = scan_of(sensor);
    const Scan scan = reordered(fired, kitti_order(fired));
    expect_rings_by_unfolding(scan, sensor.rings());
    for (std::size_t i = 1; i < scan.size(); ++i)
      ASSERT_TRUE(scan.rings[i] != scan.rings[i - 1] ||
                  azimuth_of(scan.positions[i]) >= azimuth_of(scan.positions[i - 1]))
          << name;
  }
}

TEST(KittiOrder, NoiseAndMissingBeamsHideNoRing) {
  const LidarModel sensor = load_lidar_model("velodyne-hdl-64e-kitti");
  for (const double noise_deg : {0.05, 0.1}) {
    const Scan fired = scan_of(sensor, 0.3, noise_deg * kDegree);
    EXPECT_NE(unfolded_begins(fired).size(), 64U);  // what the order is for
    expect_rings_by_unfolding(reordered(fired, kitti_order(fired)), 64);
  }
}

// Oracle: the definition, by sorting.
TEST(KittiOrder, MatchesSortedAzimuths) {
  const Scan scan = scan_of(load_lidar_model("velodyne-hdl-64e-kitti"), 0.2);
  std::vector<std::uint32_t> expected(scan.size());
  std::iota(expected.begin(), expected.end(), 0U);
  std::ranges::stable_sort(expected, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(scan.rings[a], azimuth_of(scan.positions[a])) <
           std::pair(scan.rings[b], azimuth_of(scan.positions[b]));
  });
  EXPECT_EQ(kitti_order(scan), expected);
}

TEST(KittiOrder, ReturnsOfAFiringKeepTheirOrder) {
  const Scan single = scan_of(load_lidar_model("velodyne-vlp-16"));
  Scan twice;
  for (std::size_t i = 0; i < single.size(); ++i) {
    const std::uint8_t returns = i % 3 == 0 ? 1 : 2;
    for (std::uint8_t k = 0; k < returns; ++k) {
      twice.positions.push_back(single.positions[i]);
      twice.rings.push_back(single.rings[i]);
      twice.columns.push_back(single.columns[i]);
      twice.return_indices.push_back(k);
    }
  }
  const Scan scan = reordered(twice, kitti_order(twice));
  expect_rings_by_unfolding(scan, 16);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.return_indices[i] == 0) continue;
    EXPECT_EQ(scan.return_indices[i - 1], 0);
    EXPECT_EQ(scan.columns[i - 1], scan.columns[i]);
    EXPECT_EQ(scan.rings[i - 1], scan.rings[i]);
  }
}

TEST(KittiOrder, NonRotatingPatternsKeepTheFiringOrder) {
  const Scan scan = scan_of(load_lidar_model("livox-mid-40"));
  std::vector<std::uint32_t> expected(scan.size());
  std::iota(expected.begin(), expected.end(), 0U);
  EXPECT_EQ(kitti_order(scan), expected);
}

TEST(KittiOrder, FewPoints) {
  EXPECT_TRUE(kitti_order({}).empty());
  EXPECT_EQ(kitti_order(scan_number(0, 1)), std::vector<std::uint32_t>{0});
  Scan without = scan_number(0, 3);
  without.rings.clear();
  EXPECT_THROW(kitti_order(without), std::logic_error);
}

// Oracle: the attributes of numbered scans, which differ from point to point.
TEST(Reordered, MovesEveryAttribute) {
  const Scan scan = scan_number(7, 50);
  std::vector<std::uint32_t> order(50);
  for (std::uint32_t i = 0; i < 50; ++i) order[i] = (7 * i) % 50;
  const Scan made = reordered(scan, order);
  EXPECT_EQ(made.time_s, scan.time_s);
  EXPECT_EQ(made.rays, scan.rays);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_TRUE(made.positions[i] == scan.positions[order[i]]);
    for_each_scan_attribute([&](const auto& attribute) {
      if (attribute.of(scan).empty()) return;
      EXPECT_EQ(attribute.of(made)[i], attribute.of(scan)[order[i]]) << attribute.name;
    });
  }
}

}  // namespace
}  // namespace adasplats
