// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace adasplats {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

/// Greatest difference from the library over a million places, in units of `scale(x)` * 2^-52.
template <class Ours, class Library, class Scale>
double worst(double low, double high, Ours&& ours, Library&& library, Scale&& scale) {
  constexpr int kPlaces = 1'000'000;
  double most = 0;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = low + (high - low) * i / kPlaces;
    const double expected = library(x);
    most = std::max(most, std::fabs(ours(x) - expected) / (kUlp * scale(expected)));
  }
  return most;
}
double relative(double x) { return std::max(std::fabs(x), 1e-300); }
double absolute(double) { return 1.0; }

// Oracle: the C library, which is right to one unit in the last place.
TEST(Elementary, AgreesWithTheLibrary) {
  const auto exp_of_x = [](double x) { return std::exp(x); };
  EXPECT_LT(worst(-700, 700, exp_of, exp_of_x, relative), 2);
  EXPECT_LT(worst(-1, 1, exp_of, exp_of_x, relative), 2);
  const auto log_of_x = [](double x) { return std::log(x); };
  EXPECT_LT(worst(1e-9, 4, log_of, log_of_x, relative), 2);
  EXPECT_LT(worst(1, 1e6, log_of, log_of_x, relative), 2);
  const auto cos_of_x = [](double x) { return std::cos(2 * std::numbers::pi * x); };
  EXPECT_LT(worst(0, 1, cos_of_turns, cos_of_x, absolute), 6);  // 2 pi x is rounded, too
  const auto expm1_of_x = [](double x) { return std::expm1(x); };
  EXPECT_LT(worst(-1, 3, expm1_of, expm1_of_x, relative), 4);
  EXPECT_LT(worst(0, 1e-6, expm1_of, expm1_of_x, relative), 2);
}

// Oracle: the complementary error function of the C library.
TEST(Elementary, CumulativeNormalDistribution) {
  for (double x = -6; x <= 6; x += 0.01)
    ASSERT_NEAR(normal_share(x), 0.5 * std::erfc(-x / std::numbers::sqrt2), 1e-7) << x;
  EXPECT_EQ(normal_share(-40), 0);
  EXPECT_EQ(normal_share(40), 1);
}

// Oracle: the logarithm, which is concave: never above it, furthest where its slope is that of the
// line.
TEST(Elementary, FloorOfTheLogarithm) {
  double most = 0;
  for (double x = 1e-3; x < 1e3; x *= 1.0001) {
    const double less = std::log(x) - log_floor_of(x);
    ASSERT_GE(less, -1e-12) << x;
    most = std::max(most, less);
  }
  EXPECT_LE(most, kLogFloorError);
  EXPECT_GT(most, kLogFloorError - 1e-3);
}

TEST(Elementary, Borders) {
  EXPECT_EQ(exp_of(0), 1);
  EXPECT_EQ(exp_of(-1e9), 0);
  EXPECT_EQ(exp_of(-std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(exp_of(710), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(exp_of(std::nan(""))));
  EXPECT_EQ(expm1_of(0), 0);
  EXPECT_EQ(log_of(1), 0);
  EXPECT_EQ(cos_of_turns(0), 1);
  EXPECT_EQ(cos_of_turns(0.25), 0);
  EXPECT_EQ(cos_of_turns(0.5), -1);
}

}  // namespace

namespace {

TEST(Exponential, AgreesWithTheLibraryToTwoUnits) {
  for (int i = 0; i <= 870'000; ++i) {
    const float x = -1e-4F * static_cast<float>(i);
    const double expected = std::exp(static_cast<double>(x));
    ASSERT_NEAR(exp_of_negative(x), expected, 2.4e-7 * expected) << x;
  }
  EXPECT_EQ(exp_of_negative(0), 1);
  EXPECT_EQ(exp_of_negative(-0.0F), 1);
}

TEST(Exponential, AcceptsSubnormalNumbersAndNaN) {
  EXPECT_EQ(exp_of_negative(-88), 0);
  EXPECT_EQ(exp_of_negative(-std::numeric_limits<float>::infinity()), 0);
  EXPECT_TRUE(std::isnan(exp_of_negative(std::numeric_limits<float>::quiet_NaN())));
}

}  // namespace

}  // namespace adasplats
