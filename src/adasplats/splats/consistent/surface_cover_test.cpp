// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/surface_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace adasplats {
namespace {

constexpr float kStep_m = 0.05F;
constexpr float kSeed_m = 0.06F;

/// The tests' own numbers: the defaults may be tuned.
CoverOptions tested_cover() {
  CoverOptions options;
  options.neighbors = 160;
  options.tolerance_m = 0.015;
  options.min_normal_cosine = 0.9;
  options.edge_m = 0.25;
  options.largest_radius_m = 0.5;
  options.overlap = 0.8;
  options.covered_within_m = 0.04;
  return options;
}

/// A lattice of n x n seeds: corner + x * u + y * v.
void add_patch(std::vector<Disk>& seeds, int n, Vec3f corner, Vec3f u, Vec3f v) {
  const Vec3f normal = cross(u, v);
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const Vec3f p =
          corner + (kStep_m * static_cast<float>(x)) * u + (kStep_m * static_cast<float>(y)) * v;
      // Seeds' normals have no sign.
      seeds.push_back({p, kSeed_m, (x + y) % 3 == 0 ? -normal : normal});
    }
  }
}

/// Seeds in the order of the curve, under an index of their centers.
struct Seeds {
  std::vector<Disk> disks;
  PointIndex index;

  Seeds(const std::vector<Disk>& unordered, const Executor& executor)
      : disks(in_order(unordered, executor)),
        index(PointIndex::from_sorted(centers(disks), executor)) {}

  static std::vector<Vec3f> centers(const std::vector<Disk>& disks) {
    std::vector<Vec3f> points;
    for (const Disk& disk : disks) points.push_back(disk.center);
    return points;
  }
  static std::vector<Disk> in_order(const std::vector<Disk>& disks, const Executor& executor) {
    std::vector<Disk> sorted;
    for (const std::uint32_t i : hilbert_order(centers(disks), executor))
      sorted.push_back(disks[i]);
    return sorted;
  }
};

std::size_t count_chosen(const std::vector<Disk>& chosen) {
  return static_cast<std::size_t>(
      std::count_if(chosen.begin(), chosen.end(), [](const Disk& d) { return d.radius > 0; }));
}

/// Oracle: every seed with every chosen disk.
bool is_covered(const Disk& seed, const std::vector<Disk>& chosen, const CoverOptions& options) {
  return std::any_of(chosen.begin(), chosen.end(), [&](const Disk& disk) {
    if (!(disk.radius > 0)) return false;
    const Vec3f offset = seed.center - disk.center;
    const double height_m = std::fabs(static_cast<double>(dot(offset, disk.normal)));
    const double along_m = static_cast<double>(length(cross(offset, disk.normal)));
    return height_m < options.covered_within_m &&
           along_m <= options.overlap * static_cast<double>(disk.radius) + 1e-6;
  });
}

void expect_all_covered(const std::vector<Disk>& seeds, const std::vector<Disk>& chosen) {
  std::size_t bare = 0;
  for (const Disk& seed : seeds)
    if (seed.radius > 0 && !is_covered(seed, chosen, tested_cover())) ++bare;
  EXPECT_EQ(bare, 0U);
}

TEST(SurfaceCover, FlatPlaneTakesFewLargeDisks) {
  // 160 seeds fill a circle of radius 0.36 m; 0.8 of it holds a hundred of them.
  const Executor executor(2);
  std::vector<Disk> patch;
  add_patch(patch, 60, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Seeds seeds(patch, executor);
  const SurfaceCover cover(seeds.disks, seeds.index, tested_cover(), executor);
  const std::vector<Disk> chosen = cover.choose(executor);
  ASSERT_EQ(chosen.size(), seeds.disks.size());
  EXPECT_GE(count_chosen(chosen), 3600U / 120);
  EXPECT_LE(count_chosen(chosen), 3600U / 25);
  expect_all_covered(seeds.disks, chosen);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!(chosen[i].radius > 0)) continue;
    EXPECT_EQ(chosen[i].center, seeds.disks[i].center);
    EXPECT_EQ(chosen[i].normal, seeds.disks[i].normal);
    EXPECT_GE(chosen[i].radius, kSeed_m);
    EXPECT_LE(chosen[i].radius, 0.5F);
  }
}

