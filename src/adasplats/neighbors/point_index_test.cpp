// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/neighbors/point_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "adasplats/core/maths/random.h"
#include "adasplats/neighbors/group_search.h"

namespace adasplats {
namespace {

std::vector<Vec3f> random_points(std::size_t n, std::uint64_t seed, float side = 10.0F) {
  std::vector<Vec3f> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    Random random(seed, 0, i);
    points[i] = {side * static_cast<float>(random.uniform()),
                 side * static_cast<float>(random.uniform()),
                 // two layers, so that runs of the curve are flat as real surfaces are
                 i % 2 == 0 ? 0.0F : side * 0.1F * static_cast<float>(random.uniform())};
  }
  return points;
}

std::uint64_t key(Vec3f a, Vec3f b, std::uint32_t rank) {
  const Vec3f d = a - b;
  const float d2 = (d.x * d.x + d.y * d.y) + d.z * d.z;
  return std::uint64_t{std::bit_cast<std::uint32_t>(d2)} << 32 | rank;
}

/// The oracle: all keys within the radius, sorted, the first `count`.
std::vector<std::uint64_t> brute_force(const std::vector<Vec3f>& sorted, std::uint32_t rank,
                                       NeighborLimit limit) {
  std::vector<std::uint64_t> keys;
  for (std::uint32_t j = 0; j < sorted.size(); ++j) {
    const std::uint64_t k = key(sorted[j], sorted[rank], j);
    if (std::bit_cast<float>(static_cast<std::uint32_t>(k >> 32)) <= limit.squared_radius)
      keys.push_back(k);
  }
  std::sort(keys.begin(), keys.end());
  if (keys.size() > limit.count) keys.resize(limit.count);
  return keys;
}

std::vector<Vec3f> sorted_by_curve(const std::vector<Vec3f>& points, const Executor& executor) {
  std::vector<Vec3f> sorted;
  for (const std::uint32_t i : hilbert_order(points, executor)) sorted.push_back(points[i]);
  return sorted;
}

void expect_equal_to_brute_force(const std::vector<Vec3f>& points, NeighborLimit limit,
                                 int threads) {
  const Executor executor(threads);
  const std::vector<Vec3f> sorted = sorted_by_curve(points, executor);
  const PointIndex index = PointIndex::from_sorted(sorted, executor);
  std::vector<std::vector<std::uint64_t>> found(points.size());
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return limit; },
      [&](std::uint32_t rank, const NeighborList& neighbors) {
        for (std::uint32_t k = 0; k < neighbors.size; ++k) found[rank].push_back(neighbors.key(k));
      });
  for (std::uint32_t rank = 0; rank < points.size(); ++rank) {
    std::sort(found[rank].begin(), found[rank].end());
    ASSERT_EQ(found[rank], brute_force(sorted, rank, limit)) << "rank " << rank;
  }
}

TEST(PointIndex, NeighborhoodsEqualBruteForce) {
  for (const std::size_t n : {1, 2, 15, 16, 17, 39, 40, 41, 127, 129, 3000})
    for (const std::uint32_t k : {1, 10, 40, 120})
      expect_equal_to_brute_force(random_points(n, n), {k}, 2);
}

TEST(PointIndex, RadiusLimitsNeighborhoods) {
  for (const float radius : {0.0F, 0.1F, 1.0F})
    expect_equal_to_brute_force(random_points(2000, 5), {40, radius * radius}, 2);
}

TEST(PointIndex, EqualPointsAreOrderedByRank) {
  expect_equal_to_brute_force(std::vector<Vec3f>(500, {1, 2, 3}), {40}, 3);
}

TEST(PointIndex, CollinearAndFarPoints) {
  std::vector<Vec3f> points;
  for (int i = 0; i < 300; ++i) points.push_back({static_cast<float>(i) * 0.01F, 0, 0});
  points.push_back({9e4F, -9e4F, 9e4F});
  expect_equal_to_brute_force(points, {40}, 1);
}

TEST(PointIndex, MillionEqualPointsFinish) {
  const Executor executor(2);
  const std::vector<Vec3f> points(1'000'000, {1, 1, 1});
  const PointIndex index(points, executor);
  std::vector<std::uint32_t> counts(points.size());
  index.for_each_neighborhood(
      executor, [](std::uint32_t) { return NeighborLimit{40}; },
      [&](std::uint32_t rank, const NeighborList& neighbors) { counts[rank] = neighbors.size; });
  EXPECT_TRUE(std::all_of(counts.begin(), counts.end(), [](auto c) { return c == 40; }));
}

