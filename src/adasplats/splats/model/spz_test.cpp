// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/spz.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <variant>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/pickle/gzip.h"
#include "adasplats/splats/model/any_model.h"

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

TEST(Spz, IsReadAsAModelWithZUp) {
  std::vector<Disk> disks;
  for (std::uint64_t i = 0; i < 200; ++i) {
    Random random(4, 0, i);
    const auto number = [&](double low, double high) { return random.uniform(low, high); };
    const Vec3d normal = normalized(Vec3d{number(-1, 1), number(-1, 1), number(-1, 1)});
    disks.push_back({vec_cast<float>(Vec3d{number(-90, 90), number(-90, 90), number(-5, 20)}),
                     static_cast<float>(number(0.02, 1)), vec_cast<float>(normal)});
  }
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.spz")
      << spz_of(disks, std::vector<ColorBytes>(disks.size(), {10, 100, 200}), {});
  const auto model = std::get<SplatModel>(load_any_model(folder.path() / "a.spz"));
  ASSERT_EQ(model.size(), disks.size());
  EXPECT_TRUE(model.opacities.empty());
  EXPECT_EQ(model.method, "Gaussians (SPZ, y up turned to z up)");
  const auto ours = [](Vec3f spz) { return Vec3d{-spz.z, -spz.x, spz.y}; };
  for (std::size_t i = 0; i < disks.size(); ++i) {
    const Disk& found = model.disks[i];
    EXPECT_LT(length(model.origin + vec_cast<double>(found.center) - ours(disks[i].center)), 3e-4);
    EXPECT_GT(std::fabs(dot(vec_cast<double>(found.normal), ours(disks[i].normal))), 1 - 1e-5);
    EXPECT_NEAR(static_cast<double>(found.radius / disks[i].radius), 1, 0.04);
    EXPECT_EQ(model.colors[i], (ColorBytes{10, 100, 200}));
  }
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
