// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/epsg_units.h"

#include <gtest/gtest.h>

namespace adasplats {
namespace {

// Oracle: names in the EPSG registry, "(ftUS)" and "(ft)" among them.
TEST(EpsgUnits, OfSystemsByTheirCodes) {
  EXPECT_EQ(unit_of_projected_system(2263), 9003);   // NAD83 / New York Long Island (ftUS)
  EXPECT_EQ(unit_of_projected_system(2222), 9002);   // NAD83 / Arizona East (ft)
  EXPECT_EQ(unit_of_projected_system(2992), 9002);   // NAD83 / Oregon GIC Lambert (ft)
  EXPECT_EQ(unit_of_projected_system(6527), 9003);   // NAD83(2011) / New Jersey (ftUS)
  EXPECT_EQ(unit_of_projected_system(32118), 9001);  // NAD83 / New York Long Island
  EXPECT_EQ(unit_of_projected_system(32632), 9001);  // WGS 84 / UTM zone 32N
  EXPECT_EQ(unit_of_projected_system(2154), 9001);   // RGF93 / Lambert-93
  EXPECT_EQ(unit_of_vertical_system(6360), 9003);    // NAVD88 height (ftUS)
  EXPECT_EQ(unit_of_vertical_system(8228), 9002);    // NAVD88 height (ft)
  EXPECT_EQ(unit_of_vertical_system(5703), 9001);    // NAVD88 height
  // Newer than the table.
  EXPECT_EQ(unit_of_projected_system(10480), std::nullopt);
}

TEST(EpsgUnits, LengthsOtherThanTheMetre) {
  EXPECT_EQ(foreign_length_of(9001), std::nullopt);
  EXPECT_EQ(foreign_length_of(9102), std::nullopt);  // degrees
  EXPECT_EQ(foreign_length_of(9002), "feet (0.3048 m)");
  EXPECT_EQ(foreign_length_of(9005), "the unit EPSG 9005");
  EXPECT_EQ(foreign_length_of(9301), "the unit EPSG 9301");
}

}  // namespace
}  // namespace adasplats
