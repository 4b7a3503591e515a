// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "adasplats/core/maths/random.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {
namespace {

using Rings = std::array<std::uint32_t, RayEvidence::kBins>;

float balanced(const Rings& confirmed, const Rings& contradicted) {
  return balanced_radius({confirmed, contradicted}, 2.0F);
}

float strict(const Rings& confirmed, const Rings& contradicted, double max_share) {
  return strict_radius({confirmed, contradicted}, 2.0F, max_share);
}

/// Radius of a circle that holds that many sixteenths of the area of one with radius 2.
float enclosing(int rings) { return 2.0F * std::sqrt(static_cast<float>(rings) / 16.0F); }

Rings all_rings(std::uint32_t n) {
  Rings rings;
  rings.fill(n);
  return rings;
}

TEST(EvidenceOf, IsThePartOfADisk) {
  RayEvidence evidence;
  evidence.confirmed.resize(3 * 16);
  evidence.contradicted.resize(3 * 16);
  evidence.confirmed[16] = 5;
  evidence.contradicted[2 * 16 + 15] = 7;
  EXPECT_FALSE(evidence_of(evidence, 0).seen());
  EXPECT_TRUE(evidence_of(evidence, 1).seen());
  EXPECT_EQ(evidence_of(evidence, 1).confirmed[0], 5U);
  EXPECT_TRUE(evidence_of(evidence, 2).seen());
  EXPECT_EQ(evidence_of(evidence, 2).contradicted[15], 7U);
  EXPECT_EQ(evidence_of(evidence, 2).contradicted.size(), 16U);
}

TEST(BalancedRadius, KnownAnswers) {
  const Rings none{};
  EXPECT_EQ(balanced(none, none), 2.0F);  // nobody speaks against it
  EXPECT_EQ(balanced(all_rings(3), none), 2.0F);
  EXPECT_EQ(balanced(none, all_rings(3)), 0.0F);
  EXPECT_EQ(balanced(none, {0, 0, 1}), 0.0F);
  EXPECT_EQ(balanced({2}, none), 2.0F);  // trailing rings that nobody crossed stay
  EXPECT_EQ(balanced({0, 0, 0, 1}, {1}), 2.0F);
  // Balance 5, 9, 9, 4: two rings, the third has no ray.
  EXPECT_FLOAT_EQ(balanced({5, 4}, {0, 0, 0, 5}), enclosing(2));
  // Balance 5, 4, 8, 8, 7: of equally good radii that with more rays.
  EXPECT_FLOAT_EQ(balanced({5, 0, 4, 1}, {0, 1, 0, 1, 1}), enclosing(4));
  // Balance -2, 1, -9: outer rings may make up for inner ones.
  EXPECT_FLOAT_EQ(balanced({0, 3}, {2, 0, 10}), enclosing(2));
  // Balance 4, -6, -1: nothing beyond the first ring makes up for the second.
  EXPECT_FLOAT_EQ(balanced({4, 0, 5}, {0, 10}), enclosing(1));
  EXPECT_EQ(balanced({4, 0, 7}, {0, 6}), 2.0F);  // 4, -2, 5
  // The largest counts do not overflow.
  EXPECT_EQ(balanced(all_rings(0xffffffffU), all_rings(0xfffffffeU)), 2.0F);
  EXPECT_EQ(balanced(all_rings(0xfffffffeU), all_rings(0xffffffffU)), 0.0F);
}

/// Oracle for random counts: the balance of every radius, summed directly.
TEST(BalancedRadius, IsTheBestOfAllRadii) {
  for (std::size_t round = 0; round < 2000; ++round) {
    Random random(1, 0, round);
    Rings yes{}, no{};
    for (std::size_t k = 0; k < 16; ++k) {
      yes[k] = static_cast<std::uint32_t>(random.next_bits() % 4);
      no[k] = static_cast<std::uint32_t>(random.next_bits() % 5);
    }
    const auto balance_of = [&](int rings) {
      int sum = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(rings); ++k)
        sum += static_cast<int>(yes[k]) - static_cast<int>(no[k]);
      return sum;
    };
    int best = 0;
    for (int rings = 1; rings <= 16; ++rings) best = std::max(best, balance_of(rings));
    const float radius_m = balanced(yes, no);
    const int rings = static_cast<int>(std::lround(radius_m * radius_m / 4 * 16));
    EXPECT_FLOAT_EQ(radius_m, enclosing(rings));
    EXPECT_EQ(balance_of(rings), best);
  }
}

