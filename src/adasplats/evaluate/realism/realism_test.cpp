// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/realism.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/realism/drawn_scan_test.h"

namespace adasplats {
namespace {

constexpr std::size_t kPatchRings = 8;  // one row of patches suffices

/// Scans with walls around 10 m away that change along the drive, with noise and missing beams.
std::vector<RealismScan> drawn_scans(std::uint64_t seed, std::size_t count, double sigma_m,
                                     bool with_intensities = true) {
  std::vector<RealismScan> scans;
  for (std::size_t s = 0; s < count; ++s) {
    KittiScan points = test::drawn_points(
        [&](std::size_t ring, std::size_t column) -> std::optional<test::DrawnReturn> {
          if (ring >= kPatchRings) return {};
          Random random = test::of_beam(seed * 1000 + s, ring, column);
          if (random.uniform() < 0.1) return {};
          const double wall_m = 10 + std::sin(0.3 * static_cast<double>(s + column / 64));
          return test::DrawnReturn{wall_m + sigma_m * random.normal(),
                                   static_cast<float>(random.uniform())};
        });
    if (!with_intensities) points.intensities.clear();
    RingScan scan = arrange_in_rings({}, 0, points, test::kDrawnHeights_m);
    count_missing(scan, test::kDrawnStep_rad);
    scans.push_back({features_of_patches(scan, test::kDrawnStep_rad),
                     statistics_of_scan(scan, test::kDrawnStep_rad, {})});
  }
  return scans;
}

TEST(Realism, ScansOfOneProcessAreIndistinguishable) {
  const Executor executor;
  const auto real = drawn_scans(1, 24, 0.01), same = drawn_scans(2, 24, 0.01);
  const RealismResult result = compare_realism(same, real, 1, executor);
  for (const RealismTest* test : {&result.simulated_real, &result.real_real}) {
    for (std::size_t t = 0; t < std::size(kRealismFeatures); ++t) {
      ASSERT_TRUE(test->trees[t] && test->logistic[t]);
      for (const AucInterval& interval : {*test->trees[t], *test->logistic[t]}) {
        // Eight other draws of both sides scatter by 0.023 about 0.503; bounds hold what was
        // learned fixed and are 0.015 wide each way of one deviation.
        EXPECT_NEAR(interval.mean, 0.5, 0.06) << kRealismFeatures[t].first;
        EXPECT_LT(interval.low, 0.53);
        EXPECT_GT(interval.high, 0.47);
      }
    }
  }
}

TEST(Realism, OtherNoiseIsDetectedByGeometryAlone) {
  const Executor executor;
  const RealismResult result =
      compare_realism(drawn_scans(2, 8, 0.02), drawn_scans(1, 8, 0.01), 1, executor);
  const auto& trees = result.simulated_real.trees;
  EXPECT_GT(trees[0]->mean, 0.99);
  EXPECT_GT(trees[1]->mean, 0.99);
  EXPECT_NEAR(trees[2]->mean, 0.5, 0.1);  // dropout
  EXPECT_NEAR(trees[3]->mean, 0.5, 0.1);  // intensity
  EXPECT_GT(result.simulated_real.logistic[1]->mean, 0.99);
  EXPECT_NEAR(result.real_real.trees[0]->mean, 0.5, 0.05);
  for (std::size_t s = 0; s < scan_statistics().size(); ++s) {
    if (std::string(scan_statistics()[s].name) != "range_noise_m") continue;
    EXPECT_NEAR(result.statistics[s].real, 0.01, 0.001);
    EXPECT_NEAR(result.statistics[s].simulated, 0.02, 0.001);
    EXPECT_EQ(result.statistics[s].auc, 1);
  }
  for (std::size_t f = 0; f < patch_features().size(); ++f) {
    const std::string name = patch_features()[f].name;
    if (name == "second_middle") {
      EXPECT_GT(result.features[f].auc, 0.99);
    } else if (name == "missing") {
      EXPECT_NEAR(result.features[f].real, 0.1, 0.01);
    }
  }
}

TEST(Realism, SameForAnyNumberOfThreads) {
  const auto real = drawn_scans(1, 9, 0.01), simulated = drawn_scans(2, 8, 0.0105);
  const RealismResult one = compare_realism(simulated, real, 7, Executor(1));
  const RealismResult many = compare_realism(simulated, real, 7, Executor(3));
  for (std::size_t t = 0; t < std::size(kRealismFeatures); ++t) {
    EXPECT_EQ(one.simulated_real.trees[t]->mean, many.simulated_real.trees[t]->mean);
    EXPECT_EQ(one.simulated_real.logistic[t]->low, many.simulated_real.logistic[t]->low);
    EXPECT_EQ(one.real_real.trees[t]->high, many.real_real.trees[t]->high);
  }
}

TEST(Realism, WithoutIntensitiesThatTestIsLeftOut) {
  const Executor executor;
  const RealismResult result =
      compare_realism(drawn_scans(2, 8, 0.01, false), drawn_scans(1, 8, 0.01, false), 1, executor);
  EXPECT_FALSE(result.simulated_real.trees[3]);
  EXPECT_TRUE(result.simulated_real.trees[0]);
  // Present on one side only, they would distinguish all patches.
  const RealismResult one_side =
      compare_realism(drawn_scans(2, 8, 0.01, false), drawn_scans(1, 8, 0.01), 1, executor);
  EXPECT_FALSE(one_side.simulated_real.trees[3]);
  EXPECT_NEAR(one_side.simulated_real.trees[0]->mean, 0.5, 0.1);
}

TEST(Realism, TooFewScansAreAnError) {
  const Executor executor;
  const auto enough = drawn_scans(1, 8, 0.01);
  for (const std::size_t count : {0, 1, 7}) {
    const std::vector<RealismScan> few(enough.begin(),
                                       enough.begin() + static_cast<std::ptrdiff_t>(count));
    EXPECT_THROW(compare_realism(few, enough, 1, executor), Error);
    EXPECT_THROW(compare_realism(enough, few, 1, executor), Error);
  }
  const std::vector<RealismScan> sky(8);
  EXPECT_THROW(compare_realism(sky, enough, 1, executor), Error);
}

}  // namespace
}  // namespace adasplats
