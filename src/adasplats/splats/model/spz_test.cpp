// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/spz.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "adasplats/io/pickle/gzip.h"

namespace adasplats {
namespace {

// tests/exports reads all fields with Niantic's library; here those that it does not vary.

std::string unpacked(const std::string& spz) { return gunzipped("test.spz", spz, 1 << 20); }

std::uint32_t word_at(const std::string& bytes, std::size_t at, int count) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, static_cast<std::size_t>(count));
  return word;
}

TEST(Spz, BytesOfTheLayout) {
  const std::vector<Disk> disks = {{{3, -2, 0.5F}, std::sqrt(2.0F), {0, 0, 1}}};
  const std::string bytes =
      unpacked(spz_of(disks, std::vector<ColorBytes>{{0, 255, 128}}, {1, 0, 0}));
  ASSERT_EQ(bytes.size(), 16U + 9 + 1 + 3 + 3 + 4);
  EXPECT_EQ(bytes.substr(0, 4), "NGSP");
  EXPECT_EQ(word_at(bytes, 4, 4), 3U);         // version
  EXPECT_EQ(word_at(bytes, 8, 4), 1U);         // points
  EXPECT_EQ(word_at(bytes, 12, 4), 12U << 8);  // degree 0, 12 bits after the point, no flags
  EXPECT_EQ(word_at(bytes, 16, 3), 2U << 12);
  EXPECT_EQ(word_at(bytes, 19, 3), 0x1000000U - (2U << 12));
  EXPECT_EQ(word_at(bytes, 22, 3), 1U << 11);
  EXPECT_EQ(word_at(bytes, 25, 1), 255U);  // opacity
  // 0.15 (colour - 0.5) / 0.2821 + 0.5
  EXPECT_EQ(word_at(bytes, 26, 1), 60U);
  EXPECT_EQ(word_at(bytes, 27, 1), 195U);
  EXPECT_EQ(word_at(bytes, 28, 1), 128U);
  // 16 (ln sigma + 10): sigma is 1 m, and 1 cm along the normal.
  EXPECT_EQ(word_at(bytes, 29, 2), 160U << 8 | 160U);
  EXPECT_EQ(word_at(bytes, 31, 1), 86U);
  EXPECT_EQ(word_at(bytes, 32, 4), 3U << 30);  // w is the largest
}

TEST(Spz, PositionsFarAway) {
  for (const auto& [far_m, bits] : {std::pair{2047.9F, 12U}, {2049.0F, 11U}, {1e6F, 3U}}) {
    const std::vector<Disk> disks = {{{far_m, 0, -far_m}, 1, {1, 0, 0}}};
    const std::string bytes = unpacked(spz_of(disks, std::vector<ColorBytes>(1), {}));
    EXPECT_EQ(word_at(bytes, 13, 1), bits) << far_m;
    const double steps = std::ldexp(1.0, static_cast<int>(bits));
    EXPECT_NEAR(word_at(bytes, 16, 3) / steps, far_m, 0.5 / steps);
    EXPECT_EQ(word_at(bytes, 22, 3) + word_at(bytes, 16, 3), 0x1000000U);
  }
}

TEST(Spz, NoDisksAndWrongColours) {
  EXPECT_EQ(unpacked(spz_of({}, {}, {})).size(), 16U);
  EXPECT_THROW(spz_of({}, std::vector<ColorBytes>(1), {}), std::logic_error);
}

TEST(Spz, GlbIsCompleteAndPadded) {
  const std::vector<Disk> disks = {{{10, 20, 30}, 1, {0, 0, 1}}, {{12, 20, 34}, 2, {0, 1, 0}}};
  const std::string glb = spz_glb(disks, std::vector<ColorBytes>(2));
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(glb, 8, 4), glb.size());
  EXPECT_EQ(glb.size() % 4, 0U);
  // The center of the box, with z up turned to y up.
  EXPECT_NE(glb.find(R"("matrix":[1,0,0,0,0,0,-1,0,0,1,0,0,11,32,-20,1])"), std::string::npos);
  EXPECT_EQ(glb, spz_glb(disks, std::vector<ColorBytes>(2)));
}

}  // namespace
}  // namespace adasplats
