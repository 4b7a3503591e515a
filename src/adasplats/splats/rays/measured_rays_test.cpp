// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/rays/measured_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <span>
#include <vector>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

Vec3f random_vector(Random& random, double low, double high) {
  const double x = random.uniform(low, high), y = random.uniform(low, high);
  return vec_cast<float>(Vec3d{x, y, random.uniform(low, high)});
}

/// Points anywhere within 10 m, seen from one of ten places.
PointCloud random_cloud(std::size_t n) {
  PointCloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    Random random(1, 0, i), place(1, 1, i % 10);
    cloud.positions.push_back(random_vector(random, -10, 10));
    cloud.sensor_positions.push_back(random_vector(place, -3, 3));
  }
  return cloud;
}

std::vector<Disk> random_disks(std::size_t n) {
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < n; ++i) {
    Random random(2, 0, i);
    Disk disk;
    disk.center = random_vector(random, -6, 6);
    disk.normal = normalized(random_vector(random, -1, 1));
    disk.radius = static_cast<float>(random.uniform(0.1, 1.5));
    disks.push_back(disk);
  }
  return disks;
}

/// The tests' own numbers: the defaults may be tuned.
EvidenceOptions evidence_options() {
  EvidenceOptions options;
  options.range_margin_m = 0.15F;
  options.height_margin_m = 0.03F;
  options.min_cosine = 0.2F;
  options.parts = 1;
  options.part = 0;
  return options;
}

/// One set of rays as several may be.
std::vector<const MeasuredRays*> one(const MeasuredRays& rays) { return {&rays}; }

