// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/fused_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "adasplats/core/maths/random.h"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats {
namespace {

using CellKey = std::array<double, 3>;

CellKey key_of(Vec3f p, double cell_m) {
  CellKey key;
  for (int axis = 0; axis < 3; ++axis)
    key[static_cast<std::size_t>(axis)] = std::floor(static_cast<double>(p[axis]) / cell_m);
  return key;
}

/// Oracle: a map from cells to points, filled one by one; a mean of each.
void expect_equals_grid(const std::vector<Vec3f>& points, double cell_m, const FusedPoints& fused) {
  std::map<CellKey, std::vector<std::uint32_t>> grid;
  for (std::uint32_t i = 0; i < points.size(); ++i) grid[key_of(points[i], cell_m)].push_back(i);
  ASSERT_EQ(fused.size(), grid.size());
  ASSERT_EQ(fused.begins.size(), grid.size() + 1);
  EXPECT_EQ(fused.begins.front(), 0U);
  EXPECT_EQ(fused.begins.back(), points.size());
  ASSERT_EQ(fused.members.size(), points.size());
  for (std::size_t cell = 0; cell < fused.size(); ++cell) {
    const auto members = fused.points_of(cell);
    ASSERT_FALSE(members.empty());
    EXPECT_EQ(fused.count(cell), static_cast<float>(members.size()));
    const auto& expected = grid.at(key_of(points[members[0]], cell_m));
    ASSERT_TRUE(std::equal(members.begin(), members.end(), expected.begin(), expected.end()));
    for (int axis = 0; axis < 3; ++axis) {
      double mean = 0, largest = 0;
      for (const std::uint32_t i : expected) {
        const auto value = static_cast<double>(points[i][axis]);
        mean += value / static_cast<double>(expected.size());
        largest = std::max(largest, std::fabs(value));
      }
      EXPECT_NEAR(static_cast<double>(fused.positions[cell][axis]), mean, 1e-7 * largest);
    }
  }
  std::vector<std::uint32_t> in_order(fused.size());
  std::iota(in_order.begin(), in_order.end(), 0U);
  EXPECT_EQ(hilbert_order(fused.positions, curve_box_of(points, Executor(1)), Executor(1)),
            in_order);
}

std::vector<Vec3f> random_points(std::size_t n, double low_m, double high_m) {
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i < n; ++i) {
    Random random(3, 0, i);
    const double x = random.uniform(low_m, high_m), y = random.uniform(low_m, high_m);
    points.push_back(vec_cast<float>(Vec3d{x, y, random.uniform(low_m, high_m)}));
  }
  return points;
}

TEST(FusePoints, EqualsAGridByBruteForce) {
  const Executor executor(2);
  const auto check = [&](const std::vector<Vec3f>& points, double cell_m) {
    expect_equals_grid(points, cell_m, fuse_points(points, cell_m, executor));
  };
  check({}, 0.05);
  check({{1, -2, 3}}, 0.05);
  check({{0.01F, 0.01F, 0.01F}, {-0.01F, 0.01F, 0.01F}}, 0.05);  // either side of zero: two cells
  check(std::vector<Vec3f>(1000, {1.1F, -2.2F, 3.3F}), 0.05);
  check(random_points(20000, -0.5, 0.5), 0.05);     // some 2.5 points a cell
  check(random_points(3000, -9e4, -8.9e4), 100);    // negative and far, cells of many points
  check(random_points(3000, -52000, 52000), 0.05);  // nearly 2^20 cells from zero: one point a cell
}

TEST(FusePoints, PointsBeyondTheGridShareItsOutermostCells) {
  const std::vector<Vec3f> points = {{1e30F, 0, 0}, {0, 0, 0},         {3e38F, 0, 0},
                                     {3e38F, 0, 0}, {-1e30F, 0, 0},    {0.01F, 0.01F, 0.01F},
                                     {0, 1e30F, 0}, {1e30F, 1e30F, 0}, {0, 0, -3e38F}};
  const FusedPoints fused = fuse_points(points, 0.05, Executor(1));
  std::vector<std::vector<std::uint32_t>> cells;
  for (std::size_t cell = 0; cell < fused.size(); ++cell) {
    EXPECT_TRUE(is_finite(fused.positions[cell]));
    const auto members = fused.points_of(cell);
    cells.emplace_back(members.begin(), members.end());
  }
  std::sort(cells.begin(), cells.end());
  EXPECT_EQ(cells,
            (std::vector<std::vector<std::uint32_t>>{{0, 2, 3}, {1, 5}, {4}, {6}, {7}, {8}}));
}

