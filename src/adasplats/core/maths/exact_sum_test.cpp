// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

/// Numbers of many sizes and both signs; all of one sign and size for kind 1.
std::vector<double> some_numbers(std::uint64_t kind, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(1, kind, i);
    const double size = kind == 1 ? 1.0 : std::pow(10.0, random.uniform(-12, 3));
    numbers.push_back((kind == 0 && random.uniform() < 0.5 ? -1 : 1) * size * random.uniform());
  }
  return numbers;
}

double largest_of(const std::vector<double>& numbers) {
  double largest = 0;
  for (const double v : numbers) largest = std::max(largest, std::fabs(v));
  return largest;
}

/// Added by so many lanes, whose sums are added in turn.
double sum_on_lanes(const std::vector<double>& numbers, const ExactAddends& exact, int lanes) {
  std::vector<double> parts(static_cast<std::size_t>(lanes));
  for (std::size_t i = 0; i < numbers.size(); ++i) parts[i % parts.size()] += exact(numbers[i]);
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

// Oracle: any other order.
TEST(ExactAddends, SumsAreTheSameInEveryOrder) {
  for (const std::size_t count : {1, 2, 3, 40, 120, 512, 1000}) {
    for (const std::uint64_t kind : {0, 1, 2}) {
      std::vector<double> numbers = some_numbers(kind, count);
      const ExactAddends exact(static_cast<std::uint32_t>(count), largest_of(numbers));
      const double expected = sum_on_lanes(numbers, exact, 1);
      EXPECT_EQ(sum_on_lanes(numbers, exact, 32), expected);
      std::sort(numbers.begin(), numbers.end());
      EXPECT_EQ(sum_on_lanes(numbers, exact, 1), expected);
      std::reverse(numbers.begin(), numbers.end());
      EXPECT_EQ(sum_on_lanes(numbers, exact, 7), expected);
    }
  }
}

// Oracle: long double's sum.
TEST(ExactAddends, SumsAreWithinTheUnit) {
  for (const std::size_t count : {1, 40, 1000}) {
    const std::vector<double> numbers = some_numbers(0, count);
    const double largest = largest_of(numbers);
    long double expected = 0;
    for (const double v : numbers) expected += static_cast<long double>(v);
    const ExactAddends exact(static_cast<std::uint32_t>(count), largest);
    const auto n = static_cast<double>(count);
    EXPECT_NEAR(sum_on_lanes(numbers, exact, 1), static_cast<double>(expected),
                n * (n * largest) * 0x1.0p-50);
  }
}

TEST(ExactAddends, NothingAndTheSmallestNumbers) {
  EXPECT_EQ(ExactAddends(5, 0)(0.0), 0.0);
  EXPECT_EQ(ExactAddends(0, 3)(0.0), 0.0);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(ExactAddends(5, least)(least), least);
  EXPECT_EQ(ExactAddends(1, 1)(1.0), 1.0);
  EXPECT_EQ(ExactAddends(1, 1e300)(-1e300), -1e300);
}

}  // namespace
}  // namespace adasplats