TEST(SurfaceCover, NoDiskIsLargerThanAllowed) {
  const Executor executor(1);
  std::vector<Disk> patch;
  add_patch(patch, 30, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Seeds seeds(patch, executor);
  CoverOptions options = tested_cover();
  options.largest_radius_m = 0.2;
  const auto chosen = SurfaceCover(seeds.disks, seeds.index, options, executor).choose(executor);
  float largest_m = 0;
  for (const Disk& disk : chosen) largest_m = std::max(largest_m, disk.radius);
  EXPECT_LE(largest_m, 0.2F);
  EXPECT_GT(largest_m, 0.15F);
  expect_all_covered(seeds.disks, chosen);
}

// Seeds that are larger than the limit of grown disks keep their size, and cover what is within it.
TEST(SurfaceCover, LargeSeedsCoverAllThatTheyReach) {
  const Executor executor(2);
  std::vector<Disk> unordered;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 12; ++x)
      unordered.push_back(
          {{0.5F * static_cast<float>(x), 0.5F * static_cast<float>(y), 0}, 2, {0, 0, 1}});
  }
  const Seeds seeds(unordered, executor);
  CoverOptions options = tested_cover();
  const auto chosen_of = [&] {
    const SurfaceCover cover(seeds.disks, seeds.index, options, executor);
    return std::ranges::count_if(cover.choose(executor),
                                 [](const Disk& disk) { return disk.radius > 0; });
  };
  const auto small_limit = chosen_of();
  options.largest_radius_m = 2;  // the same radii, and no seed within reach is left out
  EXPECT_EQ(small_limit, chosen_of());
  EXPECT_LT(small_limit, 30);
}

