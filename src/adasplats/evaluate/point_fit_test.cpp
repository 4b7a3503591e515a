// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/point_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats::point_fit {
namespace {

/// The walls of the scene.
struct Walls {
  bool along = true, across = true;
};

constexpr double kHalf = 8;  // m

/// A yard of 16 m around the zero, 1 m above and below; disks of 0.2 m that lean by noise.
std::vector<Disk> yard(Walls walls) {
  std::vector<Disk> disks;
  const auto add = [&](Vec3d p, Vec3d normal, std::uint64_t k) {
    Random random(3, 0, disks.size() + k);
    const Vec3d lean = {0.05 * random.normal(), 0.05 * random.normal(), 0.05 * random.normal()};
    const Vec3d n = normal + lean;
    disks.push_back({vec_cast<float>(p), 0.2F, vec_cast<float>((1 / length(n)) * n)});
  };
  for (double a = -kHalf; a <= kHalf; a += 0.25) {
    for (double b = -kHalf; b <= kHalf; b += 0.25) add({a, b, 0}, {0, 0, 1}, 0);
    for (double z = 0; z <= 3; z += 0.25) {
      if (walls.along) add({a, kHalf, z}, {0, -1, 0}, 1);
      if (walls.across) add({kHalf, a, z}, {-1, 0, 0}, 2);
    }
  }
  return disks;
}

/// Rays from the middle that end on it, measured with noise of a centimetre, in another frame:
/// given = motion^-1 * true.
FitRays rays_in(Walls walls, const RigidTransform& motion, std::size_t count = 6000) {
  FitRays rays;
  const RigidTransform back = motion.inverse();
  for (std::size_t i = 0; i < count; ++i) {
    Random random(7, 1, i);
    const auto draw = [&](double low, double high) { return random.uniform(low, high); };
    const Vec3d sensor = {draw(-1, 1), draw(-1, 1), 2};
    Vec3d end = {draw(-7, 7), draw(-7, 7), 0};
    if (i % 5 == 0 && walls.along) end = {draw(-7, 7), kHalf, draw(0.2, 2.8)};
    if (i % 5 == 1 && walls.across) end = {kHalf, draw(-7, 7), draw(0.2, 2.8)};
    const double range_m = length(end - sensor);
    end = sensor + (1 + 0.01 * random.normal() / range_m) * (end - sensor);
    rays.sensors.push_back(vec_cast<float>(back * sensor));
    rays.ends.push_back(vec_cast<float>(back * end));
  }
  return rays;
}

FitPart part_of(Walls walls, const RigidTransform& motion) {
  return {FitScene(yard(walls), Executor(2)), rays_in(walls, motion)};
}

TEST(PointFit, FindsHowTheRaysWereMoved) {
  const Executor executor(2);
  for (const RigidTransform& truth :
       {RigidTransform{}, moved_about({}, {0, 0, 0}, {0.05, -0.02, 0.01}),
        moved_about({}, {0.002, -0.003, 0.02}, {-0.4, 0.3, 0.2})}) {
    const FitPart part = part_of({}, truth);
    const FitMotion found = fit_motion(part.scene, part.rays, part.rays.middle(), executor);
    EXPECT_GT(found.hits, 5500U);
    for (const Vec3d p : {Vec3d{}, Vec3d{7, 7, 0}, Vec3d{-7, 7, 2}})
      EXPECT_LT(length(found.motion * p - truth * p), 0.01) << p.x;
  }
}

TEST(PointFit, FindsTheShiftOfAllAndOfParts) {
  std::vector<FitPart> parts;
  parts.push_back(part_of({}, moved_about({}, {}, {0.2, -0.1, 0})));
  parts.push_back(part_of({}, moved_about({}, {}, {0.2, 0.1, 0})));
  const PointFit fit = fit_of_points(parts, Executor(2));
  EXPECT_EQ(fit.parts, 2U);
  EXPECT_NEAR(fit.shift_m.x, 0.2, 0.01);
  EXPECT_NEAR(fit.part_shift_m, std::hypot(0.2, 0.1), 0.01);
  EXPECT_LT(fit.distance_shifted_m, fit.distance_m);
}

// A uniform street does not constrain shifts along it, nor does a single plane within itself.
TEST(PointFit, UnconstrainedDirectionsAreZero) {
  const Executor executor(2);
  const RigidTransform moved = moved_about({}, {}, {0.3, 0.3, 0.1});
  struct Case {
    Walls walls;
    Vec3d expected;
  };
  for (const auto& [walls, expected] :
       {Case{{true, false}, {0, 0.3, 0.1}}, Case{{false, false}, {0, 0, 0.1}}}) {
    const FitPart part = part_of(walls, moved);
    const FitMotion found = fit_motion(part.scene, part.rays, {}, executor);
    EXPECT_LT(length(found.motion * Vec3d{} - expected), 0.02);
    const PointFit fit = fit_of_points(std::span(&part, 1), executor);
    EXPECT_LT(length(fit.shift_m - expected), 0.02);
  }
}

TEST(PointFit, WithoutOverlapThereIsNoFit) {
  FitPart part = {FitScene(yard({}), Executor(1)), {}};
  EXPECT_EQ(fit_of_points(std::span(&part, 1), Executor(1)).rays, 0U);
  part.rays = rays_in({}, moved_about({}, {}, {100, 0, 0}));
  const PointFit fit = fit_of_points(std::span(&part, 1), Executor(1));
  EXPECT_EQ(fit.rays, 0U);
  EXPECT_EQ(fit.parts, 0U);
  EXPECT_EQ(fit.shift_m, Vec3d{});
  EXPECT_EQ(fit_of_points({}, Executor(1)).parts, 0U);
}

TEST(PointFit, SameBitsForAnyNumberOfThreads) {
  const FitPart part = part_of({}, moved_about({}, {0, 0, 0.01}, {0.2, 0.1, 0}));
  const FitMotion one = fit_motion(part.scene, part.rays, {}, Executor(1));
  const FitMotion three = fit_motion(part.scene, part.rays, {}, Executor(3));
  EXPECT_EQ(one.motion.translation, three.motion.translation);
  EXPECT_EQ(one.hits, three.hits);
}

}  // namespace
}  // namespace adasplats::point_fit
