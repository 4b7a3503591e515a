// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {
namespace {

constexpr float kWall_m = 8;  // of the last disk

/// Two soft disks at 3 and 5 m, whose opacity is half that of the centre at 0.5 and 0.9 m, and a
/// wall at 8 m. No ray of cloud_of() passes beside them.
std::vector<Disk> row_of_disks() {
  return {{{3, 0, 0}, 0.5F * kRimReach, {1, 0, 0}},
          {{5, 0.1F, 0}, 0.9F * kRimReach, {1, 0, 0}},
          {{kWall_m, 0, 0}, 9 * kRimReach, {1, 0, 0}}};
}

/// Rays from the origin that end at the disk that `end_of(ray, number)` names.
template <class EndOf>
PointCloud cloud_of(int count, const EndOf& end_of) {
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    Random random(1, 0, static_cast<std::uint64_t>(i));
    const float y = static_cast<float>(random.uniform(-0.15, 0.15));
    const float z = static_cast<float>(random.uniform(-0.15, 0.15));
    cloud.positions.push_back(end_of(random, y, z) * Vec3f{1, y, z});
    cloud.sensor_positions.push_back({});
  }
  return cloud;
}

/// The logarithm of the likelihood of ray x {1, y, z}, written down from its definition.
double log_likelihood(Vec3f end, const std::vector<DiskExtent>& extents,
                      const ExtentOptions& options) {
  double passes = 1, sum = static_cast<double>(options.stray_per_m);
  const double range = static_cast<double>(length(end));
  const std::vector<Disk> disks = row_of_disks();
  for (std::size_t k = 0; k < disks.size(); ++k) {
    const Vec3f hit = disks[k].center.x / end.x * end;
    const double half_m = static_cast<double>(disks[k].radius / kRimReach * extents[k].scale);
    const double radii = static_cast<double>(length(hit - disks[k].center)) / half_m;
    const double x = static_cast<double>(kRimSharpness) * (radii - 1);
    if (static_cast<double>(length(hit)) > range + static_cast<double>(options.beyond_m)) break;
    const double opacity =
        static_cast<double>(extents[k].opacity) * 0.5 * (1 - x / std::sqrt(1 + x * x));
    const double scale = static_cast<double>(options.error_scale_m);
    const double error = (static_cast<double>(length(hit)) - range) / scale;
    sum += passes * opacity / (std::numbers::pi * scale * (1 + error * error));
    passes *= 1 - opacity;
  }
  return std::log(sum);
}

TEST(AddExtentsOfRay, GivesTheGradientsOfTheLogLikelihood) {
  const Executor executor(2);
  const ExtentOptions options;
  const std::vector<DiskExtent> extents = {{0.5F, 1}, {0.3F, 1}, {0.9F, 1}};
  const PointCloud cloud = cloud_of(50, [](Random& random, float, float) {
    const double which = random.uniform(0, 3);
    return which < 1 ? 3.02F : which < 2 ? 4.99F : kWall_m;
  });
  const MeasuredRays rays(cloud, 0.1, executor);
  const std::vector<const MeasuredRays*> all = {&rays};
  const auto sums = sum_extents(row_of_disks(), extents, all, options, executor);
  const auto total = [&](const std::vector<DiskExtent>& of) {
    double sum = 0;
    for (const Vec3f end : cloud.positions) sum += log_likelihood(end, of, options);
    return sum;
  };
  constexpr float kStep = 0.01F;
  for (std::size_t k = 0; k < 3; ++k) {
    auto more = extents, less = extents;
    const float odds = extents[k].opacity / (1 - extents[k].opacity);
    const auto opacity_of = [](float of) { return of / (1 + of); };
    more[k].opacity = opacity_of(odds * std::exp(kStep));
    less[k].opacity = opacity_of(odds * std::exp(-kStep));
    const double by_odds = (total(more) - total(less)) / static_cast<double>(2 * kStep);
    EXPECT_NEAR(static_cast<double>(sums[k].opacity) * ExtentSums::kUnit, by_odds,
                0.01 + 0.01 * std::fabs(by_odds));
    more = less = extents;
    more[k].scale = std::exp(kStep);
    less[k].scale = std::exp(-kStep);
    const double by_scale = (total(more) - total(less)) / static_cast<double>(2 * kStep);
    EXPECT_NEAR(static_cast<double>(sums[k].scale) * ExtentSums::kUnit, by_scale,
                0.01 + 0.02 * std::fabs(by_scale));
  }
}

/// Extents after 30 rounds, with a first disk of radius 0.5 at 3 m.
std::vector<DiskExtent> refined_by(const PointCloud& cloud, const ExtentOptions& options) {
  const Executor executor(2);
  const MeasuredRays rays(cloud, 0.1, executor);
  const std::vector<const MeasuredRays*> all = {&rays};
  std::vector<DiskExtent> extents(3, DiskExtent{options.first_opacity, 1});
  for (int round = 0; round < 30; ++round) {
    std::vector<Disk> disks = row_of_disks();
    for (std::size_t k = 0; k < disks.size(); ++k) disks[k].radius *= extents[k].scale;
    const auto sums = sum_extents(disks, extents, all, options, executor);
    for (std::size_t k = 0; k < disks.size(); ++k)
      extents[k] = refined(extents[k], sums[k], options);
  }
  return extents;
}

// Oracle: the shares that the rays were drawn with.
TEST(Refined, FindsTheShareOfRaysThatEndAtADisk) {
  const ExtentOptions options;
  const auto extents =
      refined_by(cloud_of(4000, [](Random& random, float,
                                   float) { return random.uniform() < 0.4 ? 3.0F : kWall_m; }),
                 options);
  EXPECT_NEAR(extents[0].opacity, 0.4, 0.05);
  EXPECT_LT(extents[1].opacity, 0.03);
  EXPECT_GT(extents[2].opacity, 0.97);
}

TEST(Refined, FindsTheRadiusWithinWhichRaysEnd) {
  const ExtentOptions options;
  constexpr float kRadius_m = 0.3F;
  const auto extents = refined_by(
      cloud_of(4000, [](Random&, float y,
                        float z) { return 3 * std::hypot(y, z) < kRadius_m ? 3.0F : kWall_m; }),
      options);
  EXPECT_GT(extents[0].opacity, 0.9);
  EXPECT_NEAR(0.5F * extents[0].scale, kRadius_m, 0.05);
}

}  // namespace
}  // namespace adasplats
