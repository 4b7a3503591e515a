// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/intensity_agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace adasplats {
namespace {

/// Oracles: the definition by hand; 4.5 / sqrt(4.5 * 5) for the ties.
TEST(RankCorrelation, KnownValues) {
  const auto correlation = [](std::vector<float> a, std::vector<float> b) {
    return rank_correlation(a, b);
  };
  EXPECT_DOUBLE_EQ(correlation({1, 2, 3, 10}, {0, 5, 6, 7}), 1);
  EXPECT_DOUBLE_EQ(correlation({1, 2, 3, 10}, {9, 5, 4, -7}), -1);
  EXPECT_NEAR(correlation({1, 2, 2, 4}, {1, 3, 2, 4}), 4.5 / std::sqrt(22.5), 1e-12);
  EXPECT_TRUE(std::isnan(correlation({}, {})));
  EXPECT_TRUE(std::isnan(correlation({1}, {1})));
  EXPECT_TRUE(std::isnan(correlation({1, 2, 3}, {5, 5, 5})));
  EXPECT_THROW(correlation({1}, {}), std::logic_error);
}

// Oracle: the line through (1, 1), (2, 3), (3, 2), (4, 4) is 0.5 + 0.8 x, with residuals -0.3, 0.9,
// -0.9 and 0.3.
TEST(IntensityAgreement, IsThatOfTheBestLine) {
  const std::vector<float> predicted = {1, 2, 3, 4}, measured = {1, 3, 2, 4};
  const IntensityAgreement bytes = intensity_agreement(predicted, measured);
  EXPECT_EQ(bytes.beams, 4U);
  EXPECT_NEAR(bytes.rmse_after_fit, std::sqrt(1.8 / 4) / 255, 1e-9);
  EXPECT_NEAR(bytes.rank_correlation, 0.8, 1e-12);
  const std::vector<float> small = {0.1F, 0.3F, 0.2F, 0.4F};
  EXPECT_NEAR(intensity_agreement(predicted, small).rmse_after_fit, std::sqrt(0.018 / 4), 1e-7);
  const std::vector<float> equal = {2, 2, 2, 2};
  const IntensityAgreement flat = intensity_agreement(equal, small);
  EXPECT_NEAR(flat.rmse_after_fit, std::sqrt(0.05 / 4), 1e-7);
  EXPECT_TRUE(std::isnan(flat.rank_correlation));
  EXPECT_TRUE(std::isnan(intensity_agreement({}, {}).rmse_after_fit));
  EXPECT_THROW(intensity_agreement(predicted, {}), std::logic_error);
}

}  // namespace
}  // namespace adasplats