TEST(IsBorneOut, KnownAnswers) {
  const Rings none{};
  const auto borne_out = [](const Rings& confirmed, const Rings& contradicted) {
    return is_supported({confirmed, contradicted});
  };
  EXPECT_TRUE(borne_out(none, none));
  EXPECT_TRUE(borne_out({1}, none));
  EXPECT_FALSE(borne_out(none, {1}));
  EXPECT_TRUE(borne_out({0, 7}, {7}));           // as many for it as against it
  EXPECT_FALSE(borne_out({1}, {0, 4, 5, 3}));    // its own point alone: 1 against sqrt(12)
  EXPECT_TRUE(borne_out({20}, {0, 0, 30, 40}));  // a thin pole: 20 against sqrt(70)
  EXPECT_TRUE(borne_out({4}, {0, 16}));          // just as many
  EXPECT_FALSE(borne_out({4}, {0, 17}));
  EXPECT_TRUE(borne_out(all_rings(0xffffffffU), all_rings(0xffffffffU)));
}

/// The tests' own numbers: the defaults may be tuned.
SeedCheckOptions tested_judge() {
  SeedCheckOptions options;
  options.core_rings = 2;
  options.core_rays = 4;
  options.core_share = 0.25;
  options.core_radius = 0.25F;
  options.min_radius_m = 0.015F;
  return options;
}

float judged(const Rings& confirmed, const Rings& contradicted, float radius_m = 2.0F) {
  return supported_radius({confirmed, contradicted}, radius_m, tested_judge());
}

TEST(JudgedRadius, IsTheBalancedOneWhereThatIsBorneOut) {
  const Rings none{};
  EXPECT_EQ(judged(none, none), 2.0F);
  EXPECT_EQ(judged(all_rings(3), none), 2.0F);
  EXPECT_FLOAT_EQ(judged({5, 4}, {0, 0, 0, 5}), enclosing(2));
  EXPECT_FLOAT_EQ(judged({20}, {0, 0, 30, 40}), enclosing(1));  // a thin pole: 20 against sqrt(70)
  EXPECT_FLOAT_EQ(judged({4}, {0, 0, 16}), enclosing(1));       // just as many as chance
  // Balanced at three rings; the core, with 1 against 1, does not matter.
  EXPECT_FLOAT_EQ(judged({1, 0, 9}, {0, 1, 0, 40}), enclosing(3));
}

TEST(JudgedRadius, IsAQuarterWhereRaysConfirmTheCoreAlone) {
  const Rings none{};
  // 4 against sqrt(17): chance. But all of the core's rays are for it.
  EXPECT_EQ(judged({4}, {0, 0, 17}), 0.5F);
  EXPECT_EQ(judged({0, 4}, {0, 0, 17}), 0.5F);
  EXPECT_EQ(judged({1, 3}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 900}), 0.5F);
  // Too few rays: 3 of 4.
  EXPECT_EQ(judged({3}, {0, 0, 17}), 0.0F);
  EXPECT_EQ(judged({1, 2}, {0, 0, 17}), 0.0F);
  // Those beyond the core do not count for it, neither for nor against.
  EXPECT_EQ(judged({3, 0, 5}, {0, 0, 900}), 0.0F);
  EXPECT_EQ(judged({2, 2, 0}, {0, 0, 60, 900}), 0.5F);
  EXPECT_EQ(judged(none, {1}), 0.0F);
  EXPECT_EQ(judged(none, all_rings(5)), 0.0F);
}

TEST(JudgedRadius, TheCoreNeedsItsShareOfRays) {
  EXPECT_EQ(judged({4}, {12}), 0.5F);  // just a quarter
  EXPECT_EQ(judged({4}, {13}), 0.0F);
  EXPECT_EQ(judged({1, 3}, {5, 7}), 0.5F);
  EXPECT_EQ(judged({1, 3}, {5, 8}), 0.0F);
  EXPECT_FLOAT_EQ(judged({100}, {0, 300}), enclosing(1));  // borne out: 100 against sqrt(300)
  EXPECT_EQ(judged({50, 50}, {300}), 0.5F);
  EXPECT_EQ(judged({50, 50}, {301}), 0.0F);
  // Sums of large counts are exact.
  EXPECT_EQ(judged({0x40000000U}, {0xc0000000U}), 0.5F);
  EXPECT_EQ(judged({0x40000000U}, {0xc0000001U}), 0.0F);
}

