// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/global_context.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/splats/consistent/consistent_steps.h"

namespace adasplats::pieces {
namespace {

void add(PointCloud& cloud, Vec3d sensor, Vec3d point) {
  cloud.sensor_positions.push_back(vec_cast<float>(sensor));
  cloud.positions.push_back(vec_cast<float>(point));
  cloud.intensities.push_back(0.5F);
}

/// A floor and a wall 40 m long, seen from every metre of the way along them; in the air over the
/// middle a panel that one scan has, and that rays from far behind it to far beyond it go through.
PointCloud long_place() {
  PointCloud cloud;
  for (std::uint64_t i = 0; i < 80'000; ++i) {
    Random random(3, 0, i);
    const double x = random.uniform(0, 40), along = random.uniform(),
                 noise = 0.004 * random.normal();
    const Vec3d sensor = {std::clamp(std::floor(x + random.uniform(-6, 6)), 0.0, 40.0), 0, 1.8};
    add(cloud, sensor,
        i % 2 == 0 ? Vec3d{x, 6 * along - 3, noise} : Vec3d{x, 3 + noise, 2.2 * along});
  }
  for (std::uint64_t i = 0; i < 4'000; ++i) {
    Random random(3, 1, i);
    const double y = random.uniform(-0.5, 0.5), z = random.uniform(2.6, 3.4);
    if (i % 4 == 0) add(cloud, {12, 0, 3}, {15 + 0.004 * random.normal(), y, z});
    add(cloud, {1, 0, 3}, {35 + 0.004 * random.normal(), 2 * y, 3 + 2 * (z - 3)});
  }
  return cloud;
}

/// Along x.
struct Span {
  float low, high;
  bool contains(Vec3f p) const { return p.x >= low && p.x < high; }
};

constexpr Span kPiece = {10, 20}, kReach = {4, 26};

BuildOptions tested_options() {
  BuildOptions options;
  ConsistentOptions recipe;
  recipe.evidence_rays = 20'000;  // so that rays are cast in parts
  recipe.refine = false;          // as tiles are made
  options.recipe = recipe;
  return options;
}

std::vector<Disk> disks_of_tile(const PointCloud& cloud, const BuildOptions& options) {
  ProgressSink quiet;
  const SplatModel model = build_model(cloud, nullptr, options, Executor(2), quiet).first;
  std::vector<Disk> disks;
  for (const Disk& disk : model.disks)
    if (kPiece.contains(disk.center)) disks.push_back(disk);
  return disks;
}

/// The cells of the full scene, cut like the tiles of a city.
TypicalSpacing surveyed(const PointCloud& cloud) {
  const Executor executor(2);
  const auto steps = make_cpu_consistent_steps(executor);
  steps->load(cloud, ClassTables());
  const ConsistentOptions options;
  steps->fuse(options);
  std::vector<float> with_beam, without;
  for (const CellSpacing& cell : steps->spacings(options))
    (cell.with_beam ? with_beam : without).push_back(cell.spacing);
  return typical_spacing(with_beam, without);
}

TEST(GlobalContext, APieceHasTheSplatsOfTheWhole) {
  const PointCloud cloud = long_place();
  GlobalContext whole;
  whole.box = curve_box_of(cloud.positions, Executor(1));
  whole.typical = surveyed(cloud);
  whole.rays = cloud.size();
  std::vector<std::uint32_t> near, far;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    (kReach.contains(cloud.positions[i]) ? near : far).push_back(i);
  whole.passing = gather(cloud, far);
  const PointCloud tile = gather(cloud, near);
  BuildOptions options = tested_options();
  const std::vector<Disk> expected = disks_of_tile(cloud, options);
  options.whole = &whole;
  const std::vector<Disk> disks = disks_of_tile(tile, options);
  ASSERT_EQ(disks.size(), expected.size());
  EXPECT_GT(disks.size(), 400U);
  EXPECT_EQ(std::memcmp(disks.data(), expected.data(), disks.size() * sizeof(Disk)), 0);
  const auto area_in_the_air = [](const std::vector<Disk>& all) {
    float sum = 0;
    for (const Disk& disk : all)
      if (disk.center.z > 2.5F) sum += disk.radius * disk.radius;
    return sum;
  };
  // The tile lacks the rays that pass through the panel.
  whole.passing = {};
  EXPECT_GT(area_in_the_air(disks_of_tile(tile, options)), 3 * area_in_the_air(disks));
}

TEST(GlobalContext, IsOfTheMethodConsistentAlone) {
  GlobalContext whole;
  BuildOptions options;
  options.recipe = PaperOptions();
  options.whole = &whole;
  ProgressSink quiet;
  try {
    build_model(long_place(), nullptr, options, Executor(1), quiet);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
  }
}

TEST(TypicalSpacing, IsRoundedSoThatAFewCellsDoNotMatter) {
  EXPECT_EQ(rounded_spacing(0), 0);
  EXPECT_EQ(rounded_spacing(0.00639093667), rounded_spacing(0.00639092643));
  for (const double median : {0.0011, 0.037, 0.5, 3.0}) {
    EXPECT_NEAR(rounded_spacing(median), median, median / 250);
    EXPECT_EQ(rounded_spacing(rounded_spacing(median)), rounded_spacing(median));
  }
}

}  // namespace
}  // namespace adasplats::pieces
