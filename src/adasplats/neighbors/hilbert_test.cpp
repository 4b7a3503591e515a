// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/neighbors/hilbert.h"

#include <gtest/gtest.h>

#include <limits>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

TEST(HilbertKey, TurnsEqualTheTable) {
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    Random random(17, 0, i);
    const auto cell = [&] { return static_cast<std::uint32_t>(random.next_bits() & 0x1fffff); };
    const std::uint32_t x = cell(), y = cell(), z = cell();
    ASSERT_EQ(hilbert_key_by_turns(x, y, z), hilbert_key(x, y, z));
  }
}

TEST(HilbertKey, OfConsecutiveCellsAreNeighbors) {
  // Oracle: the definition of the curve. Every cell of the 8 x 8 x 8 in the corner where it begins
  // has a place among the first 512, and consecutive ones share a face.
  std::vector<Vec3<int>> cells(512, {-1, -1, -1});
  for (int i = 0; i < 512; ++i) {
    const int x = i >> 6, y = i >> 3 & 7, z = i & 7;
    const std::uint64_t key = hilbert_key_by_turns(x, y, z);
    ASSERT_LT(key, 512U);
    cells[key] = {x, y, z};
  }
  for (std::size_t k = 1; k < cells.size(); ++k) {
    ASSERT_GE(cells[k].x, 0);
    const Vec3<int> step = cells[k] - cells[k - 1];
    EXPECT_EQ(dot(step, step), 1) << k;
  }
}

// A box is kept when points are added outside it: near points stay near along the curve there, too.
TEST(HilbertGrid, RepeatsBeyondItsCube) {
  const HilbertGrid grid({0, 0, 0}, {16, 8, 4});
  const float period_m = 16.0F * (1U << kHilbertBits) / HilbertGrid::kCells;
  const Vec3f p = {3.3F, 7.9F, 15.1F};
  const Vec3<std::uint32_t> cell = grid.cell(p);
  for (const int cubes : {-3, -1, 1, 2}) {
    const float shift = static_cast<float>(cubes) * period_m;
    const Vec3<std::uint32_t> moved = grid.cell(p + Vec3f{shift, shift, shift});
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(static_cast<double>(moved[axis]), static_cast<double>(cell[axis]), 16) << cubes;
  }
  EXPECT_LT(grid.cell({-1e6F, 1e6F, 0}).x, 1U << kHilbertBits);
  EXPECT_LT(grid.cell({-1e-9F, 0, 0}).x, 1U << kHilbertBits);
  EXPECT_EQ(grid.cell({16, 0, 0}).x, (1U << kHilbertBits) - 1);
}

TEST(HilbertGrid, CoversTheCubeOverTheLongestSide) {
  const HilbertGrid grid({-2, 0, 1}, {2, 1, 2});
  constexpr std::uint32_t kLast = (1U << kHilbertBits) - 1;
  EXPECT_EQ(grid.cell({-2, 0, 1}), (Vec3<std::uint32_t>{0, 0, 0}));
  EXPECT_EQ(grid.cell({2, 0, 1}).x, kLast);
  EXPECT_NEAR(grid.cell({-2, 1, 1}).y, kLast / 4.0, 1);
  // A single point, and a box so large that its side is no float.
  EXPECT_EQ(HilbertGrid({1, 1, 1}, {1, 1, 1}).cell({1, 1, 1}), (Vec3<std::uint32_t>{0, 0, 0}));
  constexpr float kHuge = std::numeric_limits<float>::max();
  EXPECT_EQ(HilbertGrid({-kHuge, 0, 0}, {kHuge, 1, 1}).cell({-kHuge, 0, 0}).x, 0U);
}

}  // namespace
}  // namespace adasplats