TEST(PointIndex, PortableAndVectorSearchAgree) {
#if defined(__x86_64__)
  if (detail::search_functions().nearest == detail::portable_search().nearest)
    GTEST_SKIP() << "this CPU has no AVX2: there is one search only";
  const Executor executor(1);
  const std::vector<Vec3f> sorted = sorted_by_curve(random_points(5000, 9), executor);
  const PointIndex index = PointIndex::from_sorted(sorted, executor);
  std::vector<NeighborLimit> limits(detail::QueryGroup::kSize, {40});
  for (std::uint32_t first = 0; first + 16 <= sorted.size(); first += 16) {
    detail::QueryGroup groups[2];
    for (detail::QueryGroup& group : groups) {
      group.size = 16;
      for (std::uint32_t q = 0; q < 16; ++q) {
        group.x[q] = sorted[first + q].x;
        group.y[q] = sorted[first + q].y;
        group.z[q] = sorted[first + q].z;
      }
      detail::prepare(group, limits);
    }
    detail::portable_search().neighbors(index.tree(), first / 16, groups[0]);
    detail::avx2_search().neighbors(index.tree(), first / 16, groups[1]);
    for (std::uint32_t q = 0; q < 16; ++q) {
      ASSERT_EQ(groups[0].found[q], groups[1].found[q]);
      ASSERT_TRUE(std::equal(groups[0].ranks_of(q), groups[0].ranks_of(q) + groups[0].found[q],
                             groups[1].ranks_of(q)));
    }
  }
#else
  GTEST_SKIP() << "only x86-64 has a second search";
#endif
}

/// The oracle: the nearest by (squared distance, rank), for points that are in the curve's order.
Neighbor nearest_by_brute_force(const std::vector<Vec3f>& sorted, Vec3f query) {
  Neighbor best;
  for (std::uint32_t i = 0; i < sorted.size(); ++i) {
    const Vec3f d = sorted[i] - query;
    const float distance2 = (d.x * d.x + d.y * d.y) + d.z * d.z;
    if (distance2 < best.squared_distance) best = {distance2, i};
  }
  return best;
}

void expect_nearest(const std::vector<Vec3f>& points, const std::vector<Vec3f>& queries) {
  const Executor executor(2);
  const std::vector<Vec3f> sorted = sorted_by_curve(points, executor);
  const PointIndex index = PointIndex::from_sorted(sorted, executor);
  const std::vector<Neighbor> found = index.nearest(queries, executor);
  const std::vector<Neighbor> of_index =
      index.nearest(PointIndex::from_sorted(queries, executor), executor);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Neighbor expected = nearest_by_brute_force(sorted, queries[i]);
    ASSERT_EQ(found[i].squared_distance, expected.squared_distance) << "query " << i;
    ASSERT_EQ(found[i].index, expected.index) << "query " << i;
    ASSERT_EQ(of_index[i].squared_distance, expected.squared_distance) << "query " << i;
    ASSERT_EQ(of_index[i].index, expected.index) << "query " << i;
  }
}

TEST(PointIndex, NearestEqualsBruteForce) {
  for (const std::size_t n : {1, 2, 15, 16, 17, 129, 2000})
    for (const std::size_t queries : {1, 16, 17, 777})
      expect_nearest(random_points(n, n), random_points(queries, 2, 14.0F));
}

TEST(PointIndex, EquallyNearPointsAreChosenByRank) {
  expect_nearest(std::vector<Vec3f>(700, {1, 2, 3}), random_points(100, 4));
  std::vector<Vec3f> lattice;  // whole numbers: distances from the middles of cells are equal
  for (int i = 0; i < 1000; ++i)
    lattice.push_back(
        {static_cast<float>(i / 100), static_cast<float>(i / 10 % 10), static_cast<float>(i % 10)});
  std::vector<Vec3f> middles;
  for (const Vec3f p : lattice) middles.push_back(p + Vec3f{0.5F, 0.5F, 0.5F});
  expect_nearest(lattice, middles);
}

TEST(PointIndex, QueriesWithoutAFiniteDistanceFindNoPoint) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Executor executor(1);
  const PointIndex index(random_points(100, 1), executor);
  std::vector<Vec3f> queries = random_points(20, 2);
  queries[3].y = nan;
  queries[17].x = 1e30F;  // its square is no float
  const std::vector<Neighbor> found =
      index.nearest(PointIndex::from_sorted(queries, executor), executor);
  for (std::size_t i = 0; i < queries.size(); ++i)
    EXPECT_EQ(found[i].index == Neighbor::kNone, i == 3 || i == 17) << "query " << i;
}

TEST(PointIndex, MillionEqualPointsFindTheirNearest) {
  const Executor executor(2);
  const PointIndex index(std::vector<Vec3f>(1'000'000, {1, 1, 1}), executor);
  const std::vector<Neighbor> found = index.nearest(index, executor);
  EXPECT_TRUE(std::all_of(found.begin(), found.end(), [](Neighbor n) { return n.index == 0; }));
}

