// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/point_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "adasplats/core/constants.h"

namespace adasplats {
namespace {

PointCloud numbered_cloud(std::uint16_t first, std::uint16_t count) {
  PointCloud cloud;
  for (std::uint16_t i = first; i < first + count; ++i) {
    const auto value = static_cast<float>(i);
    cloud.positions.push_back({value, 2 * value, 3 * value});
    cloud.sensor_positions.push_back({-value, 0, 1});
    cloud.intensities.push_back(value / 2);
    cloud.classes.push_back(i);
    cloud.instances.push_back(static_cast<std::uint16_t>(i + 1));
    cloud.scan_indices.push_back(i + 2U);
  }
  return cloud;
}

void expect_point(const PointCloud& cloud, std::size_t at, std::uint16_t number) {
  const PointCloud expected = numbered_cloud(number, 1);
  EXPECT_TRUE(cloud.positions[at] == expected.positions[0]);
  EXPECT_TRUE(cloud.sensor_positions[at] == expected.sensor_positions[0]);
  EXPECT_EQ(cloud.intensities[at], expected.intensities[0]);
  EXPECT_EQ(cloud.classes[at], expected.classes[0]);
  EXPECT_EQ(cloud.instances[at], expected.instances[0]);
  EXPECT_EQ(cloud.scan_indices[at], expected.scan_indices[0]);
}

TEST(PointCloud, GatherTakesEveryAttributeAlong) {
  PointCloud cloud = numbered_cloud(0, 5);
  cloud.origin = {1000, 2000, 3000};
  const std::uint32_t indices[] = {4, 0, 4};
  const PointCloud some = gather(cloud, indices);
  ASSERT_EQ(some.size(), 3U);
  EXPECT_TRUE(some.origin == cloud.origin);
  expect_point(some, 0, 4);
  expect_point(some, 1, 0);
  expect_point(some, 2, 4);
}

TEST(PointCloud, GatherOfNothingAndWithoutAttributes) {
  EXPECT_TRUE(gather(PointCloud{}, {}).empty());
  EXPECT_TRUE(gather(numbered_cloud(0, 3), {}).classes.empty());
  PointCloud bare;
  bare.positions = {{1, 2, 3}};
  const std::uint32_t indices[] = {0};
  const PointCloud one = gather(bare, indices);
  EXPECT_EQ(one.size(), 1U);
  EXPECT_TRUE(one.intensities.empty());
}

TEST(PointCloud, AppendKeepsOrder) {
  PointCloud cloud;
  append(cloud, numbered_cloud(0, 2));
  append(cloud, numbered_cloud(2, 3));
  append(cloud, PointCloud{});
  ASSERT_EQ(cloud.size(), 5U);
  for (std::uint16_t i = 0; i < 5; ++i) expect_point(cloud, i, i);
}

TEST(PointCloud, AppendRefusesWhatDoesNotFit) {
  PointCloud cloud = numbered_cloud(0, 2);
  PointCloud elsewhere = numbered_cloud(0, 2);
  elsewhere.origin = {1000, 0, 0};
  EXPECT_THROW(append(cloud, std::move(elsewhere)), std::logic_error);
  PointCloud without = numbered_cloud(0, 2);
  without.classes.clear();
  EXPECT_THROW(append(cloud, std::move(without)), std::logic_error);
}

TEST(ChooseOrigin, ZeroNearZeroAndForNothing) {
  EXPECT_TRUE(choose_origin({-1000, -5, 0}, {1000, 5, 1}) == Vec3d{});
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(choose_origin({kInf, kInf, kInf}, {-kInf, -kInf, -kInf}) == Vec3d{});
  EXPECT_TRUE(choose_origin({kNaN, 0, 0}, {kNaN, 1, 1}) == Vec3d{});
}

TEST(ChooseOrigin, WholeKilometresAndNoOverflow) {
  const Vec3d origin = choose_origin({448262.3, 5411932.7, 100}, {448700, 5412600, 130});
  EXPECT_TRUE((origin == Vec3d{448000, 5412000, 0}));
  EXPECT_TRUE(is_finite(choose_origin({-1.7e308, 0, 0}, {1.7e308, 0, 0})));
}

// Oracle: analytic. Half a float's step at 1024 m is 2^-14 m = 0.06 mm.
TEST(ChooseOrigin, UtmCoordinatesKeepTenthsOfMillimetres) {
  const Vec3d low{448262.0, 5411932.0, 212.0};
  for (int i = 0; i < 1000; ++i) {
    const double offset = 0.9371 * i + 0.0001 * (i % 7);
    const Vec3d p = low + Vec3d{offset, offset, 0.01 * i};
    PointCloud cloud;
    cloud.origin = choose_origin(low, low + Vec3d{937.1, 937.1, 10});
    cloud.positions = {vec_cast<float>(p - cloud.origin)};
    const Vec3d error = cloud.world(0) - p;
    EXPECT_LT(std::fabs(error.x), 1e-4);
    EXPECT_LT(std::fabs(error.y), 1e-4);
    EXPECT_LT(std::fabs(error.z), 1e-4);
  }
}

}  // namespace
}  // namespace adasplats
