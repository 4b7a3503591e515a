// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/smooth_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

struct Measured {
  std::vector<double> times_s, values, deviations;
};

/// A uniform motion at 3 per second with noise.
Measured noisy_line(double noise) {
  Measured line;
  Random random(3, 0, 0);
  for (int k = 0; k < 40; ++k) {
    line.times_s.push_back(0.1 * k);
    line.values.push_back(5 + 3 * line.times_s.back() + noise * random.normal());
    line.deviations.push_back(0.2);
  }
  return line;
}

TEST(SmoothPath, NoiseShrinksAndRatesAreRight) {
  const Measured line = noisy_line(0.2);
  const SmoothPath path = smooth_path(line.times_s, line.values, line.deviations, 1);
  double before = 0, after = 0;
  for (std::size_t k = 0; k < line.values.size(); ++k) {
    const double truth = 5 + 3 * line.times_s[k];
    before += std::pow(line.values[k] - truth, 2);
    after += std::pow(path.values[k] - truth, 2);
    EXPECT_NEAR(path.rates[k], 3, 0.7);
  }
  EXPECT_LT(after, 0.35 * before);
}

TEST(SmoothPath, OneWrongValueHardlyMatters) {
  Measured line = noisy_line(0.02);
  line.values[20] += 4;
  const SmoothPath path = smooth_path(line.times_s, line.values, line.deviations, 1);
  EXPECT_NEAR(path.values[20], 5 + 3 * line.times_s[20], 0.15);
}

TEST(SmoothPath, ExactValuesStay) {
  const Measured line = noisy_line(0);
  const SmoothPath path = smooth_path(line.times_s, line.values, line.deviations, 1);
  EXPECT_NEAR(path.values.front(), 5, 1e-3);
  EXPECT_NEAR(path.rates.back(), 3, 1e-3);
  EXPECT_TRUE(smooth_path({}, {}, {}, 1).values.empty());
  EXPECT_EQ(smooth_path(std::vector{1.0}, std::vector{2.0}, std::vector{0.1}, 1).values.size(), 1U);
}

}  // namespace
}  // namespace adasplats