TEST(FusePoints, SameForEveryNumberOfThreads) {
  const std::vector<Vec3f> points = random_points(150000, -2, 2);
  const FusedPoints one = fuse_points(points, 0.1, Executor(1));
  // 2.34 points a cell on average leave exp(-2.34) of the 64000 cells empty.
  EXPECT_NEAR(static_cast<double>(one.size()), 64000 * (1 - std::exp(-150.0 / 64)), 300);
  for (const int threads : {2, 3}) {
    const FusedPoints other = fuse_points(points, 0.1, Executor(threads));
    EXPECT_EQ(one.positions, other.positions);
    EXPECT_EQ(one.begins, other.begins);
    EXPECT_EQ(one.members, other.members);
  }
}

TEST(FusePoints, OrderOfPointsOnlyChangesTheRoundingOfMeans) {
  // Sums of doubles that hold floats: the rounded means of both orders agree to a float's ulp.
  const std::vector<Vec3f> points = random_points(5000, -0.5, 0.5);
  const std::vector<Vec3f> reversed(points.rbegin(), points.rend());
  const FusedPoints a = fuse_points(points, 0.1, Executor(1));
  const FusedPoints b = fuse_points(reversed, 0.1, Executor(1));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t cell = 0; cell < a.size(); ++cell) {
    EXPECT_LT(length(a.positions[cell] - b.positions[cell]), 1e-6F);
    EXPECT_EQ(a.count(cell), b.count(cell));
  }
}

void expect_same(const FusedPoints& a, const FusedPoints& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.begins, b.begins);
  EXPECT_EQ(a.members, b.members);
}

/// Flags nearly every third cell.
std::vector<std::uint8_t> some_flags(std::size_t cells) {
  std::vector<std::uint8_t> split(cells);
  for (std::size_t cell = 0; cell < cells; ++cell)
    split[cell] = Random(4, 0, cell).uniform() < 0.3 ? 1 : 0;
  return split;
}

TEST(SplitCells, WithNoFlagAllCellsStay) {
  for (const std::size_t n : {0, 1, 5000}) {
    const std::vector<Vec3f> points = random_points(n, -0.5, 0.5);
    const FusedPoints fused = fuse_points(points, 0.1, Executor(1));
    const std::vector<std::uint8_t> none(fused.size(), 0);
    expect_same(split_cells(points, fused, none, 0.03, Executor(2)), fused);
  }
}

TEST(SplitCells, WithAllFlagsPointsAreFusedInTheSmallCells) {
  for (const std::size_t n : {0, 1, 5000}) {
    const std::vector<Vec3f> points = random_points(n, -0.5, 0.5);
    const FusedPoints fused = fuse_points(points, 0.1, Executor(1));
    const std::vector<std::uint8_t> all(fused.size(), 1);
    const FusedPoints small = split_cells(points, fused, all, 0.03, Executor(2));
    expect_same(small, fuse_points(points, 0.03, Executor(1)));
    expect_equals_grid(points, 0.03, small);
  }
}

