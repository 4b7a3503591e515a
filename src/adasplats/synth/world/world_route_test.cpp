// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/world/world_route.h"

#include <gtest/gtest.h>

#include <cmath>

namespace adasplats {
namespace {

// Oracle: a displacement of d along the normal of the axis has length d and keeps the heading.
TEST(WorldRoute, PlacesBesideTheAxisAreAsFarAsTold) {
  const WorldRoute route(200, {90, 0.05}, Random(1, 2, 3));
  EXPECT_EQ(route.at(0, 0), (Vec3d{0, 0, 0}));
  for (const double s : {0.0, 33.3, 100.0, 199.0}) {
    const Vec3d off = route.at(s, 12) - route.at(s, 0);
    EXPECT_NEAR(length(off), 12, 1e-9);
    EXPECT_NEAR(off.x * std::cos(route.heading(s)) + off.y * std::sin(route.heading(s)), 0, 1e-9);
    EXPECT_NEAR(length(route.at(s + 0.5, 0) - route.at(s, 0)), 0.5, 1e-3);
    // The radius stays above its limit: inner positions are passed only once.
    EXPECT_LT(std::fabs(route.heading(s + 1) - route.heading(s)), 1 / 90.0 + 1e-9);
  }
}

}  // namespace
}  // namespace adasplats
