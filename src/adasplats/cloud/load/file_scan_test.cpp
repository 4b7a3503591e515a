// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/file_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

using Scans = std::vector<std::vector<float>>;

// Oracle: the rule, by hand.
TEST(IntensityScale, BytesBecomeShares) {
  const IntensityScale bytes(Scans{{0, 1}, {51, 255}});
  const std::vector<float> shares = {0, 0.2F, 1};
  EXPECT_EQ(bytes.scaled({0, 51, 255}, "f"), shares);
  expect_error(ErrorKind::data, {"f.bin", "0.5"}, [&] { bytes.scaled({3, 0.5F}, "f.bin"); });
  expect_error(ErrorKind::data, {"f.bin", "256"}, [&] { bytes.scaled({256}, "f.bin"); });
}

TEST(IntensityScale, OthersStay) {
  const std::vector<float> shares = {0, 0.25F, 1};
  const IntensityScale as_shares(Scans{shares, {1, 0}});
  EXPECT_EQ(as_shares.scaled(shares, "f"), shares);
  expect_error(ErrorKind::data, {"f.bin", "at most 1"}, [&] { as_shares.scaled({2}, "f.bin"); });
  const IntensityScale fractions(Scans{{0.5F, 200}});
  EXPECT_EQ(fractions.scaled({300, 0.25F}, "f"), std::vector<float>({300, 0.25F}));
  const IntensityScale large(Scans{{0, 65535}});
  EXPECT_EQ(large.scaled({65535}, "f").front(), 65535.0F);
  EXPECT_TRUE(IntensityScale(Scans{}).scaled({}, "f").empty());
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(IntensityScale(Scans{{unknown, 7}}).scaled({unknown}, "f").front()));
}

}  // namespace
}  // namespace adasplats
