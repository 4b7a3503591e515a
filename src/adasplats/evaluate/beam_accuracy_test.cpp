// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/evaluate/beam_accuracy_internal.h"

namespace adasplats {
namespace {

// Oracle: counted by hand.
TEST(BeamAccuracy, SharesAreOfAllRaysAndErrorsOfHits) {
  const BeamAccuracy a =
      accuracy_of({0.0F, -0.0625F, 0.25F, -1.0F, 2.0F, kNoHitError, kNoHitError, 0.5F});
  EXPECT_EQ(a.rays, 8U);
  EXPECT_DOUBLE_EQ(a.no_hit, 2.0 / 8);
  EXPECT_DOUBLE_EQ(a.early_50cm, 1.0 / 8);
  EXPECT_DOUBLE_EQ(a.late_50cm, 1.0 / 8);  // 0.5 m exactly is not more than 50 cm
  EXPECT_DOUBLE_EQ(a.within.at(0.02), 1.0 / 8);
  EXPECT_DOUBLE_EQ(a.within.at(0.05), 1.0 / 8);
  EXPECT_DOUBLE_EQ(a.within.at(0.10), 2.0 / 8);
  EXPECT_DOUBLE_EQ(a.within.at(0.50), 4.0 / 8);
  // |errors| in order: 0, 0.0625, 0.25, 0.5, 1, 2.
  EXPECT_DOUBLE_EQ(a.median_m, 0.375);
  EXPECT_DOUBLE_EQ(a.mae_m, 3.8125 / 6);
  EXPECT_DOUBLE_EQ(a.rmse_m, std::sqrt((0.00390625 + 0.0625 + 0.25 + 1 + 4) / 6));
  EXPECT_DOUBLE_EQ(a.p90_m, 2.0);  // rank ceil(5.4) = 6
  // Errors in order: -1, -0.0625, 0, 0.25, 0.5, 2; from their median 1.125, 0.1875, 0.125, 0.125,
  // 0.375, 1.875.
  EXPECT_DOUBLE_EQ(a.bias_m, 0.125);
  EXPECT_DOUBLE_EQ(a.spread_m, 0.28125);
}

TEST(BeamAccuracy, NinetiethPercentileOfTenIsTheNinth) {
  std::vector<float> errors;
  for (int i = 1; i <= 10; ++i) errors.push_back(static_cast<float>(i));
  EXPECT_DOUBLE_EQ(accuracy_of(errors).p90_m, 9.0);
  EXPECT_DOUBLE_EQ(accuracy_of(errors).median_m, 5.5);
  errors.push_back(11.0F);
  EXPECT_DOUBLE_EQ(accuracy_of(errors).median_m, 6.0);
}

TEST(BeamAccuracy, OneBeam) {
  const BeamAccuracy a = accuracy_of({-0.25F});
  EXPECT_DOUBLE_EQ(a.median_m, 0.25);
  EXPECT_DOUBLE_EQ(a.p90_m, 0.25);
  EXPECT_DOUBLE_EQ(a.rmse_m, 0.25);
  EXPECT_DOUBLE_EQ(a.bias_m, -0.25);
  EXPECT_DOUBLE_EQ(a.spread_m, 0.0);
}

TEST(BeamAccuracy, NoBeamsAndNoHits) {
  const BeamAccuracy none = accuracy_of({});
  EXPECT_EQ(none.rays, 0U);
  EXPECT_DOUBLE_EQ(none.no_hit, 0.0);
  EXPECT_TRUE(std::isnan(none.median_m));
  const BeamAccuracy missed = accuracy_of({kNoHitError});
  EXPECT_DOUBLE_EQ(missed.no_hit, 1.0);
  EXPECT_DOUBLE_EQ(missed.within.at(0.50), 0.0);
  EXPECT_TRUE(std::isnan(missed.rmse_m));
  EXPECT_TRUE(std::isnan(missed.bias_m));
  EXPECT_TRUE(std::isnan(missed.spread_m));
}

}  // namespace
}  // namespace adasplats
