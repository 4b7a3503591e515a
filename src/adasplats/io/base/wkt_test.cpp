// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/wkt.h"

#include <gtest/gtest.h>

namespace adasplats {
namespace {

TEST(Wkt, NodesValuesAndQuotes) {
  const WktNode node = parse_wkt("A[\"x, [y]\", 1 ,\n B(2),C[ ],3] rest[1]");
  EXPECT_EQ(node.keyword, "a");
  EXPECT_EQ(node.values, (std::vector<std::string>{"x, [y]", "1", "3"}));
  ASSERT_EQ(node.nodes.size(), 2U);
  EXPECT_EQ(node.nodes[0], (WktNode{"b", {"2"}, {}}));
  EXPECT_EQ(node.nodes[1], (WktNode{"c", {}, {}}));
  EXPECT_EQ(node.find({"c", "d"}), &node.nodes[1]);
  EXPECT_EQ(node.find({"d"}), nullptr);
}

TEST(Wkt, BrokenTexts) {
  for (const char* text : {"", "]", "][", ",", "words", "\"[\""})
    EXPECT_EQ(parse_wkt(text).keyword, "") << text;
  // What is cut has what comes before.
  EXPECT_EQ(parse_wkt("A[1,B[2"), parse_wkt("A[1,B[]]"));
  EXPECT_EQ(parse_wkt("A[1,B[2,"), parse_wkt("A[1,B[2]]"));
}

// Nodes of nodes without end do not take the stack.
TEST(Wkt, DeepTextsAreCut) {
  std::string deep;
  for (int k = 0; k < 100000; ++k) deep += "A[1,";
  WktNode node = parse_wkt(deep);
  int depth = 1;
  for (const WktNode* at = &node; !at->nodes.empty(); at = &at->nodes.front()) ++depth;
  EXPECT_EQ(depth, 32);
  // What follows them is at its place all the same.
  std::string closed = deep + std::string(99999, ']') + ",B[2]]";
  node = parse_wkt(closed);
  EXPECT_NE(node.find({"b"}), nullptr);
}

}  // namespace

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

TEST(WktUnits, BrokenTextsHaveNoUnits) {
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
