// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/auc.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

/// All pairs one by one, the definition.
struct WonPairs {
  double won = 0, all = 0;
  void add(const ScoredSamples& samples) {
    for (std::size_t i = 0; i < samples.scores.size(); ++i) {
      for (std::size_t j = 0; j < samples.scores.size(); ++j) {
        if (samples.positive[i] == 0 || samples.positive[j] != 0) continue;
        all += 1;
        if (samples.scores[i] > samples.scores[j]) won += 1;
        if (samples.scores[i] == samples.scores[j]) won += 0.5;
      }
    }
  }
};

/// Scores on a grid, so that many are equal; positive ones are higher by `shift`.
ScoredSamples samples_of(std::uint64_t seed, std::size_t count, double shift,
                         std::uint32_t scans = 1) {
  ScoredSamples samples;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, 1, i);
    const bool positive = random.uniform() < 0.4;
    samples.positive.push_back(positive ? 1 : 0);
    samples.scores.push_back(std::round(4 * (random.normal() + (positive ? shift : 0))) / 4);
    // Scans of the negative class first.
    const auto of_class = static_cast<std::uint32_t>(random.uniform() * scans);
    samples.scans.push_back(positive ? scans + of_class : of_class);
  }
  return samples;
}

TEST(Auc, IsTheShareOfPairsByBruteForce) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ScoredSamples samples = samples_of(seed, 20 * seed, 0.1 * static_cast<double>(seed));
    WonPairs pairs;
    pairs.add(samples);
    EXPECT_NEAR(auc(samples.scores, samples.positive), pairs.won / pairs.all, 1e-12);
  }
}

TEST(Auc, OfFewSamples) {
  EXPECT_TRUE(std::isnan(auc({}, {})));
  const std::vector<double> one = {1};
  const std::vector<std::uint8_t> is_positive = {1};
  EXPECT_TRUE(std::isnan(auc(one, is_positive)));
  const std::vector<double> equal = {3, 3, 3, 3};
  const std::vector<std::uint8_t> mixed = {1, 0, 0, 1};
  EXPECT_DOUBLE_EQ(auc(equal, mixed), 0.5);
}

TEST(AucInterval, ComparesWithinPartsAlone) {
  // All scores of the second part exceed those of the first: pairs across parts would separate
  // classes.
  ScoredSplit split = {samples_of(1, 200, 0.5), samples_of(2, 300, 0.5)};
  for (double& score : split[1].scores) score += 100;
  WonPairs pairs;
  for (const ScoredSamples& part : split) pairs.add(part);
  const std::size_t sets[] = {1, 1};
  const AucInterval interval = auc_interval({&split, 1}, sets, 1);
  EXPECT_NEAR(interval.mean, pairs.won / pairs.all, 1e-12);
}

TEST(AucInterval, IsAsWideAsRepetitionsAre) {
  // Oracle: the spread of the figure itself over 200 new sets of scans.
  const std::size_t sets[] = {10, 10};
  double sum = 0, squares = 0, width = 0;
  constexpr int kRepetitions = 200;
  for (int k = 0; k < kRepetitions; ++k) {
    ScoredSplit split = {samples_of(100 + static_cast<std::uint64_t>(k), 400, 0.5, 10)};
    // A scan's samples go up and down together.
    for (std::size_t i = 0; i < split[0].scores.size(); ++i)
      split[0].scores[i] +=
          0.5 * Random(static_cast<std::uint64_t>(k), 7, split[0].scans[i]).normal();
    const AucInterval interval = auc_interval({&split, 1}, sets, 1);
    sum += interval.mean;
    squares += interval.mean * interval.mean;
    width += (interval.high - interval.low) / kRepetitions;
  }
  const double mean = sum / kRepetitions;
  const double deviation = std::sqrt(squares / kRepetitions - mean * mean);
  EXPECT_NEAR(width, 2 * 1.96 * deviation, 0.25 * width);
}

TEST(AucInterval, ManySplitsGiveTheirMean) {
  std::vector<ScoredSplit> splits;
  double mean = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    splits.push_back({samples_of(seed, 100, 0.3)});
    mean += 0.25 * auc(splits.back()[0].scores, splits.back()[0].positive);
  }
  const std::size_t sets[] = {2};
  EXPECT_NEAR(auc_interval(splits, sets, 1).mean, mean, 1e-12);
}

}  // namespace
}  // namespace adasplats
