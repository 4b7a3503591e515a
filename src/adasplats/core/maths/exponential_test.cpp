// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/exponential.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace adasplats {
namespace {

TEST(Exponential, IsThatOfTheLibraryToTwoUnits) {
  for (int i = 0; i <= 870'000; ++i) {
    const float x = -1e-4F * static_cast<float>(i);
    const double expected = std::exp(static_cast<double>(x));
    ASSERT_NEAR(exp_of_negative(x), expected, 2.4e-7 * expected) << x;
  }
  EXPECT_EQ(exp_of_negative(0), 1);
  EXPECT_EQ(exp_of_negative(-0.0F), 1);
}

TEST(Exponential, TakesWhatIsNoNormalNumber) {
  EXPECT_EQ(exp_of_negative(-88), 0);
  EXPECT_EQ(exp_of_negative(-std::numeric_limits<float>::infinity()), 0);
  EXPECT_TRUE(std::isnan(exp_of_negative(std::numeric_limits<float>::quiet_NaN())));
}

}  // namespace
}  // namespace adasplats
