// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/number_text.h"

#include <gtest/gtest.h>

namespace adasplats {
namespace {

// Oracle: by hand.
TEST(NumberText, DecimalsAreWithoutTheLastBitsOfArithmetic) {
  EXPECT_EQ(exact_text(8488997 * 0.1), "848899.7000000001");
  EXPECT_EQ(decimal_text(8488997 * 0.1), "848899.7");
  EXPECT_EQ(decimal_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(decimal_text(-0.0), "0");
  EXPECT_EQ(decimal_text(-12.5), "-12.5");
  EXPECT_EQ(decimal_text(500000), "500000");
  EXPECT_EQ(decimal_text(123456789.012345), "123456789.012345");
  EXPECT_EQ(decimal_text(1e300), "1e+300");
}

}  // namespace
}  // namespace adasplats
