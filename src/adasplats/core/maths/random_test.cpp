// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "adasplats/core/maths/first_normals.h"

namespace adasplats {
namespace {

struct Moments {
  double mean, variance, fourth;
};

template <class Draw>
Moments moments_of(std::size_t count, Draw&& draw) {
  double sum = 0, squares = 0, fourths = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double v = draw(i);
    sum += v;
    squares += v * v;
    fourths += v * v * v * v;
  }
  const auto n = static_cast<double>(count);
  return {sum / n, squares / n - (sum / n) * (sum / n), fourths / n};
}

constexpr std::size_t kDraws = 1'000'000;

// Oracle: analytic moments. The limits are five standard errors of a million draws.
TEST(Random, UniformAcrossIndicesAndAlongOneStream) {
  Random along(1, 2, 3);
  for (const Moments& m :
       {moments_of(kDraws, [](std::size_t i) { return Random(1, 2, i).uniform(); }),
        moments_of(kDraws, [&](std::size_t) { return along.uniform(); })}) {
    EXPECT_NEAR(m.mean, 0.5, 5 * 0.2887e-3);
    EXPECT_NEAR(m.variance, 1.0 / 12, 5 * 0.0745e-3);
  }
}

TEST(Random, NormalHasTheMomentsOfTheStandardNormal) {
  const Moments m = moments_of(kDraws, [](std::size_t i) { return Random(9, 0, i).normal(); });
  EXPECT_NEAR(m.mean, 0, 5e-3);
  EXPECT_NEAR(m.variance, 1, 5 * 1.414e-3);
  EXPECT_NEAR(m.fourth, 3, 5 * 9.8e-3);
}

TEST(Random, FirstNormalsAreThoseOfTheIndices) {
  for (const std::size_t count : {0, 1, 127, 128, 129, 1000}) {
    std::vector<double> normals(count);
    first_normals(3, 5, 0xfffffff0, normals);
    for (std::size_t i = 0; i < count; ++i)
      ASSERT_EQ(normals[i], Random(3, 5, 0xfffffff0 + i).normal()) << i << " of " << count;
  }
}

TEST(Random, UniformStaysInItsRange) {
  double low = 1, high = 0;
  for (std::size_t i = 0; i < kDraws; ++i) {
    Random random(4, 0, i);
    const double v = random.uniform();
    low = std::min(low, v);
    high = std::max(high, v);
    const double w = random.uniform(-3, 5);
    ASSERT_TRUE(w >= -3 && w < 5);
  }
  EXPECT_GE(low, 0);
  EXPECT_LT(low, 1e-4);
  EXPECT_LT(high, 1);
  EXPECT_GT(high, 1 - 1e-4);
}

TEST(Random, SameNameSameValue) {
  Random a(1, 2, 3), b(1, 2, 3);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.next_bits(), b.next_bits());
}

TEST(Random, NeighbouringNamesAreDifferentNumbers) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    for (std::uint64_t stream = 0; stream < 20; ++stream)
      for (std::uint64_t index = 0; index < 20; ++index)
        seen.insert(Random(seed, stream, index).next_bits());
  EXPECT_EQ(seen.size(), 8000U);
}

// Oracle: independent numbers have correlation 0; five standard errors of 100,000 pairs.
TEST(Random, StreamsAndIndicesAreUncorrelated) {
  constexpr std::size_t kPairs = 100'000;
  double streams = 0, indices = 0, seeds = 0;
  for (std::size_t i = 0; i < kPairs; ++i) {
    const double v = Random(1, 0, i).uniform() - 0.5;
    streams += v * (Random(1, 1, i).uniform() - 0.5);
    indices += v * (Random(1, 0, i + 1).uniform() - 0.5);
    seeds += v * (Random(2, 0, i).uniform() - 0.5);
  }
  const double limit = 5 * std::sqrt(static_cast<double>(kPairs)) / 12;
  EXPECT_LT(std::abs(streams), limit);
  EXPECT_LT(std::abs(indices), limit);
  EXPECT_LT(std::abs(seeds), limit);
}

}  // namespace
}  // namespace adasplats
