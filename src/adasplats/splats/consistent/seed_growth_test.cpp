// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/seed_growth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "adasplats/splats/consistent/seed_disk.h"

namespace adasplats {
namespace {

// Oracle: the angle, for directions that are not on a border of two sectors.
TEST(SixteenthOfTurn, IsThatOfTheAngle) {
  for (int i = 0; i < 3600; ++i) {
    if (i % 225 == 0) continue;
    const double angle = i * std::numbers::pi / 1800;
    for (const double size : {1e-6, 1.0, 1e6}) {
      EXPECT_EQ(sixteenth_of_turn(static_cast<float>(size * std::cos(angle)),
                                  static_cast<float>(size * std::sin(angle))),
                i / 225)
          << angle;
    }
  }
}

// One ring on a road near the sensor: its cells have others on two sides alone, 5 cm apart, where
// beams are 1 cm from one another.
TEST(SeedRadius, ACellInALineIsNotIsolated) {
  const ConsistentOptions options;
  ASSERT_EQ(options.cell_m, 0.05);
  EXPECT_FLOAT_EQ(seed_radius(0.2, 0.03, options), 0.03F);
  EXPECT_FLOAT_EQ(seed_radius(0.249, 0.03, options), 0.03F);
  EXPECT_EQ(seed_radius(0.3, 0.03, options), 0);
  EXPECT_FLOAT_EQ(seed_radius(0.3, 0.15, options), 0.15F);
}

// Oracle: symmetry. On lattices seeds are exactly on axes and diagonals, which begin a sector.
TEST(SixteenthOfTurn, AQuarterTurnIsFourSectors) {
  EXPECT_EQ(sixteenth_of_turn(3, 0), 0);
  EXPECT_EQ(sixteenth_of_turn(3, -0.0F), 0);
  EXPECT_EQ(sixteenth_of_turn(2, 2), 2);
  EXPECT_EQ(sixteenth_of_turn(-3, 0.0F), 8);
  EXPECT_EQ(sixteenth_of_turn(-3, -0.0F), 8);
  for (int y = -20; y <= 20; ++y) {
    for (int x = -20; x <= 20; ++x) {
      if (x == 0 && y == 0) continue;
      const auto a = static_cast<float>(x), b = static_cast<float>(y);
      EXPECT_EQ(sixteenth_of_turn(-b, a), (sixteenth_of_turn(a, b) + 4) % 16) << x << " " << y;
    }
  }
}

TEST(SectorReach, SectorsAreWholeSixteenths) {
  for (const int sectors : {0, 1, 2, 4, 8, 16}) EXPECT_TRUE(SectorReach::is_valid_count(sectors));
  for (const int sectors : {-1, 3, 5, 12, 15, 17, 32})
    EXPECT_FALSE(SectorReach::is_valid_count(sectors));
  const Disk disk = {{0, 0, 0}, 1, {0, 0, 1}};
  for (const int sectors : {1, 2, 4, 8, 16}) {
    SectorReach reach(disk, sectors);
    for (int i = 0; i < sectors; ++i) {
      EXPECT_EQ(reach.min_m(), 0.0F);
      const double angle = (i + 0.5) * 2 * std::numbers::pi / sectors;
      reach.add(vec_cast<float>(Vec3d{std::cos(angle), std::sin(angle), 0}), 2);
    }
    EXPECT_EQ(reach.min_m(), 2.0F);
  }
}

}  // namespace
}  // namespace adasplats
