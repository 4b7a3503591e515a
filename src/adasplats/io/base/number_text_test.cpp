// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/number_text.h"

#include <gtest/gtest.h>

#include <limits>

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

namespace {

// Oracle: by hand.
TEST(BoxText, NamesTheAxesThatHaveBounds) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  EXPECT_EQ(box_text({1, -2.5, 652000.25}, {1, 0, 652001}),
            "x 1 .. 1, y -2.5 .. 0, z 652000.25 .. 652001");
  EXPECT_EQ(box_text({1, -kAny, -kAny}, {2, kAny, 3}), "x 1 .. 2, z -inf .. 3");
  EXPECT_EQ(box_text({-kAny, -kAny, -kAny}, {kAny, kAny, kAny}), "");
}

TEST(NumberText, OtherTextsThanUtf8AreLatin1) {
  for (const char* const text : {"", "zone 32", "p\xc3\xa5", "\xe2\x82\xac", "\xf0\x9f\x98\x80"})
    EXPECT_EQ(utf8_text(text), text);
  EXPECT_EQ(utf8_text("p\xe5 EUREF89"), "p\xc3\xa5 EUREF89");
  EXPECT_EQ(utf8_text("p\xc3"), "p\xc3\x83");  // cut
  EXPECT_EQ(utf8_text("\xa5"), "\xc2\xa5");
}

}  // namespace
}  // namespace adasplats
