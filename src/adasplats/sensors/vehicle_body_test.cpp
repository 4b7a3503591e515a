// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/vehicle_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/constants.h"

namespace adasplats {
namespace {

Vec3f towards(double azimuth_deg) {
  return {static_cast<float>(2 * std::cos(azimuth_deg * kDegree)),
          static_cast<float>(2 * std::sin(azimuth_deg * kDegree)), -1};
}

// Oracle: half degrees counted by hand.
TEST(VehicleBody, ColumnsAreHalfDegreesFromTheRear) {
  EXPECT_EQ(body_column(towards(-179.9)), 0U);
  EXPECT_EQ(body_column(towards(-179.4)), 1U);
  EXPECT_EQ(body_column(towards(0.1)), 360U);
  EXPECT_EQ(body_column(towards(90.6)), 541U);
  EXPECT_EQ(body_column(towards(179.9)), 719U);
  EXPECT_EQ(body_column({-1, 0, 0}), 719U);  // half a turn itself
  for (const std::uint32_t column : {0U, 1U, 360U, 719U})
    EXPECT_EQ(body_column(towards(body_azimuth_deg(column) + 0.25)), column);
}

TEST(VehicleBody, FindsTheCellOfARingAndADirection) {
  const VehicleBody body = {{{1, 5, 1, 1, 0}, {1, 360, 1, 2, 0}, {2, 5, 1, 3, 0}}};
  EXPECT_EQ(body.find(1, towards(0.2)), 1U);
  EXPECT_EQ(body.find(1, towards(0.7)), 3U);
  EXPECT_EQ(body.find(2, towards(0.2)), 3U);
  EXPECT_EQ(body.find(2, towards(-177.3)), 2U);
  EXPECT_EQ(body.find(0, towards(-177.3)), 3U);
  EXPECT_EQ(VehicleBody{}.find(0, towards(0)), 0U);
}

}  // namespace
}  // namespace adasplats
