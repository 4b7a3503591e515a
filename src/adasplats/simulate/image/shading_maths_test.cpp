// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/shading_maths.h"

#include <gtest/gtest.h>

#include <cmath>

namespace adasplats {
namespace {

// Oracle: the library's logarithm.
TEST(ShadingMaths, Log10IsThatOfTheLibrary) {
  for (float x = 1e-6F; x < 1e6F; x *= 1.0007F) {
    const double expected = std::log10(static_cast<double>(x));
    EXPECT_NEAR(shading::log10_anywhere(x), expected, 1e-9 + 1e-7 * std::fabs(expected)) << x;
  }
  EXPECT_EQ(shading::log10_anywhere(1), 0.0F);
  EXPECT_NEAR(shading::log10_anywhere(10), 1.0F, 1e-7F);
  EXPECT_NEAR(shading::log10_anywhere(1e30F), 30.0F, 1e-5F);
}

}  // namespace
}  // namespace adasplats
