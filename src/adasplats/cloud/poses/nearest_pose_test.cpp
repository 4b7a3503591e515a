// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/nearest_pose.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

std::size_t brute_force(const Trajectory& trajectory, double x, double y) {
  std::size_t best = 0;
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Vec3d p = trajectory[i].world_from_sensor.translation;
    const double distance = (x - p.x) * (x - p.x) + (y - p.y) * (y - p.y);
    if (distance < best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  return best;
}

Trajectory poses_at(const std::vector<Vec3d>& positions) {
  Trajectory trajectory;
  for (const Vec3d p : positions)
    trajectory.push_back({static_cast<double>(trajectory.size()), {{}, p}});
  return trajectory;
}

void expect_as_brute_force(const Trajectory& trajectory, double reach) {
  const NearestPose nearest(trajectory);
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Random random(7, 0, i);
    const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
    EXPECT_EQ(nearest.find(x, y), brute_force(trajectory, x, y));
  }
}

TEST(NearestPose, NoPosesOnePoseEqualPoses) {
  EXPECT_THROW(NearestPose(Trajectory{}), std::logic_error);
  EXPECT_EQ(NearestPose(poses_at({{1, 2, 3}})).find(-5, 9), 0U);
  EXPECT_EQ(NearestPose(poses_at(std::vector<Vec3d>(100, {1, 2, 3}))).find(-5, 9), 0U);
}

TEST(NearestPose, HeightDoesNotCount) {
  EXPECT_EQ(NearestPose(poses_at({{1, 0, 1000}, {2, 0, 0}})).find(0, 0), 0U);
}

TEST(NearestPose, AsBruteForceOnACurveAndWithTies) {
  std::vector<Vec3d> curve, grid;
  for (int i = 0; i < 777; ++i) {
    const double t = 0.02 * i;
    curve.push_back({50 * std::cos(t), 30 * std::sin(1.7 * t), t});
    grid.push_back({static_cast<double>(i % 20), static_cast<double>((i * 7) % 13), 0});
  }
  expect_as_brute_force(poses_at(curve), 200);
  const Trajectory ties = poses_at(grid);
  expect_as_brute_force(ties, 30);
  // On the middles between grid places several poses are exactly as near.
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(NearestPose(ties).find(0.5 * i, 6.5), brute_force(ties, 0.5 * i, 6.5));
}

}  // namespace
}  // namespace adasplats
