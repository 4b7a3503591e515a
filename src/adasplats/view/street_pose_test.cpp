// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/street_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace adasplats {
namespace {

/// A street along a line through (0, 0) that turns by `yaw_rad` from x, 80 m long and 8 m wide at
/// height 5 m, between walls 6 m high.
std::vector<Vec3f> street(float yaw_rad) {
  std::vector<Vec3f> points;
  const auto add = [&](float along, float across, float z) {
    points.push_back({along * std::cos(yaw_rad) - across * std::sin(yaw_rad),
                      along * std::sin(yaw_rad) + across * std::cos(yaw_rad), z});
  };
  for (float along = -40; along < 40; along += 0.25F) {
    for (float across = -4; across <= 4; across += 0.25F) add(along, across, 5);
    for (float z = 5; z < 11; z += 0.25F) {
      add(along, -4.2F, z);
      add(along, 4.2F, z);
    }
  }
  return points;
}

// Oracle: the geometry of the street.
TEST(StreetPose, IsOnTheStreetAndFacesAlongIt) {
  for (const float yaw_rad : {0.0F, 0.6F, 1.5F, -1.0F}) {
    const std::vector<Vec3f> points = street(yaw_rad);
    const auto pose = street_pose(points, 1.8);
    ASSERT_TRUE(pose);
    const double c = std::cos(static_cast<double>(yaw_rad));
    const double s = std::sin(static_cast<double>(yaw_rad));
    const Vec3d at = pose->translation;
    EXPECT_NEAR(at.z, 6.8, 1e-6);
    EXPECT_LT(std::fabs(-s * at.x + c * at.y), 3) << "between the walls";
    const Vec3d ahead = pose->rotation * Vec3d{1, 0, 0};
    EXPECT_GT(std::fabs(c * ahead.x + s * ahead.y), std::cos(0.15)) << yaw_rad;
  }
}

// Oracle: the same scene without an outlier 50 km away.
TEST(StreetPose, OutliersHaveNoInfluence) {
  std::vector<Vec3f> points = street(0);
  const auto before = street_pose(points, 1.8);
  points.push_back({50'000, -50'000, 3});
  const auto after = street_pose(points, 1.8);
  ASSERT_TRUE(before && after);
  EXPECT_LT(length(before->translation - after->translation), 1.5);
}

TEST(StreetPose, NothingWithoutOpenGround) {
  EXPECT_FALSE(street_pose({}, 1.8));
  const std::vector<Vec3f> one = {{1, 2, 3}};
  EXPECT_FALSE(street_pose(one, 1.8));
  std::vector<Vec3f> wall;
  for (float z = 0; z < 2; z += 0.05F)
    for (float x = 0; x < 5; x += 0.05F) wall.push_back({x, 0, z});
  EXPECT_FALSE(street_pose(wall, 1.8));
}

}  // namespace
}  // namespace adasplats
