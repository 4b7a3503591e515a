// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "adasplats/segment/pyramid/pyramid.h"

namespace adasplats {
namespace {

TEST(HeightAboveGround, FollowsSlopes) {
  std::vector<Vec3f> points;
  for (int x = 0; x < 400; ++x)
    for (int y = 0; y < 40; ++y)
      points.push_back(
          {0.1F * static_cast<float>(x), static_cast<float>(y), 0.002F * static_cast<float>(x)});
  points.push_back({20, 20, 2.4F});
  const std::vector<float> heights = heights_above_ground(points);
  EXPECT_NEAR(heights.back(), 2.0F, 0.15F);
  for (const float height_m : heights) EXPECT_LT(height_m, 2.2F);
  EXPECT_TRUE(heights_above_ground({}).empty());
}

}  // namespace
}  // namespace adasplats
