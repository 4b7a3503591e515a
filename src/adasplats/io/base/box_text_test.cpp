// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/box_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace adasplats {
namespace {

// Oracle: by hand.
TEST(BoxText, NamesTheAxesThatHaveBounds) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  EXPECT_EQ(box_text({1, -2.5, 652000.25}, {1, 0, 652001}),
            "x 1 .. 1, y -2.5 .. 0, z 652000.25 .. 652001");
  EXPECT_EQ(box_text({1, -kAny, -kAny}, {2, kAny, 3}), "x 1 .. 2, z -inf .. 3");
  EXPECT_EQ(box_text({-kAny, -kAny, -kAny}, {kAny, kAny, kAny}), "");
}

}  // namespace
}  // namespace adasplats