TEST(SurfaceCover, ParallelPlanesDoNotCoverEachOther) {
  // 10 cm apart, as the two sides of a thin wall; 40 cm apart, as floor and table.
  const Executor executor(2);
  for (const float gap_m : {0.1F, 0.4F}) {
    std::vector<Disk> low, high;
    add_patch(low, 30, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_patch(high, 30, {0, 0, gap_m}, {1, 0, 0}, {0, 1, 0});
    std::vector<Disk> both = low;
    both.insert(both.end(), high.begin(), high.end());
    const Seeds seeds(both, executor);
    const auto chosen =
        SurfaceCover(seeds.disks, seeds.index, tested_cover(), executor).choose(executor);
    std::vector<Disk> chosen_low, chosen_high;
    for (const Disk& disk : chosen)
      if (disk.radius > 0)
        (disk.center.z < 0.5F * gap_m ? chosen_low : chosen_high).push_back(disk);
    expect_all_covered(low, chosen_low);
    expect_all_covered(high, chosen_high);
    if (gap_m > 0.25F) {
      EXPECT_LE(chosen_low.size(), 900U / 20);  // not an edge: both grow
    }
  }
}

TEST(SurfaceCover, DisksStopAtACorner) {
  // A floor and a wall that meet at x = 0; the lowest seeds of the wall are half a step up.
  const Executor executor(1);
  std::vector<Disk> corner;
  add_patch(corner, 40, {0.5F * kStep_m, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_patch(corner, 40, {0, 0, 0.5F * kStep_m}, {0, 0, 1}, {0, 1, 0});
  const Seeds seeds(corner, executor);
  const auto chosen =
      SurfaceCover(seeds.disks, seeds.index, tested_cover(), executor).choose(executor);
  expect_all_covered(seeds.disks, chosen);
  int large = 0;
  for (const Disk& disk : chosen) {
    if (!(disk.radius > 0)) continue;
    const bool floor = std::fabs(disk.normal.z) > 0.5F;
    const float from_corner_m = floor ? disk.center.x : disk.center.z;
    EXPECT_LE(disk.radius, std::max(kSeed_m, std::hypot(from_corner_m, 0.5F * kStep_m) + 1e-6F));
    if (disk.radius > 0.3F) ++large;
  }
  EXPECT_GE(large, 10);
}

TEST(SurfaceCover, CurvedSurfaceKeepsSmallDisks) {
  // A tube of radius R: a disk may reach as far as its plane is within 1.5 cm of the tube, which is
  // sqrt(2 R 0.015) across it; the next ring of seeds beyond that ends it.
  const Executor executor(1);
  constexpr double kTube_m = 0.3;
  constexpr int kAround = 48;
  std::vector<Disk> tube;
  for (int z = 0; z < 40; ++z) {
    for (int a = 0; a < kAround; ++a) {
      const double angle = 2 * 3.14159265358979 * a / kAround;
      const Vec3d normal = {std::cos(angle), std::sin(angle), 0};
      const Vec3d center = kTube_m * normal + Vec3d{0, 0, 0.04 * z};
      tube.push_back({vec_cast<float>(center), 0.05F, vec_cast<float>(normal)});
    }
  }
  const Seeds seeds(tube, executor);
  const auto chosen =
      SurfaceCover(seeds.disks, seeds.index, tested_cover(), executor).choose(executor);
  expect_all_covered(seeds.disks, chosen);
  for (const Disk& disk : chosen) EXPECT_LT(disk.radius, std::sqrt(2 * kTube_m * 0.015) + 0.04);
}

/// A patch and what its disks grow to: with no overlap every disk covers itself alone, so that all
/// are chosen.
struct GrownPatch {
  Vec3f u, v;
  std::vector<Disk> disks;

  /// Turned by an angle within its own plane, which is tilted; `is_there(x, y)`, metres.
  template <class IsThere>
  GrownPatch(int n, float turn_rad, int sectors, const IsThere& is_there) {
    const Vec3f a = normalized(Vec3f{1, 0, 0.5F}), b = {0, 1, 0};
    u = std::cos(turn_rad) * a + std::sin(turn_rad) * b;
    v = std::cos(turn_rad) * b - std::sin(turn_rad) * a;
    std::vector<Disk> all, patch;
    add_patch(all, n, {0, 0, 0}, u, v);
    for (const Disk& disk : all)
      if (is_there(x_of(disk), y_of(disk))) patch.push_back(disk);
    CoverOptions options = tested_cover();
    options.neighbors = 1000;  // the largest radius limits, not these
    options.overlap = 0;
    options.sectors = sectors;
    const Executor executor(2);
    const Seeds seeds(patch, executor);
    disks = SurfaceCover(seeds.disks, seeds.index, options, executor).choose(executor);
  }
  GrownPatch(int n, float turn_rad, int sectors)
      : GrownPatch(n, turn_rad, sectors, [](float, float) { return true; }) {}

  float x_of(const Disk& disk) const { return dot(disk.center, u); }
  float y_of(const Disk& disk) const { return dot(disk.center, v); }
  /// The disk at a place of the patch.
  const Disk& at(float x, float y) const {
    const auto distance = [&](const Disk& d) { return std::hypot(x_of(d) - x, y_of(d) - y); };
    return *std::min_element(disks.begin(), disks.end(), [&](const Disk& d, const Disk& e) {
      return distance(d) < distance(e);
    });
  }
};

/// A seed in a sector of 45 degrees that a straight border cuts off `d` away stands no farther than
/// d / cos(45 degrees), whichever way the sectors are turned.
float max_reach(float d) { return std::sqrt(2.0F) * d; }

TEST(SurfaceCover, WithSectorsDisksEndWhereSeedsEndInTheirNearestDirection) {
  constexpr float kSide_m = 30 * kStep_m;
  for (const float turn_rad : {0.0F, 0.2F, 0.39F, 0.6F}) {
    const GrownPatch limited(31, turn_rad, 8);
    const GrownPatch free(31, turn_rad, 0);
    int border = 0, inner = 0;
    float largest_m = 0;
    for (std::size_t i = 0; i < limited.disks.size(); ++i) {
      const Disk& disk = limited.disks[i];
      const float x = limited.x_of(disk), y = limited.y_of(disk);
      const float from_border_m = std::max(0.0F, std::min({x, y, kSide_m - x, kSide_m - y}));
      EXPECT_LE(disk.radius, std::max(kSeed_m, max_reach(from_border_m) + 0.5F * kSeed_m) + 1e-4F);
      EXPECT_GE(disk.radius, std::max(kSeed_m, std::min(from_border_m, 0.45F) - 1e-4F));
      EXPECT_LE(disk.radius, free.disks[i].radius);
      largest_m = std::max(largest_m, disk.radius);
      if (from_border_m < 0.01F) {
        ++border;
        EXPECT_EQ(disk.radius, kSeed_m);
        EXPECT_GT(free.disks[i].radius, 0.45F);  // the tail that sectors are against
      } else if (from_border_m > 0.51F) {
        ++inner;
        EXPECT_GT(disk.radius, 0.45F);
      }
    }
    EXPECT_EQ(border, 4 * 30);
    EXPECT_EQ(inner, 9 * 9);
    EXPECT_LE(largest_m, 0.5F);
  }
}

TEST(SurfaceCover, WithSectorsAGapEndsDisksUnlessTheyReachItsOtherSide) {
  // A strip without seeds next to y-lines of the lattice; a disk 0.2 m away from it.
  const auto radius_beside = [](float gap_m, int sectors) {
    const GrownPatch patch(41, 0.3F, sectors,
                           [&](float x, float) { return x < 1.01F || x > 0.99F + gap_m; });
    return patch.at(0.8F, 1).radius;
  };
  EXPECT_GT(radius_beside(0.15F, 8), 0.4F);  // seeds 0.35 m and more away lie across it
  EXPECT_GE(radius_beside(0.6F, 8), 0.2F);
  EXPECT_LE(radius_beside(0.6F, 8), max_reach(0.2F) + 0.5F * kSeed_m);
  EXPECT_GT(radius_beside(0.6F, 0), 0.45F);
}

TEST(SurfaceCover, WithSectorsEverySeedIsStillCovered) {
  const Executor executor(2);
  std::vector<Disk> patch;
  add_patch(patch, 30, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Seeds seeds(patch, executor);
  CoverOptions options = tested_cover();
  const auto chosen_with = [&](int sectors) {
    options.sectors = sectors;
    return SurfaceCover(seeds.disks, seeds.index, options, executor).choose(executor);
  };
  const std::vector<Disk> limited = chosen_with(8);
  expect_all_covered(seeds.disks, limited);
  EXPECT_GT(count_chosen(limited), count_chosen(chosen_with(0)));
  EXPECT_LT(count_chosen(limited), 900U / 3);
}

TEST(SurfaceCover, LimitsHold) {
  const Executor executor(2);
  std::vector<Disk> patch;
  add_patch(patch, 40, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Seeds seeds(patch, executor);
  SurfaceCover cover(seeds.disks, seeds.index, tested_cover(), executor);
  const std::vector<Disk> before = cover.choose(executor);
  std::vector<Disk> expected = seeds.disks;  // what is left to cover
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!(before[i].radius > 0)) continue;
    const float limit_m = i % 2 == 0 ? 0.1F : 0.0F;
    cover.limits().limit(i, limit_m);
    cover.limits().limit(i, 0.2F);  // a wider one afterwards changes nothing
    expected[i].radius = std::min(expected[i].radius, limit_m);
    EXPECT_EQ(cover.limits().seeds[i].radius, expected[i].radius);
  }
  const std::vector<Disk> after = cover.choose(executor);
  expect_all_covered(expected, after);
  EXPECT_GT(count_chosen(after), 0U);
  for (std::size_t i = 0; i < before.size(); ++i)
    if (before[i].radius > 0) {
      EXPECT_LE(after[i].radius, i % 2 == 0 ? 0.1F : 0.0F);
    }
  for (std::size_t i = 0; i < before.size(); ++i) cover.limits().limit(i, 0);
  EXPECT_EQ(count_chosen(cover.choose(executor)), 0U);
}

TEST(SurfaceCover, SeedsWithoutRadiusAreIgnored) {
  // They are not chosen, need no cover, and are no edge: the others are chosen as if alone.
  const Executor executor(1);
  std::vector<Disk> patch;
  add_patch(patch, 20, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::size_t there = patch.size();
  for (int k = 0; k < 50; ++k)
    patch.push_back({{0.02F * static_cast<float>(k), 0.51F, 0.05F}, 0, {1, 0, 0}});
  const Seeds seeds(patch, executor);
  CoverOptions options = tested_cover();
  options.neighbors = 1000;  // of all seeds: absent ones take no one's place
  const auto chosen = SurfaceCover(seeds.disks, seeds.index, options, executor).choose(executor);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (!(seeds.disks[i].radius > 0)) {
      EXPECT_EQ(chosen[i].radius, 0.0F);
    }
  expect_all_covered(seeds.disks, chosen);
  patch.resize(there);
  const Seeds alone(patch, executor);
  const auto expected = SurfaceCover(alone.disks, alone.index, options, executor).choose(executor);
  EXPECT_EQ(count_chosen(chosen), count_chosen(expected));
}

TEST(SurfaceCover, SameBytesForEveryNumberOfThreads) {
  std::vector<Disk> patch;
  add_patch(patch, 100, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});  // several runs of the index
  const auto chosen_by = [&](int threads) {
    const Executor executor(threads);
    const Seeds seeds(patch, executor);
    return SurfaceCover(seeds.disks, seeds.index, tested_cover(), executor).choose(executor);
  };
  const std::vector<Disk> one = chosen_by(1);
  expect_all_covered(patch, one);
  for (const int threads : {2, 3}) {
    const std::vector<Disk> other = chosen_by(threads);
    ASSERT_EQ(other.size(), one.size());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(Disk)), 0);
  }
}

TEST(SurfaceCover, NoSeedOrOne) {
  const Executor executor(1);
  const Seeds none({}, executor);
  EXPECT_TRUE(
      SurfaceCover(none.disks, none.index, tested_cover(), executor).choose(executor).empty());
  const Seeds one({{{1, 2, 3}, 0.07F, {0, 0, 1}}}, executor);
  const auto chosen = SurfaceCover(one.disks, one.index, tested_cover(), executor).choose(executor);
  ASSERT_EQ(chosen.size(), 1U);
  EXPECT_EQ(chosen[0].radius, 0.07F);
}

}  // namespace
}  // namespace adasplats