/// Oracle: every ray with every disk.
RayEvidence by_brute_force(std::span<const Disk> disks, const MeasuredRays& rays,
                           const EvidenceOptions& options) {
  RayEvidence evidence;
  evidence.confirmed.resize(disks.size() * RayEvidence::kBins);
  evidence.contradicted.resize(disks.size() * RayEvidence::kBins);
  std::vector<std::uint32_t> numbers(rays.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  if (options.parts > 1) {
    const auto part = rays.part(options.parts, options.part);
    numbers.assign(part.begin(), part.end());
  }
  for (const std::uint32_t i : numbers) {
    const Ray ray = rays.ray(i, 0.3F);  // 0.15 + 0.03 / 0.2
    for (std::size_t d = 0; d < disks.size(); ++d) {
      if (!(disks[d].radius > 0)) continue;
      const float t = intersect_disk(ray, disks[d]);
      if (!std::isfinite(t)) continue;
      const float from_middle_m = length(ray.origin + t * ray.direction - disks[d].center);
      const float share = from_middle_m * from_middle_m / (disks[d].radius * disks[d].radius);
      const auto bin = std::min<std::size_t>(static_cast<std::size_t>(16 * share), 15);
      const float cosine = std::max(0.2F, std::fabs(dot(disks[d].normal, ray.direction)));
      const float margin_m = 0.15F + 0.03F / cosine;
      if (t - rays.range_m(i) > margin_m) continue;
      const bool goes_on = rays.range_m(i) - t > margin_m;
      ++(goes_on ? evidence.contradicted : evidence.confirmed)[16 * d + bin];
    }
  }
  return evidence;
}

/// Rounding may move a ray across a ring or the margin: `most` of the counts may differ by that.
void expect_equal_but(std::uint64_t most, const std::vector<std::uint32_t>& a,
                      const std::vector<std::uint32_t>& b) {
  ASSERT_EQ(a.size(), b.size());
  std::uint64_t differences = 0;
  for (std::size_t k = 0; k < a.size(); ++k) differences += a[k] > b[k] ? a[k] - b[k] : b[k] - a[k];
  EXPECT_LE(differences, most);
}

std::uint64_t total(const std::vector<std::uint32_t>& counts) {
  std::uint64_t sum = 0;
  for (const std::uint32_t n : counts) sum += n;
  return sum;
}

TEST(MeasuredRays, EachPointOnceAndNoneNearerThanTheMinRange) {
  const PointCloud cloud = random_cloud(70000);
  const MeasuredRays rays(cloud, 4, Executor(2));
  std::vector<int> times(cloud.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t point = rays.point(i);
    ++times[point];
    const Vec3f to_point = cloud.positions[point] - cloud.sensor_positions[point];
    EXPECT_FLOAT_EQ(rays.range_m(i), length(to_point));
    const Ray ray = rays.ray(i, 0.3F);
    EXPECT_EQ(ray.origin, cloud.sensor_positions[point]);
    EXPECT_NEAR(length(ray.direction), 1.0F, 1e-6F);
    EXPECT_FLOAT_EQ(ray.t_max, length(to_point) + 0.3F);
    EXPECT_EQ(ray.t_min, 0.0F);
    const Vec3f end = ray.origin + rays.range_m(i) * ray.direction;
    EXPECT_LT(length(end - cloud.positions[point]), 1e-5F);
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float range_m = length(cloud.positions[i] - cloud.sensor_positions[i]);
    EXPECT_EQ(times[i], range_m >= 4.0F ? 1 : 0);
  }
  EXPECT_FALSE(rays.empty());
}

TEST(MeasuredRays, NeighborsStartAtOnePlaceAndPointAlike) {
  // Ten places: in a good order the place changes nine times, and directions take small steps.
  const PointCloud cloud = random_cloud(20000);
  const MeasuredRays rays(cloud, 0, Executor(1));
  int changes = 0;
  double turns = 0;
  for (std::size_t i = 1; i < rays.size(); ++i) {
    const Ray before = rays.ray(i - 1, 0), ray = rays.ray(i, 0);
    if (!(before.origin == ray.origin)) ++changes;
    turns += static_cast<double>(length(before.direction - ray.direction));
  }
  EXPECT_EQ(changes, 9);
  EXPECT_LT(turns / static_cast<double>(rays.size()), 0.2);  // at random: 1.3
}

TEST(MeasuredRays, NoPointsOrNoneFarEnough) {
  EXPECT_TRUE(MeasuredRays({}, 2, Executor(1)).empty());
  PointCloud cloud;
  cloud.positions = {{1, 0, 0}, {0, 0, 0}, {1.9F, 0, 0}};
  cloud.sensor_positions.resize(3);
  EXPECT_TRUE(MeasuredRays(cloud, 2, Executor(1)).empty());
  cloud.positions[2].x = 2;
  EXPECT_EQ(MeasuredRays(cloud, 2, Executor(1)).size(), 1U);
}

TEST(CollectEvidence, EqualsBruteForce) {
  const std::vector<Disk> disks = random_disks(150);
  PointCloud cloud = random_cloud(20000);
  for (std::size_t i = 0; i < cloud.size(); i += 2) {  // half of the rays end near a disk
    Random random(5, 0, i);
    cloud.positions[i] = disks[i % 150].center + random_vector(random, -0.3, 0.3);
  }
  const Executor executor(2);
  const MeasuredRays rays(cloud, 2, executor);
  for (const std::uint32_t part : {0U, 3U}) {
    EvidenceOptions options = evidence_options();
    options.parts = 4;
    options.part = part;
    const RayEvidence found = collect_evidence(disks, one(rays), options, executor);
    const RayEvidence expected = by_brute_force(disks, rays, options);
    EXPECT_GT(total(expected.confirmed), 500U);
    EXPECT_GT(total(expected.contradicted), 3000U);
    expect_equal_but(4, found.confirmed, expected.confirmed);
    expect_equal_but(4, found.contradicted, expected.contradicted);
  }
}

TEST(CollectEvidence, PartsAreAllRaysTogetherAndThreadsDoNotMatter) {
  // More rays than one batch of the implementation holds, in 1, and in 3 parts.
  const PointCloud cloud = random_cloud(200000);
  const Executor executor(2);
  const MeasuredRays rays(cloud, 2, executor);
  const std::vector<Disk> disks = random_disks(20);
  EvidenceOptions options = evidence_options();
  const RayEvidence all = collect_evidence(disks, one(rays), options, executor);
  expect_equal_but(40, all.confirmed, by_brute_force(disks, rays, options).confirmed);
  for (const int threads : {1, 3}) {
    const RayEvidence again = collect_evidence(disks, one(rays), options, Executor(threads));
    EXPECT_EQ(again.confirmed, all.confirmed);
    EXPECT_EQ(again.contradicted, all.contradicted);
  }
  for (const std::uint32_t parts : {2U, 4U}) {
    RayEvidence sum;
    sum.confirmed.resize(all.confirmed.size());
    sum.contradicted.resize(all.confirmed.size());
    options.parts = parts;
    for (options.part = 0; options.part < parts; ++options.part) {
      const std::size_t count = rays.part(parts, options.part).size();
      EXPECT_NEAR(static_cast<double>(count * parts), static_cast<double>(rays.size()), 4000);
      const RayEvidence part = collect_evidence(disks, one(rays), options, executor);
      for (std::size_t k = 0; k < sum.confirmed.size(); ++k) {
        sum.confirmed[k] += part.confirmed[k];
        sum.contradicted[k] += part.contradicted[k];
      }
    }
    EXPECT_EQ(sum.confirmed, all.confirmed);
    EXPECT_EQ(sum.contradicted, all.contradicted);
  }
}

TEST(MeasuredRays, APieceHasItsRaysInThePartsOfTheWhole) {
  const PointCloud cloud = random_cloud(4000);
  std::vector<std::uint32_t> some;
  for (std::uint32_t i = 0; i < cloud.size(); i += 3) some.push_back(i);
  const PointCloud tile = gather(cloud, some);
  const Executor executor(2);
  const MeasuredRays all(cloud, 2, executor), few(tile, 2, executor);
  const auto part_of = [](const MeasuredRays& rays, std::uint32_t part) {
    std::set<std::uint32_t> points;
    for (const std::uint32_t i : rays.part(4, part)) points.insert(rays.point(i));
    return points;
  };
  for (std::uint32_t part = 0; part < 4; ++part) {
    const std::set<std::uint32_t> whole = part_of(all, part), own = part_of(few, part);
    ASSERT_GT(own.size(), 200U);
    for (const std::uint32_t i : own) ASSERT_TRUE(whole.contains(some[i]));
  }
}

TEST(CollectEvidence, DisksWithoutRadiusAreIgnored) {
  const PointCloud cloud = random_cloud(5000);
  const Executor executor(2);
  const MeasuredRays rays(cloud, 2, executor);
  std::vector<Disk> disks = random_disks(40);
  const RayEvidence before = collect_evidence(disks, one(rays), evidence_options(), executor);
  const Disk absent = {{0, 0, 0}, 0, {0, 0, 1}};
  Disk not_a_number = absent, negative = absent;
  not_a_number.radius = std::numeric_limits<float>::quiet_NaN();
  negative.radius = -1;
  disks.insert(disks.begin(), {absent, not_a_number, negative});
  const RayEvidence after = collect_evidence(disks, one(rays), evidence_options(), executor);
  constexpr std::ptrdiff_t kFirst = 3 * RayEvidence::kBins;
  for (const auto& [a, b] : {std::pair(&before.confirmed, &after.confirmed),
                             std::pair(&before.contradicted, &after.contradicted)}) {
    EXPECT_TRUE(std::equal(a->begin(), a->end(), b->begin() + kFirst, b->end()));
    EXPECT_TRUE(std::all_of(b->begin(), b->begin() + kFirst, [](auto n) { return n == 0; }));
  }
  const RayEvidence none =
      collect_evidence(std::span(disks).first(3), one(rays), evidence_options(), executor);
  EXPECT_EQ(none.confirmed, std::vector<std::uint32_t>(3 * RayEvidence::kBins));
  EXPECT_TRUE(collect_evidence({}, one(rays), evidence_options(), executor).confirmed.empty());
  const PointCloud empty;
  const MeasuredRays no_rays(empty, 2, executor);
  EXPECT_EQ(total(collect_evidence(disks, one(no_rays), evidence_options(), executor).contradicted),
            0U);
}

TEST(CollectEvidence, RingsAndMarginByHand) {
  // One disk of radius 1 at 10 m, rays along x from x = 0. Squared distances from the middle in
  // sixteenths of the squared radius: 0, 0.0625 * 16 = 1, 0.81 * 16 = 12.96.
  const std::vector<Disk> disk = {{{10, 0, 0}, 1, {1, 0, 0}}};
  PointCloud cloud;
  const auto measure = [&](float y, float range_m) {
    cloud.sensor_positions.push_back({0, y, 0});
    cloud.positions.push_back({range_m, y, 0});
  };
  measure(0, 10);          // bin 0, ends at it
  measure(0, 10.1F);       // bin 0, ends 0.1 m behind it: within the margin of 0.2 m
  measure(0.26F, 9.9F);    // bin 1, ends before it within the margin
  measure(0.26F, 9.7F);    // does not reach it
  measure(-0.9F, 10.3F);   // bin 12, goes on
  measure(-0.9F, 60);      // bin 12, goes on
  measure(1.01F, 60);      // passes it
  measure(0.995F, 10.3F);  // bin 15, goes on
  const EvidenceOptions options = evidence_options();
  const Executor executor(1);
  const MeasuredRays rays(cloud, 2, executor);
  const RayEvidence evidence = collect_evidence(disk, one(rays), options, executor);
  using Counts = std::vector<std::uint32_t>;
  EXPECT_EQ(evidence.confirmed, (Counts{2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(evidence.contradicted, (Counts{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 1}));
}

// However many disks a ray crosses, and however many of them at one distance.
// A ray's end 5 cm behind a disk along the ray: far behind it where the ray meets it square, 5 mm
// off its plane where the ray grazes it.
TEST(CollectEvidence, GrazingRaysEndAtDisksThatTheyCrossFarther) {
  EvidenceOptions options;
  options.range_margin_m = 0.02F;
  options.height_margin_m = 0.01F;
  options.min_cosine = 0.1F;
  const Ray ray{{0, 0, 0}, 0, {1, 0, 0}, 100};
  const auto word = [&](float cosine, float range_m) {
    const Disk disk{{10, 0, 0}, 1, {cosine, std::sqrt(1 - cosine * cosine), 0}};
    return verdict_of_ray(disk, ray, 10, range_m, options);
  };
  EXPECT_EQ(word(1, 10.029F), RayVerdict::confirms);
  EXPECT_EQ(word(1, 10.031F), RayVerdict::contradicts);
  EXPECT_EQ(word(-1, 9.971F), RayVerdict::confirms);
  EXPECT_EQ(word(1, 9.969F), RayVerdict::nothing);
  EXPECT_EQ(word(0.2F, 10.069F), RayVerdict::confirms);
  EXPECT_EQ(word(0.2F, 10.071F), RayVerdict::contradicts);
  // Below the minimum cosine it is constant.
  EXPECT_EQ(word(0.01F, 10.119F), RayVerdict::confirms);
  EXPECT_EQ(word(0.01F, 10.121F), RayVerdict::contradicts);
  EXPECT_FLOAT_EQ(options.max_margin_m(), 0.12F);
}

// What a beam without return crosses within its reach is contradicted, however near to the end.
TEST(CollectEvidence, EmptyBeamsContradictAllThatTheyCross) {
  PointCloud cloud;
  cloud.positions = {{20, 0, 0}};
  cloud.sensor_positions = {{0, 0, 0}};
  const PointCloud ends = ends_of({{{0, 0, 0}, {1, 0, 0}, 0}, {{0, 5, 0}, {1, 0, 0}, 0}}, 10);
  ASSERT_EQ(ends.size(), 2U);
  const Executor executor(2);
  const MeasuredRays rays(cloud, 0, executor), empty(ends, 0, executor, RayEnds::nowhere);
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}},
                                   {{9.99F, 5, 0}, 1, {1, 0, 0}},
                                   {{10.01F, 0, 0}, 1, {1, 0, 0}},
                                   {{20, 0, 0}, 1, {1, 0, 0}}};
  const RayEvidence evidence =
      collect_evidence(disks, {{&rays, &empty}}, evidence_options(), executor);
  const auto no = [&](std::size_t i) {
    const DiskEvidence own = evidence_of(evidence, i);
    return total({own.contradicted.begin(), own.contradicted.end()});
  };
  EXPECT_EQ(no(0), 2U);  // the measured ray, too
  EXPECT_EQ(no(1), 1U);
  EXPECT_EQ(no(2), 1U);  // beyond the reach: the measured ray alone
  EXPECT_EQ(no(3), 0U);
  EXPECT_EQ(total(evidence.confirmed), 1U);
}

// One in twenty is farther; points without a known beam do not count.
TEST(EmptyReach, IsWhereTheRecordingEnds) {
  PointCloud cloud;
  for (int i = 1; i <= 100; ++i) {
    cloud.positions.push_back({static_cast<float>(i), 0, 0});
    cloud.sensor_positions.emplace_back();
  }
  EXPECT_FLOAT_EQ(empty_reach_m(cloud), 95);
  cloud.origin_kinds.assign(100, OriginKind::guessed);
  EXPECT_EQ(empty_reach_m(cloud), 0);
}

TEST(CollectEvidence, SeesEveryDiskOfARay) {
  PointCloud cloud;
  cloud.positions = {{20, 0, 0}, {20, 0, 1}, {5.105F, 0, 0}};
  cloud.sensor_positions.resize(3);
  const Executor executor(2);
  const MeasuredRays rays(cloud, 2, executor);
  const EvidenceOptions options = evidence_options();
  for (const int count : {1, 47, 48, 49, 192, 193, 1000}) {
    for (const float step_m : {0.01F, 0.0F}) {
      std::vector<Disk> disks;
      for (int i = 0; i < count; ++i)
        disks.push_back({{5 + step_m * static_cast<float>(i), 0, 0}, 1, {1, 0, 0}});
      const RayEvidence evidence = collect_evidence(disks, one(rays), options, executor);
      // The first ray goes through the middle, the second farther out; the third ends at the disks
      // up to the margin of 0.15 + 0.03 m behind its point.
      for (std::size_t i = 0; i < disks.size(); ++i) {
        const DiskEvidence own = evidence_of(evidence, i);
        ASSERT_EQ(own.contradicted[0], 1U) << i << " of " << count;
        ASSERT_EQ(total({own.contradicted.begin(), own.contradicted.end()}), 2U);
        ASSERT_EQ(own.confirmed[0], disks[i].center.x < 5.285F ? 1U : 0U) << i << " of " << count;
      }
    }
  }
}

}  // namespace
}  // namespace adasplats
