// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/wkt_units.h"

#include <gtest/gtest.h>

namespace adasplats {
namespace {

const std::string kGeographic =
    R"(GEOGCS["NAD83",DATUM["x",SPHEROID["GRS 1980",6378137,298.25]],UNIT["degree",0.01745]])";

std::string projected(const std::string& unit) {
  return R"(PROJCS["A [name], (with) brackets",)" + kGeographic +
         R"(,PROJECTION["Lambert"],PARAMETER["false_easting",1312335.9],)" + unit +
         R"(,AXIS["X",EAST]])";
}

// Oracle: texts as GDAL writes them.
TEST(WktUnits, OfWkt1) {
  EXPECT_EQ(foreign_units_of_wkt(projected(R"(UNIT["metre",1,AUTHORITY["EPSG","9001"]])")),
            std::nullopt);
  EXPECT_EQ(foreign_units_of_wkt(projected(R"(UNIT["foot",0.3048,AUTHORITY["EPSG","9002"]])")),
            "x and y in foot (0.3048 m), by the WKT");
  EXPECT_EQ(
      foreign_units_of_wkt(R"(COMPD_CS["both",)" + projected(R"(UNIT["metre",1])") +
                           R"(,VERT_CS["height",VERT_DATUM["d",2005], UNIT [ "ft" , 0.3048 ]]])"),
      "z in ft (0.3048 m), by the WKT");
  EXPECT_EQ(foreign_units_of_wkt(kGeographic), std::nullopt);
}

TEST(WktUnits, OfWkt2) {
  const auto text = [](const std::string& unit) {
    return R"wkt(PROJCRS["x",BASEGEOGCRS["y",DATUM["d",ELLIPSOID["e",6378137,298,LENGTHUNIT["mile",1609]]],
      PRIMEM["G",0,ANGLEUNIT["degree",0.0174]]],CONVERSION["c",METHOD["m"],
      PARAMETER["Easting",1312335.9,LENGTHUNIT["foot",0.3048]]],CS[Cartesian,2],
      AXIS["(E)",east,ORDER[1],LENGTHUNIT[)wkt" +
           unit + "]]]";
  };
  EXPECT_EQ(foreign_units_of_wkt(text(R"("metre",1)")), std::nullopt);
  EXPECT_EQ(foreign_units_of_wkt(text(R"("US survey foot",0.304800609601219)")),
            "x and y in US survey foot (0.304800609601219 m), by the WKT");
}

TEST(WktUnits, BrokenTextsSayNothing) {
  for (const char* text : {"", "]", "][", "UNIT[\"foot\",0.3048]", "PROJCS[", "PROJCS[UNIT[]]",
                           "PROJCS[UNIT[\"foot\"]]", "PROJCS[UNIT[\"foot\",x]]", "PROJCS[\""})
    EXPECT_EQ(foreign_units_of_wkt(text), std::nullopt) << text;
}

TEST(WktUnits, OfSystemsOfAngles) {
  EXPECT_EQ(geographic_system_of_wkt(kGeographic), "GEOGCS[\"NAD83\"");
  EXPECT_EQ(geographic_system_of_wkt(projected(R"(UNIT["metre",1])")), std::nullopt);
  EXPECT_EQ(geographic_system_of_wkt(R"(GEOCCS["WGS 84"])"), std::nullopt);
  EXPECT_EQ(geographic_system_of_wkt(""), std::nullopt);
}

}  // namespace
}  // namespace adasplats