/// Oracle: a map from (small or not, cell) to points, filled one by one.
TEST(SplitCells, WithSomeFlagsEqualsTwoGridsByBruteForce) {
  const std::vector<Vec3f> points = random_points(8000, -0.5, 0.5);
  const FusedPoints fused = fuse_points(points, 0.1, Executor(2));
  const std::vector<std::uint8_t> split = some_flags(fused.size());
  std::vector<bool> is_loose(points.size());
  for (std::size_t cell = 0; cell < fused.size(); ++cell)
    for (const std::uint32_t i : fused.points_of(cell)) is_loose[i] = split[cell] != 0;
  // Small cells of 0.03 m reach over the borders of large ones: points of two split cells may meet.
  std::map<std::pair<bool, CellKey>, std::vector<std::uint32_t>> grids;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    grids[{is_loose[i], key_of(points[i], is_loose[i] ? 0.03 : 0.1)}].push_back(i);

  const FusedPoints mixed = split_cells(points, fused, split, 0.03, Executor(2));
  ASSERT_EQ(mixed.size(), grids.size());
  ASSERT_EQ(mixed.begins.size(), grids.size() + 1);
  EXPECT_GT(mixed.size(), fused.size() + 500);
  std::vector<int> times(points.size());
  for (std::size_t cell = 0; cell < mixed.size(); ++cell) {
    const auto members = mixed.points_of(cell);
    ASSERT_FALSE(members.empty());
    EXPECT_TRUE(std::is_sorted(members.begin(), members.end()));
    const bool loose = is_loose[members[0]];
    const auto& expected = grids.at({loose, key_of(points[members[0]], loose ? 0.03 : 0.1)});
    ASSERT_TRUE(std::equal(members.begin(), members.end(), expected.begin(), expected.end()));
    Vec3d mean;
    for (const std::uint32_t i : members) {
      mean = mean + vec_cast<double>(points[i]) / static_cast<double>(members.size());
      ++times[i];
    }
    EXPECT_LT(length(vec_cast<double>(mixed.positions[cell]) - mean), 1e-7);
  }
  EXPECT_EQ(times, std::vector<int>(points.size(), 1));
  std::vector<std::uint32_t> in_order(mixed.size());
  std::iota(in_order.begin(), in_order.end(), 0U);
  EXPECT_EQ(hilbert_order(mixed.positions, curve_box_of(points, Executor(1)), Executor(1)),
            in_order);
}

TEST(SplitCells, SplitCellsCanBeSplitAgain) {
  // A cell of four corners: two and two along x, then one and one along y.
  const std::vector<Vec3f> points = {
      {0.1F, 0.1F, 0.1F}, {0.9F, 0.1F, 0.1F}, {0.1F, 0.4F, 0.1F}, {0.9F, 0.4F, 0.1F}};
  const Executor executor(1);
  const FusedPoints one = fuse_points(points, 1, executor);
  ASSERT_EQ(one.size(), 1U);
  const FusedPoints two = split_cells(points, one, std::vector<std::uint8_t>{1}, 0.5, executor);
  ASSERT_EQ(two.size(), 2U);
  const std::size_t left = two.positions[0].x < 0.5F ? 0 : 1;
  EXPECT_EQ(two.points_of(left)[0], 0U);
  EXPECT_EQ(two.points_of(left)[1], 2U);
  EXPECT_LT(length(two.positions[left] - Vec3f{0.1F, 0.25F, 0.1F}), 1e-6F);
  const FusedPoints three =
      split_cells(points, two, std::vector<std::uint8_t>{left == 0, left == 1}, 0.25, executor);
  std::vector<std::vector<std::uint32_t>> cells;
  for (std::size_t cell = 0; cell < three.size(); ++cell) {
    const auto members = three.points_of(cell);
    cells.emplace_back(members.begin(), members.end());
  }
  std::sort(cells.begin(), cells.end());
  EXPECT_EQ(cells, (std::vector<std::vector<std::uint32_t>>{{0}, {1, 3}, {2}}));
}

TEST(SplitCells, SameForEveryNumberOfThreads) {
  const std::vector<Vec3f> points = random_points(150000, -2, 2);
  const FusedPoints fused = fuse_points(points, 0.1, Executor(1));
  const std::vector<std::uint8_t> split = some_flags(fused.size());
  const FusedPoints one = split_cells(points, fused, split, 0.02, Executor(1));
  EXPECT_GT(one.size(), fused.size() + 20000);
  for (const int threads : {2, 3})
    expect_same(split_cells(points, fused, split, 0.02, Executor(threads)), one);
}

}  // namespace
}  // namespace adasplats
