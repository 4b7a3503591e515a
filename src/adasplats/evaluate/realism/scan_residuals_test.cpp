// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/scan_residuals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/evaluate/realism/drawn_scan_test.h"

namespace adasplats {
namespace {

/// A hall of 30 x 20 m, 1.7 m above the ground and 4 m below the roof, seen from `from` with ranges
/// that are `sigma_m` off.
std::vector<Vec3f> hall_seen(Vec3d from, double sigma_m, std::uint64_t seed) {
  const KittiScan scan = test::drawn_points([&](std::size_t ring, std::size_t column) {
    const Vec3d d = test::drawn_direction(ring, column);
    const double x_m = ((d.x > 0 ? 15.0 : -15.0) - from.x) / d.x;
    const double y_m = ((d.y > 0 ? 10.0 : -10.0) - from.y) / d.y;
    const double z_m = ((d.z > 0 ? 4.0 : -1.7) - from.z) / d.z;
    const double range_m = std::min({x_m, y_m, z_m > 0 ? z_m : 1e9});
    return test::DrawnReturn{range_m + sigma_m * test::of_beam(seed, ring, column).normal()};
  });
  return scan.positions;
}

TEST(ScanResiduals, AreTheNoiseOfPoints) {
  const Executor executor;
  const double sigma_m = 0.01;
  const std::vector<Vec3f> one = hall_seen({0, 0, 0}, sigma_m, 1);
  const std::vector<Vec3f> next = hall_seen({0.8, 0.1, 0}, sigma_m, 2);
  const RigidTransform next_from_one = {{}, {-0.8, -0.1, 0}};
  const double residual_m = scan_residual_m(one, next, next_from_one, executor);
  // Of points alone 0.6745 sigma by the cosine of incidence (the mean over the hall is about
  // 0.6), and a plane's own points add to it.
  EXPECT_GT(residual_m, 0.25 * 0.6745 * sigma_m);
  EXPECT_LT(residual_m, 1.5 * 0.6745 * sigma_m);
  // Twice the noise, twice the residual.
  const double twice_m =
      scan_residual_m(hall_seen({0, 0, 0}, 2 * sigma_m, 1),
                      hall_seen({0.8, 0.1, 0}, 2 * sigma_m, 2), next_from_one, executor);
  EXPECT_NEAR(twice_m / residual_m, 2, 0.3);
}

TEST(ScanResiduals, DoNotDependOnPoses) {
  const Executor executor;
  const std::vector<Vec3f> one = hall_seen({0, 0, 0}, 0.01, 1);
  const std::vector<Vec3f> next = hall_seen({0.8, 0.1, 0}, 0.01, 2);
  const RigidTransform exact = {{}, {-0.8, -0.1, 0}};
  const RigidTransform wrong = {rotation_by({0.005, -0.01, 0.02}), {-0.6, -0.2, 0.1}};
  const double residual_m = scan_residual_m(one, next, exact, executor);
  EXPECT_NEAR(scan_residual_m(one, next, wrong, executor), residual_m, 0.1 * residual_m);
}

TEST(ScanResiduals, AreNaNForTooFewPoints) {
  const Executor executor;
  EXPECT_TRUE(std::isnan(scan_residual_m({}, {}, {}, executor)));
  const std::vector<Vec3f> few = {{5, 0, 0}, {5, 1, 0}};
  EXPECT_TRUE(std::isnan(scan_residual_m(few, few, {}, executor)));
  EXPECT_TRUE(scan_residuals_m({}, {}, 12, executor).empty());
}

TEST(ScanResiduals, SameForAnyNumberOfThreads) {
  const std::vector<Vec3f> one = hall_seen({0, 0, 0}, 0.01, 1);
  const std::vector<Vec3f> next = hall_seen({0.8, 0.1, 0}, 0.01, 2);
  EXPECT_EQ(scan_residual_m(one, next, {}, Executor(1)),
            scan_residual_m(one, next, {}, Executor(3)));
}

}  // namespace
}  // namespace adasplats
