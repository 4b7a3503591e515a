// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/continued_motion.h"

#include <gtest/gtest.h>

namespace adasplats {
namespace {

// Oracle: an even motion along a circle, in closed form.
TEST(ContinuedMotion, GoesOnAlongACircle) {
  const auto pose_at = [](double s) {
    return RigidTransform{rotation_from_yaw_pitch_roll(s, 0, 0), {std::sin(s), -std::cos(s), 0}};
  };
  const Trajectory longer =
      with_motion_continued({{0, pose_at(0)}, {0.1, pose_at(0.1)}, {0.2, pose_at(0.2)}}, 0.1);
  ASSERT_EQ(longer.size(), 5U);
  for (const TimedPose& pose : longer) {
    const RigidTransform expected = pose_at(pose.time_s);
    EXPECT_LT(length(pose.world_from_sensor.translation - expected.translation), 1e-9);
    EXPECT_LT(angle_between(pose.world_from_sensor.rotation, expected.rotation), 1e-7);
  }
  EXPECT_NEAR(longer.front().time_s, -0.1, 1e-12);
  EXPECT_NEAR(longer.back().time_s, 0.3, 1e-12);
}

TEST(ContinuedMotion, ASinglePoseStays) {
  EXPECT_EQ(with_motion_continued({{7, {}}}, 0.1).size(), 1U);
  EXPECT_TRUE(with_motion_continued({}, 0.1).empty());
}

}  // namespace
}  // namespace adasplats
