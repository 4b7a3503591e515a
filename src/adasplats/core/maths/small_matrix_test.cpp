// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/small_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

// Oracle: what defines them, a v = value v, with unit v across one another.
TEST(SmallEigen, OfSixRows) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(9, 0, seed);
    std::array<double, 36> a{};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = 0; k <= i; ++k) a[i * 6 + k] = a[k * 6 + i] = random.normal();
    const SmallEigen<6> eigen = small_eigen<6>(a);
    for (std::size_t n = 0; n < 6; ++n) {
      for (std::size_t i = 0; i < 6; ++i) {
        double product = 0;
        for (std::size_t k = 0; k < 6; ++k) product += a[i * 6 + k] * eigen.vectors[n][k];
        EXPECT_NEAR(product, eigen.values[n] * eigen.vectors[n][i], 1e-12);
      }
      for (std::size_t m = 0; m < 6; ++m) {
        double product = 0;
        for (std::size_t k = 0; k < 6; ++k) product += eigen.vectors[n][k] * eigen.vectors[m][k];
        EXPECT_NEAR(product, n == m ? 1 : 0, 1e-12);
      }
    }
  }
}

// Oracle: analytic.
TEST(SmallEigen, OfEqualValuesOfZeroAndOfOneRow) {
  EXPECT_EQ((small_eigen<1>({-3}).values[0]), -3);
  const SmallEigen<2> none = small_eigen<2>({0, 0, 0, 0});
  EXPECT_EQ(none.values, (std::array<double, 2>{}));
  EXPECT_EQ(none.vectors[0], (std::array<double, 2>{1, 0}));
  SmallEigen<3> equal = small_eigen<3>({2, 1, 1, 1, 2, 1, 1, 1, 2});
  std::ranges::sort(equal.values);
  EXPECT_NEAR(equal.values[0], 1, 1e-14);
  EXPECT_NEAR(equal.values[1], 1, 1e-14);
  EXPECT_NEAR(equal.values[2], 4, 1e-14);
}

}  // namespace
}  // namespace adasplats
