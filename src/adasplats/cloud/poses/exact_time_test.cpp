// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/exact_time.h"

#include <gtest/gtest.h>

namespace adasplats {
namespace {

constexpr std::int64_t kNanosecond = 1'000'000'000;

// Oracle: the digits.
TEST(ExactTime, DecimalNumbersInEveryUnit) {
  const ExactTime expected{1700000000, 123456789 * kNanosecond};
  EXPECT_EQ(exact_time("1700000000123456789", -9), expected);
  EXPECT_EQ(exact_time("1700000000.123456789", 0), expected);
  EXPECT_EQ(exact_time("+001700000000123456.789", -6), expected);
  EXPECT_EQ(exact_time("1.700000000123456789e18", -9), expected);
  EXPECT_EQ(exact_time("17000000001234567890E-1", -9), expected);
  EXPECT_EQ(exact_time("5", -9), (ExactTime{0, 5 * kNanosecond}));
  EXPECT_EQ(exact_time("0", 0), (ExactTime{0, 0}));
  EXPECT_EQ(exact_time(".5", 0), (ExactTime{0, 500'000'000 * kNanosecond}));
  EXPECT_EQ(exact_time("-0.25", 0), (ExactTime{-1, 750'000'000 * kNanosecond}));
  EXPECT_EQ(exact_time("-3", 0), (ExactTime{-3, 0}));
  EXPECT_EQ(exact_time("1e-19", 0), (ExactTime{0, 0}));
}

TEST(ExactTime, OtherTextsAreNone) {
  for (const char* text : {"", "-", ".", "nan", "inf", "1e", "1e99", "1 2", "0x5", "1.2.3",
                           "100000000000000000000000000"})
    EXPECT_EQ(exact_time(text, 0), std::nullopt) << text;
}

TEST(ExactTime, OrderAndSum) {
  EXPECT_LT(*exact_time("315966253572412942", -9), *exact_time("315966253572412947", -9));
  EXPECT_LT(*exact_time("-1.5", 0), *exact_time("-1.25", 0));
  EXPECT_EQ((ExactTime{1, 999'999'999 * kNanosecond} + ExactTime{2, kNanosecond}),
            (ExactTime{4, 0}));
}

TEST(ExactTime, EqualDoublesStayDistinct) {
  EXPECT_EQ(time_after(1.0, 2.0), 2.0);
  const double after_s = time_after(1.7e9, 1.7e9);
  EXPECT_GT(after_s, 1.7e9);
  EXPECT_LT(after_s, 1.7e9 + 1e-6);
}

}  // namespace
}  // namespace adasplats
