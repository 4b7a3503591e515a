// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/realism/auc.h"
#include "adasplats/evaluate/realism/classifiers.h"

namespace adasplats {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

/// Five normal features; of positive samples the third is higher by `shift`.
SampleTable shifted(std::uint64_t seed, std::size_t count, double shift) {
  SampleTable table{5, {}, {}};
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, 2, i);
    const bool positive = i % 2 == 0;
    table.positive.push_back(positive ? 1 : 0);
    for (std::size_t f = 0; f < table.columns; ++f)
      table.values.push_back(
          static_cast<float>(random.normal() + (f == 2 && positive ? shift : 0)));
  }
  return table;
}

double auc_on(const BoostedTrees& trees, const SampleTable& table) {
  std::vector<double> scores;
  for (std::size_t i = 0; i < table.size(); ++i) scores.push_back(trees.score(table.row(i)));
  return auc(scores, table.positive);
}

TEST(BoostedTrees, TellShiftedNormalsAsWellAsCanBe) {
  for (const double shift : {0.5, 1.0, 2.0}) {
    const BoostedTrees trees(shifted(1, 6000, shift), {});
    // The best that any classifier can do: Phi(shift / sqrt(2)).
    const double best = 0.5 * std::erfc(-shift / 2);
    const double found = auc_on(trees, shifted(2, 6000, shift));
    EXPECT_LT(found, best + 0.015);  // two deviations of an AUC of 3000 and 3000 samples
    EXPECT_GT(found, best - 0.03);
  }
}

TEST(BoostedTrees, FindNothingInNoise) {
  const BoostedTrees trees(shifted(1, 4000, 0), {});
  EXPECT_NEAR(auc_on(trees, shifted(2, 4000, 0)), 0.5, 0.03);
}

TEST(BoostedTrees, LearnAnInteractionOfTwoFeatures) {
  SampleTable table{2, {}, {}};
  for (std::size_t i = 0; i < 2000; ++i) {
    Random random(3, 3, i);
    const double a = random.uniform(-1, 1), b = random.uniform(-1, 1);
    table.values.push_back(static_cast<float>(a));
    table.values.push_back(static_cast<float>(b));
    table.positive.push_back((a > 0) == (b > 0) ? 1 : 0);
  }
  EXPECT_GT(auc_on(BoostedTrees(table, {}), table), 0.99);
}

TEST(BoostedTrees, KnowThatAFeatureIsMissing) {
  SampleTable table{1, {}, {}};
  for (std::size_t i = 0; i < 400; ++i) {
    const bool positive = i % 2 == 0;
    table.positive.push_back(positive ? 1 : 0);
    table.values.push_back(positive && i % 4 == 0 ? kMissing : static_cast<float>(i % 7));
  }
  const BoostedTrees trees(table, {});
  const float nothing[] = {kMissing}, something[] = {3};
  EXPECT_GT(trees.score(nothing), 2.0);    // all of these are positive
  EXPECT_LT(trees.score(something), 0.0);  // a third of these
}

TEST(BoostedTrees, OfConstantFeaturesPredictTheOdds) {
  SampleTable table{1, std::vector<float>(100, 1.0F), std::vector<std::uint8_t>(100, 0)};
  for (std::size_t i = 0; i < 25; ++i) table.positive[i] = 1;
  const float row[] = {1};
  EXPECT_NEAR(BoostedTrees(table, {}).score(row), std::log(25.0 / 75), 1e-6);
}

TEST(BoostedTrees, NeedBothClasses) {
  SampleTable table{1, {1, 2}, {1, 1}};
  EXPECT_THROW(BoostedTrees(table, {}), std::logic_error);
  EXPECT_THROW(BoostedTrees(SampleTable{1, {}, {}}, {}), std::logic_error);
}

}  // namespace
}  // namespace adasplats
