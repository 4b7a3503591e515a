// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/median.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace adasplats {
namespace {

// Oracle: by hand, and sorting.
TEST(UpperMedian, IsTheValueInTheMiddle) {
  EXPECT_EQ(upper_median_of(std::vector<double>{7}), 7);
  EXPECT_EQ(upper_median_of(std::vector<double>{7, -1}), 7);
  EXPECT_EQ(upper_median_of(std::vector<int>{3, 1, 2}), 2);
  EXPECT_EQ(upper_median_of(std::vector<float>{4, 1, 3, 2}), 3);
  EXPECT_EQ(upper_median_of(std::vector<int>(6, 5)), 5);
  std::vector<int> values;
  for (int k = 0; k < 101; ++k) values.push_back(k * 37 % 101 - 50);
  EXPECT_EQ(upper_median_of(values), 0);
  std::ranges::sort(values);
  EXPECT_EQ(values.front(), -50);
  EXPECT_EQ(values.back(), 50);
}

}  // namespace
}  // namespace adasplats
