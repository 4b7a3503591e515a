// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/canonical_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace adasplats {
namespace {

/// Two points at one place. What is first in the list of attributes decides; all behind it speak
/// for the other order.
PointCloud two_points(int deciding) {
  const auto values = [&](int rank) -> std::pair<int, int> {
    if (rank < deciding) return {1, 1};
    return rank == deciding ? std::pair{1, 2} : std::pair{2, 1};
  };
  const auto pair_of = [&]<class T>(int rank, T) {
    const auto [a, b] = values(rank);
    return std::vector<T>{static_cast<T>(a), static_cast<T>(b)};
  };
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {1, 2, 3}};
  cloud.classes = pair_of(0, std::uint16_t{});
  cloud.instances = pair_of(1, std::uint16_t{});
  cloud.scan_indices = pair_of(2, std::uint32_t{});
  cloud.intensities = pair_of(3, float{});
  for (const float x : pair_of(4, float{})) cloud.sensor_positions.push_back({x, 0, 0});
  for (const std::uint8_t kind : pair_of(5, std::uint8_t{}))
    cloud.origin_kinds.push_back(static_cast<OriginKind>(kind));
  return cloud;
}

using Order = std::vector<std::uint32_t>;

// Models depend on this order to the last bit, on CPU and GPU alike.
TEST(CanonicalOrder, AttributesDecideBetweenPointsAtOnePlaceByTheirRank) {
  const Executor executor(1);
  for (int deciding = 0; deciding < 6; ++deciding) {
    const PointCloud cloud = two_points(deciding);
    EXPECT_EQ(canonical_order(cloud, executor), (Order{0, 1})) << deciding;
    const Order turned = {1, 0};
    EXPECT_EQ(canonical_order(gather(cloud, turned), executor), turned) << deciding;
  }
}

TEST(CanonicalOrder, IntensitiesThatAreNotKnownComeLast) {
  PointCloud cloud;
  cloud.positions.assign(3, {0, 0, 0});
  cloud.intensities = {std::nanf(""), 5, 0.5F};
  EXPECT_EQ(canonical_order(cloud, Executor(1)), (Order{2, 1, 0}));
}

TEST(CanonicalOrder, EveryAttributeHasARankOfItsOwn) {
  std::vector<int> ranks;
  for_each_attribute([&](const auto& attribute) { ranks.push_back(attribute.tie_rank); });
  std::sort(ranks.begin(), ranks.end());
  for (std::size_t i = 0; i < ranks.size(); ++i) EXPECT_EQ(ranks[i], static_cast<int>(i));
}

TEST(CanonicalOrder, RemovedClassesAreLeftOutWhenTheOrderIsKnown) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  cloud.classes = {7, 5, 6};
  std::vector<std::uint8_t> removed(65536);
  removed[6] = 1;
  const CurveBox box = curve_box_of(cloud.positions, Executor(1));
  EXPECT_EQ(load_in_order(cloud, box, removed, Executor(1)).classes,
            (std::vector<std::uint16_t>{5, 7}));
  EXPECT_EQ(load_in_order(cloud, box, {}, Executor(1)).size(), 3U);
}

}  // namespace
}  // namespace adasplats
