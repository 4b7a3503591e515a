// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/tiled_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr std::size_t kColumns = 5, kRows = 4;
constexpr double kSide_m = 20;

/// Disks of a field of tiles, tile after tile. Some tiles are empty, one has a single disk, and
/// some disks occur twice: in neighbouring tiles, where the first must win.
struct Field {
  std::vector<Disk> disks;
  std::vector<std::size_t> counts;

  std::span<const Disk> tile(std::size_t k) const {
    std::size_t first = 0;
    for (std::size_t i = 0; i < k; ++i) first += counts[i];
    return std::span(disks).subspan(first, counts[k]);
  }
};

Field random_field() {
  Field field;
  for (std::size_t k = 0; k < kColumns * kRows; ++k) {
    const std::size_t count = k == 3 ? 0 : (k == 7 ? 1 : 400 + 50 * k);
    field.counts.push_back(count);
    for (std::size_t i = 0; i < count; ++i) {
      Random random(4, k, i);
      if (i % 20 == 19 && field.disks.size() > 600) {
        field.disks.push_back(field.disks[field.disks.size() - 600]);
        continue;
      }
      const double x = kSide_m * (static_cast<double>(k % kColumns) + random.uniform());
      const double y = kSide_m * (static_cast<double>(k / kColumns) + random.uniform());
      const Vec3d normal = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
      field.disks.push_back({vec_cast<float>(Vec3d{x, y, random.uniform(0, 8)}),
                             static_cast<float>(random.uniform(0.1, 1.5)),
                             vec_cast<float>(normal)});
    }
  }
  return field;
}

/// Revolutions of a sensor in the middle, and rays from everywhere.
std::vector<Ray> rays() {
  std::vector<Ray> rays;
  for (int i = 0; i < 4000; ++i) {
    const double turn = 0.004 * i;
    const Vec3d direction = {std::cos(turn), std::sin(turn), 0.1 * std::sin(0.01 * i)};
    rays.push_back({{45, 33, 3}, 0, vec_cast<float>(normalized(direction)), 100});
  }
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Random random(5, 0, i);
    const Vec3d from = {random.uniform(-10, 110), random.uniform(-10, 90), random.uniform(0, 9)};
    const Vec3d direction = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    rays.push_back({vec_cast<float>(from), 0.5F, vec_cast<float>(direction), 60});
  }
  return rays;
}

std::vector<Hit> hits_of(const Tracer& tracer, int depth) {
  const std::vector<Ray> all = rays();
  std::vector<Hit> hits(all.size() * static_cast<std::size_t>(depth));
  tracer.nearest_hits(all, depth, hits, Executor(2));
  return hits;
}

/// Hits of all disks, with those of hidden tiles moved out of reach.
std::vector<Hit> expected_hits(const Field& field, std::span<const std::size_t> shown, int depth) {
  std::vector<Disk> disks = field.disks;
  std::size_t first = 0;
  for (std::size_t k = 0; k < field.counts.size(); ++k) {
    if (std::ranges::find(shown, k) == shown.end())
      for (std::size_t i = 0; i < field.counts[k]; ++i) disks[first + i].center.z += 1e4F;
    first += field.counts[k];
  }
  return hits_of(*make_brute_force_tracer({disks, nullptr}), depth);
}

void expect_same(const std::vector<Hit>& got, const std::vector<Hit>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  EXPECT_EQ(std::memcmp(got.data(), expected.data(), got.size() * sizeof(Hit)), 0);
}

TEST(TiledTracer, HitsEqualThoseOfAllShownSplats) {
  const Field field = random_field();
  const Executor executor(2);
  const std::unique_ptr<TiledTracer> tracer = make_tiled_tracer(field.counts);
  std::size_t met = 0;
  for (const Hit& hit : hits_of(*tracer, 1)) met += hit.valid() ? 1 : 0;
  EXPECT_EQ(met, 0U);

  std::vector<std::size_t> all(field.counts.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (const std::size_t k : all) tracer->build(k, field.tile(k), executor);
  tracer->show(all);
  for (const int depth : {1, 3})
    expect_same(hits_of(*tracer, depth), expected_hits(field, all, depth));

  const std::vector<std::size_t> some = {12, 0, 7, 3, 13, 6};
  tracer->show(some);
  expect_same(hits_of(*tracer, 1), expected_hits(field, some, 1));
  const std::vector<std::size_t> one = {7};
  tracer->show(one);
  expect_same(hits_of(*tracer, 1), expected_hits(field, one, 1));
}

TEST(TiledTracer, TilesCanBeDroppedAndRebuilt) {
  const Field field = random_field();
  const Executor executor(2);
  const std::unique_ptr<TiledTracer> tracer = make_tiled_tracer(field.counts);
  for (std::size_t k = 0; k + 6 <= field.counts.size(); ++k) {
    std::vector<std::size_t> shown;
    for (std::size_t i = k; i < k + 6; ++i) shown.push_back(i);
    for (const std::size_t tile : shown)
      if (k == 0 || tile == k + 5) tracer->build(tile, field.tile(tile), executor);
    tracer->show(shown);
    expect_same(hits_of(*tracer, 1), expected_hits(field, shown, 1));
    tracer->show(std::span(shown).subspan(1));
    tracer->drop(k);
  }
}

TEST(TiledTracer, TilesAreBuiltWhileOthersAreCast) {
  const Field field = random_field();
  const std::unique_ptr<TiledTracer> tracer = make_tiled_tracer(field.counts);
  const std::vector<std::size_t> first = {6, 7, 8, 11, 12, 13};
  for (const std::size_t k : first) tracer->build(k, field.tile(k), Executor(2));
  tracer->show(first);
  const std::vector<Hit> expected = expected_hits(field, first, 1);
  std::thread builder([&] {
    const Executor own(1);
    for (const std::size_t k : {0, 1, 2, 3, 4, 5, 9, 10, 14, 15, 16, 17, 18, 19})
      tracer->build(k, field.tile(k), own);
  });
  for (int i = 0; i < 5; ++i) expect_same(hits_of(*tracer, 1), expected);
  builder.join();
  std::vector<std::size_t> all(field.counts.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  tracer->show(all);
  expect_same(hits_of(*tracer, 1), expected_hits(field, all, 1));
}

TEST(TiledTracer, MisuseThrowsLogicError) {
  const Field field = random_field();
  const Executor executor(1);
  const std::unique_ptr<TiledTracer> tracer = make_tiled_tracer(field.counts);
  EXPECT_THROW(tracer->build(0, field.tile(1), executor), std::logic_error);
  const std::vector<std::size_t> one = {0};
  EXPECT_THROW(tracer->show(one), std::logic_error);
  tracer->build(0, field.tile(0), executor);
  EXPECT_THROW(tracer->build(0, field.tile(0), executor), std::logic_error);
  const std::vector<std::size_t> too_many = {std::size_t{1} << 29U, std::size_t{1} << 29U};
  EXPECT_THROW(make_tiled_tracer(too_many), Error);
}

}  // namespace
}  // namespace adasplats