TEST(PointIndex, PortableAndVectorNearestAgree) {
#if defined(__x86_64__)
  if (detail::search_functions().nearest == detail::portable_search().nearest)
    GTEST_SKIP() << "this CPU has no AVX2: there is one search only";
  const Executor executor(1);
  const PointIndex index(random_points(5000, 9), executor);
  const std::vector<Vec3f> queries = random_points(16 * 100, 10, 12.0F);
  for (std::uint32_t first = 0; first < queries.size(); first += 16) {
    detail::Queries groups[2];
    for (detail::Queries& group : groups) {
      group.size = 1 + first / 16 % 16;
      for (std::uint32_t q = 0; q < group.size; ++q) {
        group.x[q] = queries[first + q].x;
        group.y[q] = queries[first + q].y;
        group.z[q] = queries[first + q].z;
      }
      detail::prepare(group);
    }
    detail::portable_search().nearest(index.tree(), 0, groups[0]);
    detail::avx2_search().nearest(index.tree(), 100, groups[1]);
    for (std::uint32_t q = 0; q < groups[0].size; ++q) {
      ASSERT_EQ(groups[0].bound[q], groups[1].bound[q]);
      ASSERT_EQ(groups[0].last_rank[q], groups[1].last_rank[q]);
    }
  }
#else
  GTEST_SKIP() << "only x86-64 has a second search";
#endif
}

TEST(PointIndex, EmptyIndexFindsNoPoint) {
  const Executor executor(1);
  const PointIndex index(std::vector<Vec3f>{}, executor);
  const std::vector<Neighbor> found = index.nearest(random_points(3, 1), executor);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].index, Neighbor::kNone);
  EXPECT_TRUE(PointIndex(random_points(3, 1), executor).nearest({}, executor).empty());
}

TEST(PointIndex, CountWithinEqualsBruteForce) {
  const Executor executor(2);
  const std::vector<Vec3f> sorted = sorted_by_curve(random_points(1500, 3), executor);
  const PointIndex index = PointIndex::from_sorted(sorted, executor);
  const std::vector<std::uint32_t> counts = index.count_within(0.7F, executor);
  for (std::uint32_t i = 0; i < sorted.size(); ++i)
    ASSERT_EQ(counts[i], brute_force(sorted, i, {1'000'000, 0.7F * 0.7F}).size());
}

/// The oracle: Skilling's algorithm as he gives it, all bits of an axis at once.
std::uint64_t skilling_key(std::array<std::uint32_t, 3> axes) {
  constexpr int kBits = 21;
  constexpr std::uint32_t kTop = 1U << (kBits - 1);
  for (std::uint32_t bit = kTop; bit > 1; bit >>= 1) {
    for (std::uint32_t& axis : axes) {
      if ((axis & bit) != 0) {
        axes[0] ^= bit - 1;
      } else {
        const std::uint32_t swapped = (axes[0] ^ axis) & (bit - 1);
        axes[0] ^= swapped;
        axis ^= swapped;
      }
    }
  }
  axes[1] ^= axes[0];
  axes[2] ^= axes[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = kTop; bit > 1; bit >>= 1)
    if ((axes[2] & bit) != 0) flip ^= bit - 1;
  std::uint64_t key = 0;
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (const std::uint32_t axis : axes) key = key << 1 | ((axis ^ flip) >> bit & 1U);
  return key;
}

TEST(HilbertOrder, KeysEqualSkillings) {
  constexpr std::uint32_t kLast = (1U << 21) - 1;
  EXPECT_EQ(hilbert_key(kLast, kLast, kLast), skilling_key({kLast, kLast, kLast}));
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    Random random(1, 2, i);
    const auto cell = [&] { return static_cast<std::uint32_t>(random.next_bits() & kLast); };
    const std::uint32_t x = cell(), y = cell(), z = cell();
    ASSERT_EQ(hilbert_key(x, y, z), skilling_key({x, y, z}));
  }
}

TEST(HilbertOrder, NeighboringCellsOfTheCurveTouch) {
  // Walk a whole 8x8x8 corner: keys are a permutation, and consecutive cells differ in one axis
  // by one, which is what makes it a Hilbert curve (Morton order fails this).
  std::vector<std::pair<std::uint64_t, std::array<int, 3>>> cells;
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z)
        cells.push_back({hilbert_key(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                     static_cast<std::uint32_t>(z)),
                         {x, y, z}});
  std::sort(cells.begin(), cells.end());
  for (std::size_t i = 1; i < cells.size(); ++i) {
    ASSERT_NE(cells[i].first, cells[i - 1].first);
    int steps = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      steps += std::abs(cells[i].second[axis] - cells[i - 1].second[axis]);
    ASSERT_EQ(steps, 1) << "at " << i;
  }
}

TEST(HilbertOrder, DoesNotDependOnInputOrderOrThreads) {
  const std::vector<Vec3f> points = random_points(4000, 4);
  std::vector<Vec3f> reversed(points.rbegin(), points.rend());
  EXPECT_TRUE(sorted_by_curve(points, Executor(1)) == sorted_by_curve(reversed, Executor(3)));
}

}  // namespace
}  // namespace adasplats
