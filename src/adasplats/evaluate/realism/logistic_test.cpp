// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/realism/auc.h"
#include "adasplats/evaluate/realism/classifiers.h"

namespace adasplats {
namespace {

TEST(FitLogistic, FindsTheWeightsThatSamplesWereDrawnWith) {
  constexpr double kTrue[] = {1.5, -0.7, 0, 0.4};  // the bias last
  SampleTable table{3, {}, {}};
  for (std::size_t i = 0; i < 20000; ++i) {
    Random random(1, 4, i);
    double odds = kTrue[3];
    for (std::size_t f = 0; f < 3; ++f) {
      table.values.push_back(static_cast<float>(random.normal()));
      odds += kTrue[f] * static_cast<double>(table.values.back());
    }
    table.positive.push_back(random.uniform() < 1 / (1 + std::exp(-odds)) ? 1 : 0);
  }
  const std::vector<double> weights = fit_logistic(table, 1);
  ASSERT_EQ(weights.size(), 4U);
  // Standard errors are about 1 / sqrt(20000 * 0.17) = 0.017, of the first weight 0.024.
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(weights[k], kTrue[k], 0.07) << k;
}

TEST(FitLogistic, SolvesItsEquationsForFewSamples) {
  // Where the likelihood is largest its gradient vanishes: sum of (y - p) x = ridge w.
  SampleTable table{1, {-2, -1, 0.5, 1, 3}, {0, 1, 0, 1, 1}};
  const std::vector<double> weights = fit_logistic(table, 0.5);
  double gradient = -0.5 * weights[0], bias_gradient = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto x = static_cast<double>(table.values[i]);
    const double p = 1 / (1 + std::exp(-(weights[0] * x + weights[1])));
    gradient += (table.positive[i] - p) * x;
    bias_gradient += table.positive[i] - p;
  }
  EXPECT_NEAR(gradient, 0, 1e-9);
  EXPECT_NEAR(bias_gradient, 0, 1e-9);
}

TEST(LogisticScore, TellsShiftsAndSpreads) {
  const auto drawn = [](std::uint64_t seed, double shift, double wider) {
    SampleTable table{2, {}, {}};
    for (std::size_t i = 0; i < 4000; ++i) {
      Random random(seed, 5, i);
      const bool positive = i % 2 == 0;
      table.positive.push_back(positive ? 1 : 0);
      table.values.push_back(
          static_cast<float>((positive ? wider : 1) * random.normal() + (positive ? shift : 0)));
      table.values.push_back(i % 5 == 0 ? std::numeric_limits<float>::quiet_NaN() : 7);
    }
    return table;
  };
  const auto auc_of = [&](double shift, double wider) {
    const LogisticScore score(drawn(1, shift, wider));
    const SampleTable fresh = drawn(2, shift, wider);
    std::vector<double> scores;
    for (std::size_t i = 0; i < fresh.size(); ++i) scores.push_back(score.score(fresh.row(i)));
    return auc(scores, fresh.positive);
  };
  EXPECT_NEAR(auc_of(1, 1), 0.5 * std::erfc(-0.5), 0.025);  // Phi(1 / sqrt(2))
  // |a| > |b| of normals, one three times as wide: 2 / pi * atan(3).
  EXPECT_NEAR(auc_of(0, 3), 2 / std::acos(-1.0) * std::atan(3.0), 0.025);
  EXPECT_NEAR(auc_of(0, 1), 0.5, 0.03);
  EXPECT_EQ(auc_of(1000, 1), 1);  // separable: weights stay finite
}

}  // namespace
}  // namespace adasplats
