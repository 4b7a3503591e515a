// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/pyramid/pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

std::vector<Vec3f> random_points(std::size_t count, float size_m) {
  std::vector<Vec3f> points;
  Random random(5, 0, 0);
  const auto coordinate = [&] { return size_m * (static_cast<float>(random.uniform()) - 0.5F); };
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({coordinate(), coordinate(), 0.2F * coordinate()});
  return points;
}

TEST(Pyramid, CellsHaveTheMeansOfTheirPoints) {
  const std::vector<Vec3f> points = random_points(5000, 4);
  const CellMeans cells = means_by_cell(points, 0.5F, Executor(2));
  std::map<std::tuple<int, int, int>, std::pair<Vec3d, int>> expected;  // sorted by x, y, z
  const auto cell = [](float value) { return static_cast<int>(std::floor(value / 0.5F)); };
  for (const Vec3f p : points) {
    auto& [sum, count] = expected[{cell(p.x), cell(p.y), cell(p.z)}];
    sum = sum + vec_cast<double>(p);
    ++count;
  }
  ASSERT_EQ(cells.means.size(), expected.size());
  std::size_t k = 0;
  for (const auto& [place, own] : expected) {
    const Vec3d mean = own.first / static_cast<double>(own.second);
    EXPECT_LT(length(vec_cast<double>(cells.means[k]) - mean), 1e-6);
    ++k;
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(cell(points[i].x), cell(cells.means[cells.cell_of[i]].x));
}

TEST(Pyramid, NeighborsAreTheNearestWithinTheRadius) {
  const std::vector<Vec3f> supports = random_points(3000, 4), queries = random_points(200, 6);
  constexpr std::uint32_t kSlots = 20;
  const NeighborTable table = find_neighbors(queries, supports, 0.3F, kSlots, Executor(2));
  ASSERT_EQ(table.size(), queries.size());
  std::size_t full = 0, empty = 0;
  for (std::size_t q = 0; q < queries.size(); ++q) {
    std::vector<std::pair<float, std::uint32_t>> near;
    for (std::uint32_t i = 0; i < supports.size(); ++i) {
      const Vec3f way = supports[i] - queries[q];
      if (dot(way, way) < 0.3F * 0.3F) near.emplace_back(dot(way, way), i);
    }
    std::ranges::sort(near);
    full += near.size() > kSlots ? 1U : 0U;
    empty += near.empty() ? 1U : 0U;
    for (std::size_t k = 0; k < kSlots; ++k)
      EXPECT_EQ(table.of(q)[k], k < near.size() ? near[k].second : NeighborTable::kNone);
  }
  EXPECT_GT(full, 0U);
  EXPECT_GT(empty, 0U);
  EXPECT_EQ(find_neighbors(queries, supports, 0.3F, kSlots, Executor(1)).indices, table.indices);
}

TEST(Pyramid, EveryPointHasACoarserOneUpToTheTop) {
  const Executor executor(2);
  PyramidShape shape;
  shape.levels = 4;
  const std::vector<PyramidLevel> levels = make_pyramid(
      means_by_cell(random_points(4000, 5), shape.cell_m, executor).means, shape, executor);
  ASSERT_EQ(levels.size(), 4U);
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    EXPECT_LT(levels[k + 1].points.size(), levels[k].points.size());
    EXPECT_EQ(levels[k + 1].cell_m, 2 * levels[k].cell_m);
    ASSERT_EQ(levels[k].coarser.size(), levels[k].points.size());
    for (std::size_t i = 0; i < levels[k].points.size(); ++i) {
      EXPECT_EQ(levels[k].neighbors.of(i)[0], i);  // itself first
      ASSERT_LT(levels[k].coarser[i], levels[k + 1].points.size());
    }
    EXPECT_EQ(levels[k].pooled.size(), levels[k + 1].points.size());
  }
  EXPECT_TRUE(levels.back().coarser.empty());
}

TEST(Pyramid, NoPointsAndOnePoint) {
  const Executor executor(1);
  EXPECT_TRUE(means_by_cell({}, 1, executor).means.empty());
  const std::vector<PyramidLevel> empty = make_pyramid({}, {}, executor);
  EXPECT_TRUE(empty.front().points.empty());
  const std::vector<PyramidLevel> one = make_pyramid({{1, 2, 3}}, {}, executor);
  EXPECT_EQ(one.back().points.size(), 1U);
  EXPECT_EQ(one.front().coarser, std::vector<std::uint32_t>{0});
}

}  // namespace
}  // namespace adasplats