TEST(JudgedRadius, IsNoSmallerThanAllowedAndIsTriedOnce) {
  const Rings confirmed = {4}, contradicted = {0, 0, 17};
  EXPECT_FLOAT_EQ(judged(confirmed, contradicted, 0.08F), 0.02F);
  EXPECT_EQ(judged(confirmed, contradicted, 0.06F), 0.015F);
  EXPECT_EQ(judged(confirmed, contradicted, 0.05F), 0.015F);
  EXPECT_EQ(judged(confirmed, contradicted, 0.0151F), 0.015F);
  EXPECT_EQ(judged(confirmed, contradicted, 0.015F), 0.0F);  // nothing smaller is left to try
  EXPECT_EQ(judged(confirmed, contradicted, 0.01F), 0.0F);
  // The balanced radius may be smaller, and small disks keep theirs.
  EXPECT_FLOAT_EQ(judged({20}, {0, 0, 30, 40}, 0.02F), 0.005F);
  EXPECT_EQ(judged(all_rings(3), {}, 0.01F), 0.01F);
}

TEST(JudgedRadius, TheCoreIsOfAsManyRingsAsAsked) {
  const Rings confirmed = {2, 0, 2}, contradicted = {0, 0, 6, 0, 400};
  SeedCheckOptions options = tested_judge();
  const auto radius_with = [&](int rings, float core_radius) {
    options.core_rings = rings;
    options.core_radius = core_radius;
    return supported_radius({confirmed, contradicted}, 2.0F, options);
  };
  EXPECT_EQ(radius_with(2, 0.25F), 0.0F);   // 2 rays
  EXPECT_EQ(radius_with(3, 0.25F), 0.5F);   // 4 of 10
  EXPECT_EQ(radius_with(4, 0.5F), 1.0F);    // the same
  EXPECT_EQ(radius_with(16, 0.25F), 0.0F);  // 4 of 410
}

TEST(StrictRadius, KnownAnswers) {
  const Rings none{};
  EXPECT_EQ(strict(none, none, 0.03), 2.0F);
  EXPECT_EQ(strict(all_rings(3), none, 0.03), 2.0F);
  EXPECT_EQ(strict(none, all_rings(3), 0.03), 0.0F);
  EXPECT_EQ(strict({100}, {3}, 0.03), 2.0F);  // just as many as allowed
  EXPECT_EQ(strict({100}, {4}, 0.03), 0.0F);
  EXPECT_FLOAT_EQ(strict({50, 50}, {0, 0, 0, 4}, 0.03), enclosing(3));
  EXPECT_FLOAT_EQ(strict({50, 50}, {0, 0, 0, 4}, 0), enclosing(3));
  EXPECT_EQ(strict({50, 50}, {0, 0, 0, 4}, 0.04), 2.0F);
  // 10 : 1 is too many, the outer rings make up for it: 110 : 1.
  EXPECT_EQ(strict({10, 100}, {1}, 0.03), 2.0F);
  EXPECT_FLOAT_EQ(strict({10, 100}, {1, 0, 0, 0, 0, 9}, 0.03), enclosing(5));
}

/// The tests' own numbers: the defaults may be tuned.
SettleOptions settle_options() {
  SettleOptions options;
  options.reach_m = 0.4;
  options.scale_m = 0.08;
  options.prior_rays = 3;
  options.min_cosine = 0.1;
  options.min_rays = 4;
  options.max_shift_m = 0.1;
  return options;
}

/// A floor z = 0 seen from 3 m above by `n` rays, and disks of a lattice at z = `height_m`.
struct Floor {
  PointCloud cloud;
  std::vector<Disk> disks;

  Floor(std::size_t n, float height_m) {
    for (std::size_t i = 0; i < n; ++i) {
      Random random(3, 0, i);
      const double x = random.uniform(-1, 1);
      cloud.positions.push_back(vec_cast<float>(Vec3d{x, random.uniform(-1, 1), 0}));
      cloud.sensor_positions.push_back({i % 2 == 0 ? 0.4F : -0.4F, 0, 3});
    }
    for (int y = -9; y <= 9; ++y) {
      for (int x = -9; x <= 9; ++x) {
        const Vec3f normal = {0, 0, (x + y) % 2 == 0 ? 1.0F : -1.0F};
        disks.push_back({{0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y), height_m},
                         0.07F,
                         normal});
      }
    }
  }
};

void settle_disks(std::span<Disk> disks, const MeasuredRays& rays, const SettleOptions& options,
                  const Executor& executor) {
  const std::vector<ShiftSums> sums = sum_shifts(disks, rays, options, executor);
  for (std::size_t i = 0; i < disks.size(); ++i) disks[i] = settled(disks[i], sums[i], options);
}

