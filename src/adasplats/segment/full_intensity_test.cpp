// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/full_intensity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

float searched(const std::vector<float>& intensities) {
  FullIntensitySearch search;
  const std::span<const float> all(intensities);
  const std::size_t half = all.size() / 2;
  search.add_first(all.first(half));
  search.add_first(all.subspan(half));
  search.begin_second();
  search.add_second(all.subspan(half));
  search.add_second(all.first(half));
  return search.value();
}

// Oracle: the sorted values.
TEST(FullIntensity, DoesNotDependOnTheParts) {
  for (const std::size_t count : {1, 2, 99, 100, 101, 5000}) {
    for (const double low : {0.0, -3.0}) {
      std::vector<float> values;
      for (std::size_t i = 0; i < count; ++i) {
        Random random(count, 0, i);
        const double value = random.uniform(low, 1);
        values.push_back(static_cast<float>(i % 3 == 0 ? std::round(10 * value) / 10 : value));
      }
      std::vector<float> sorted = values;
      std::ranges::sort(sorted);
      const auto place = static_cast<std::size_t>(0.99 * static_cast<double>(count - 1));
      const float expected = std::max(1e-6F, sorted[place]);
      EXPECT_EQ(full_intensity(values), expected);
      EXPECT_EQ(searched(values), expected);
    }
  }
}

TEST(FullIntensity, UnknownIntensitiesAreIgnored) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const std::vector<float>& values : {std::vector<float>{}, {kNaN, kInfinity, -kInfinity}}) {
    EXPECT_EQ(full_intensity(values), 1);
    EXPECT_EQ(searched(values), 1);
  }
  EXPECT_EQ(searched({kNaN, 7, kInfinity}), 7);
  EXPECT_EQ(searched({-0.0F, 0.0F, -5}), 1e-6F);
  EXPECT_EQ(full_intensity(std::vector<float>{-0.0F, 0.0F, -5}), 1e-6F);
}

}  // namespace
}  // namespace adasplats
