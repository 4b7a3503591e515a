// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/paper/grow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

/// A rough patch around its first point, and the neighbourhood of that in a given order. The others
/// are opposite each other in pairs: their distances to the plane, large and tiny ones,
/// cancel, and what is left of the sum is rounding.
struct Patch {
  std::vector<SurfacePoint> points;
  std::vector<std::uint32_t> ranks;
  std::vector<float> squared_distances;

  Patch(std::uint64_t seed, std::uint32_t count) : ranks(count) {
    std::iota(ranks.begin(), ranks.end(), 0U);
    const auto coordinate = [](Random& random, double reach_m) {
      return static_cast<float>(random.uniform(-reach_m, reach_m));
    };
    for (std::uint32_t i = 0; i < count; ++i) {
      Random random(seed, 0, (i + 1) / 2);
      const Vec3f at = {coordinate(random, 0.3), coordinate(random, 0.3),
                        coordinate(random, (i + 1) / 2 % 2 == 0 ? 0.02 : 1e-12)};
      const Vec3f normal = {coordinate(random, 0.3), coordinate(random, 0.3), 1};
      points.push_back({i % 2 == 0 ? -at : at, 0, normalized(normal), 0});
      if (i == 0) points[0] = {{}, 0, {0, 0, 1}, 0};
    }
  }

  GrownSplat grown(const GrowRules& rules) {
    squared_distances.clear();
    for (const std::uint32_t rank : ranks) {
      squared_distances.push_back(dot(points[rank].position, points[rank].position));
    }
    const NeighborList neighbors = {squared_distances.data(), ranks.data(),
                                    static_cast<std::uint32_t>(ranks.size())};
    return grow_splat(points[0], neighbors, points.data(), rules);
  }
};

// Oracle: the same neighbours in other orders.
TEST(GrowSplat, TheOrderOfNeighborsDoesNotMatter) {
  int grown = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Patch patch(seed, 121);
    for (const float error_m : {0.03F, 0.3F, 1e6F}) {
      const GrowRules rules = {error_m, 0.6F, false, true};
      const GrownSplat expected = patch.grown(rules);
      grown += expected.radius_m > 0 ? 1 : 0;
      std::reverse(patch.ranks.begin(), patch.ranks.end());
      EXPECT_EQ(patch.grown(rules).shift_m, expected.shift_m) << seed;
      std::stable_partition(patch.ranks.begin(), patch.ranks.end(),
                            [](std::uint32_t rank) { return rank % 2 == 0; });
      EXPECT_EQ(patch.grown(rules).shift_m, expected.shift_m) << seed;
      EXPECT_EQ(patch.grown(rules).radius_m, expected.radius_m) << seed;
    }
  }
  EXPECT_GT(grown, 300);
}

}  // namespace
}  // namespace adasplats