TEST(SettleDisks, APlaneThatIsOffComesBack) {
  // Oracle: the floor. Rays with an offset of 3 cm, and a prior of three rays with 0: some 100 rays
  // per disk leave 1 mm; the disks overlap, so that some have half of it.
  for (const float height_m : {0.03F, -0.03F, 0.0F}) {
    Floor floor(40000, height_m);
    const Executor executor(2);
    const MeasuredRays rays(floor.cloud, 2, executor);
    const std::vector<Disk> before = floor.disks;
    settle_disks(floor.disks, rays, settle_options(), executor);
    for (std::size_t i = 0; i < floor.disks.size(); ++i) {
      EXPECT_LT(std::fabs(floor.disks[i].center.z), 0.003F);
      EXPECT_LE(std::fabs(floor.disks[i].center.z), std::fabs(height_m) + 1e-6F);
      EXPECT_NEAR(floor.disks[i].center.x, before[i].center.x, 1e-7F);
      EXPECT_NEAR(floor.disks[i].center.y, before[i].center.y, 1e-7F);
      EXPECT_EQ(floor.disks[i].radius, before[i].radius);
      EXPECT_EQ(floor.disks[i].normal, before[i].normal);
    }
  }
}

TEST(SettleDisks, PriorCountsAsRays) {
  // One disk, n vertical rays that all end 3 cm away: it moves by 3 cm * n / (n + 3), from 4 rays
  // on.
  for (const std::size_t n : {0, 1, 3, 4, 10, 27}) {
    PointCloud cloud;
    for (std::size_t i = 0; i < n; ++i) {
      const float x = 0.002F * static_cast<float>(i);
      cloud.positions.push_back({x, 0, 0});
      cloud.sensor_positions.push_back({x, 0, 5});
    }
    const Executor executor(1);
    const MeasuredRays rays(cloud, 2, executor);
    std::vector<Disk> disks = {{{0, 0, 0.03F}, 0.1F, {0, 0, -1}}, {{0, 0, 0.1F}, 0, {0, 0, 1}}};
    settle_disks(disks, rays, settle_options(), executor);
    const double share = n < 4 ? 0 : static_cast<double>(n) / static_cast<double>(n + 3);
    EXPECT_NEAR(disks[0].center.z, 0.03 - 0.03 * share, 1e-6) << n;
    EXPECT_EQ(disks[1].center.z, 0.1F);  // no radius: not there, hides nothing, does not move
  }
}

TEST(SettleDisks, LimitsTheShiftAndIgnoresRaysOutOfReach) {
  // 0.3 m off: within reach, limited to 0.1 m. 0.5 m off: out of reach.
  for (const float height_m : {0.3F, -0.3F, 0.5F, -0.5F}) {
    Floor floor(4000, height_m);
    const Executor executor(1);
    const MeasuredRays rays(floor.cloud, 2, executor);
    settle_disks(floor.disks, rays, settle_options(), executor);
    const float moved_m = std::fabs(height_m) > 0.4F ? 0.0F : 0.1F;
    const Disk& middle = floor.disks[floor.disks.size() / 2];
    EXPECT_NEAR(middle.center.z, height_m - std::copysign(moved_m, height_m), 1e-6F);
  }
}

TEST(SettleDisks, SameBytesForEveryNumberOfThreads) {
  const Floor floor(50000, 0.02F);
  const auto settled = [&](int threads) {
    std::vector<Disk> disks = floor.disks;
    const Executor executor(threads);
    settle_disks(disks, MeasuredRays(floor.cloud, 2, executor), settle_options(), executor);
    return disks;
  };
  const std::vector<Disk> one = settled(1);
  for (const int threads : {2, 3}) {
    const std::vector<Disk> other = settled(threads);
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(Disk)), 0);
  }
}

TEST(SettleDisks, NoDisksOrNoRays) {
  const Floor floor(100, 0.02F);
  const Executor executor(1);
  settle_disks({}, MeasuredRays(floor.cloud, 2, executor), settle_options(), executor);
  std::vector<Disk> disks = floor.disks;
  const PointCloud empty;
  settle_disks(disks, MeasuredRays(empty, 2, executor), settle_options(), executor);
  EXPECT_EQ(std::memcmp(disks.data(), floor.disks.data(), disks.size() * sizeof(Disk)), 0);
}

}  // namespace
}  // namespace adasplats
