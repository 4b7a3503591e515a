// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/crs.h"

#include <gtest/gtest.h>

#include "adasplats/io/base/files_test.h"

namespace adasplats {
namespace {

const std::string kDatum =
    R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
    R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]])";

/// A transverse Mercator projection as GDAL writes it.
std::string mercator(const std::string& name, const std::string& meridian,
                     const std::string& authority = "") {
  return "PROJCS[\"" + name + "\"," + kDatum +
         ",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],"
         "PARAMETER[\"central_meridian\"," +
         meridian +
         "],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],"
         "PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]" +
         authority + "]";
}
std::string epsg(int code) { return ",AUTHORITY[\"EPSG\",\"" + std::to_string(code) + "\"]"; }

Crs wkt(const std::string& text) { return crs_of_wkt(text); }

Crs keys(const std::vector<std::uint16_t>& entries, const std::vector<double>& doubles = {},
         const std::string& ascii = "") {
  std::vector<std::uint16_t> directory = {1, 1, 0, static_cast<std::uint16_t>(entries.size() / 4)};
  directory.insert(directory.end(), entries.begin(), entries.end());
  return {{}, {directory, doubles, ascii}};
}

const Crs kZone32 = wkt(mercator("WGS 84 / UTM zone 32N", "9", epsg(32632)));
const Crs kZone33 = wkt(mercator("WGS 84 / UTM zone 33N", "15", epsg(32633)));
const Crs kKeys32 = keys({1024, 0, 1, 1, 3072, 0, 1, 32632, 3076, 0, 1, 9001});

std::string with_heights(const Crs& ground, const std::string& heights) {
  return "COMPD_CS[\"both\"," + ground.wkt + "," + heights + "]";
}
const std::string kEgm96 =
    R"(VERT_CS["EGM96 height",VERT_DATUM["EGM96 geoid",2005],UNIT["metre",1],AUTHORITY["EPSG","5773"]])";
const std::string kNavd88 =
    R"(VERT_CS["NAVD88 height",VERT_DATUM["NAVD88",2005],UNIT["metre",1],AUTHORITY["EPSG","5703"]])";

/// Both ways round.
void expect_match(const Crs& a, const Crs& b, CrsMatch expected) {
  EXPECT_EQ(match(a, b), expected) << a.name() << " and " << b.name();
  EXPECT_EQ(match(b, a), expected) << b.name() << " and " << a.name();
}

TEST(CoordinateSystem, NamesAreTheFilesOwn) {
  EXPECT_EQ(Crs().name(), "");
  EXPECT_EQ(kZone32.name(), "EPSG:32632 (WGS 84 / UTM zone 32N)");
  EXPECT_EQ(wkt(with_heights(kZone32, kEgm96)).name(),
            "EPSG:32632+5773 (WGS 84 / UTM zone 32N + EGM96 height)");
  EXPECT_EQ(kKeys32.name(), "EPSG:32632");
  EXPECT_EQ(wkt(mercator("unnamed", "9")).name(), "without a name");
  EXPECT_EQ(wkt(mercator("my site", "9")).name(), "my site");
  EXPECT_EQ(wkt("epsg:25832").name(), "EPSG:25832");
  // Keys of PDAL's 4_6_crop.las: 5103 is NAVD88, EPSG:5703 (GeoTIFF 1.0, 6.3.4.1).
  EXPECT_EQ(keys({1024, 0,    1,    1, 1026, 34737, 8,    0,     3072, 0,
                  1,    2903, 4096, 0, 1,    5103,  4097, 34737, 8,    20},
                 {}, "unknown|NAD83(HARN)|NAVD 88|")
                .name(),
            "EPSG:2903+5703 (NAVD 88)");
}

TEST(CoordinateSystem, BlanksAndUnitsAloneStateNoSystem) {
  EXPECT_TRUE(wkt("").empty());
  EXPECT_TRUE(wkt(std::string(" \n\0\0", 4)).empty());
  EXPECT_TRUE(keys({}).empty());
  // PDAL's 1.2-empty-geotiff-vlrs.las, and padding.
  EXPECT_TRUE(keys({1025, 0,    1,    2, 2052, 0,    1,    9001, 2054, 0,    1, 9102, 2060, 0,
                    1,    9102, 3076, 0, 1,    9001, 4099, 0,    1,    9001, 0, 0,    0,    0})
                  .empty());
  EXPECT_FALSE(kKeys32.empty());
}

TEST(CoordinateSystem, HeightsAloneAreNoHorizontalSystem) {
  const Crs heights = keys({1024, 0, 1, 1, 3076, 0, 1, 32632, 4096, 0, 1, 5030, 4099, 0, 1, 9001});
  EXPECT_EQ(heights.name(), "heights only, no horizontal system: EPSG:5030");
  EXPECT_EQ(wkt(kEgm96).name(), "heights only, no horizontal system: EPSG:5773 (EGM96 height)");
  expect_match(heights, kZone32, CrsMatch::unclear);
  for (const bool is_first : {true, false}) {
    SharedCrs shared;
    if (is_first) shared.add("heights.las", heights);
    shared.add("zone.las", kZone32);
    if (!is_first) shared.add("heights.las", heights);
    EXPECT_EQ(shared.crs(), kZone32);
    EXPECT_NE(shared.warning().find("heights.las"), std::string::npos);
  }
}

TEST(CoordinateSystem, CodesDecideWhereBothHaveSome) {
  expect_match(kZone32, kZone32, CrsMatch::same);
  expect_match(kZone32, kZone33, CrsMatch::different);
  expect_match(kZone32, kKeys32, CrsMatch::same);
  expect_match(kZone33, kKeys32, CrsMatch::different);
  // The same code in WKT 2, under another name.
  const Crs wkt2 = wkt(R"(PROJCRS["UTM 32",BASEGEOGCRS["WGS 84"],CONVERSION["UTM zone 32N"],
                          CS[Cartesian,2],ID["EPSG",32632]])");
  expect_match(kZone32, wkt2, CrsMatch::same);
  expect_match(kZone33, wkt2, CrsMatch::different);
  expect_match(wkt("EPSG:32632"), kZone32, CrsMatch::same);
  expect_match(wkt("EPSG:32632"), wkt("EPSG:32633"), CrsMatch::different);
}

// ESRI's names and texts have no codes.
TEST(CoordinateSystem, UtmZonesAreRecognizedByTheirNames) {
  expect_match(wkt(mercator("WGS_1984_UTM_Zone_32N", "9.0")), kZone32, CrsMatch::same);
  expect_match(wkt(mercator("WGS_1984_UTM_Zone_32N", "9.0")), kZone33, CrsMatch::different);
  expect_match(wkt(mercator("ETRS_1989_UTM_Zone_32N", "9")), wkt("EPSG:25832"), CrsMatch::same);
  expect_match(wkt(mercator("WGS 84 / UTM zone 3S", "-165")), wkt("EPSG:32703"), CrsMatch::same);
  expect_match(keys({3072, 0, 1, 32767, 3073, 34737, 22, 0}, {}, "NAD83 / UTM zone 10N|"),
               keys({3072, 0, 1, 26910}), CrsMatch::same);
}

TEST(CoordinateSystem, WithoutCodesNamesAndNumbersDecide) {
  expect_match(wkt(mercator("site", "9")), wkt(mercator("Site", "9.0")), CrsMatch::same);
  expect_match(wkt(mercator("site", "9")), wkt(mercator("site", "9.5")), CrsMatch::different);
  expect_match(wkt(mercator("site", "9")), wkt(mercator("other", "9")), CrsMatch::different);
  // Without names only the same definition is the same, however it is set.
  const std::string unnamed = mercator("unnamed", "9");
  std::string set = unnamed;
  for (std::size_t at = 0; (at = set.find(",PARAMETER[", at)) != std::string::npos; at += 20)
    set.replace(at, 11, ",\n  PARAMETER (");
  for (std::size_t at = 0; (at = set.find("],\n", at)) != std::string::npos; ++at) set[at] = ')';
  expect_match(wkt(unnamed), wkt(set), CrsMatch::same);
  expect_match(wkt(unnamed), wkt(mercator("unnamed", "9.5")), CrsMatch::different);
  // The same citation with other numbers, and a base that two projections share.
  const auto local = [](double meridian) {
    return keys(
        {1024, 0, 1, 1, 1026, 34737, 5, 0, 2048, 0, 1, 4326, 3072, 0, 1, 32767, 3080, 34736, 1, 0},
        {meridian}, "grid|");
  };
  expect_match(local(9), local(9), CrsMatch::same);
  expect_match(local(9), local(9.5), CrsMatch::different);
  expect_match(wkt("+proj=tmerc +lat_0=5"), wkt("+proj=tmerc +lat_0=-5"), CrsMatch::different);
}

TEST(CoordinateSystem, MissingPartsAreUnclear) {
  expect_match(Crs(), Crs(), CrsMatch::same);
  expect_match(Crs(), kZone32, CrsMatch::unclear);
  const Crs egm96 = wkt(with_heights(kZone32, kEgm96)),
            navd88 = wkt(with_heights(kZone32, kNavd88));
  expect_match(egm96, egm96, CrsMatch::same);
  expect_match(egm96, kZone32, CrsMatch::unclear);
  expect_match(egm96, navd88, CrsMatch::different);
  expect_match(egm96, wkt(with_heights(kZone33, kEgm96)), CrsMatch::different);
}

TEST(CoordinateSystem, SurvivesComments) {
  EXPECT_TRUE(crs_comments({}).empty());
  for (const Crs& crs :
       {kZone32, wkt(with_heights(kZone32, kEgm96)), kKeys32,
        keys({1024, 0, 1, 1, 1026, 34737, 6, 0, 3078, 34736, 1, 1}, {0.1, -1e300}, " grid|")}) {
    const std::vector<std::string> comments = crs_comments(crs);
    EXPECT_EQ(crs_of_comments("a.ply", comments), crs);
  }
  for (const std::string& comment : crs_comments(wkt(mercator("two\nlines", "9"))))
    EXPECT_EQ(comment.find('\n'), std::string::npos);
  // In lines that rply takes, whatever readers do with blanks at their ends.
  for (std::size_t blanks = 0; blanks < 40; ++blanks) {
    const std::string name = std::string(850, 'a') + std::string(blanks, ' ') + "b c d e f g h";
    const Crs crs = wkt(mercator(name, "9"));
    const std::vector<std::string> comments = crs_comments(crs);
    ASSERT_GE(comments.size(), 2U);
    for (const std::string& comment : comments) {
      EXPECT_LT(comment.size(), 1000U);
      EXPECT_NE(comment.back(), ' ');
    }
    EXPECT_EQ(crs_of_comments("a.ply", comments), crs);
  }
  GeoKeys many{{1, 1, 0, 100}, {}, std::string(2000, 'x')};
  for (std::uint16_t k = 0; k < 400; ++k) many.directory.push_back(3072);
  many.doubles.assign(200, 1.0 / 3);
  EXPECT_EQ(crs_of_comments("a.ply", crs_comments({{}, many})).keys, many);
  const std::vector<std::string> broken = {"adasplats.crs_keys 1 1 x"};
  expect_error(ErrorKind::data, {"a.ply", "x"}, [&] { crs_of_comments("a.ply", broken); });
}

TEST(SharedCoordinateSystem, RejectsMixesAndReportsMissingSystems) {
  SharedCrs one;
  one.add("a.las", kZone32);
  one.add("b.las", kKeys32);
  EXPECT_EQ(one.warning(), "");
  one.add("c.ply", {});
  EXPECT_NE(one.warning().find("no coordinate system in 1 of 3 inputs (c.ply)"), std::string::npos);
  EXPECT_NE(one.warning().find("EPSG:32632"), std::string::npos);
  one.add("d.laz", wkt(with_heights(kZone32, kEgm96)));
  EXPECT_NE(one.warning().find("no vertical coordinate system in 2 of 4 inputs (a.las, ...)"),
            std::string::npos);
  EXPECT_EQ(one.crs().name(), "EPSG:32632+5773 (WGS 84 / UTM zone 32N + EGM96 height)");
  expect_error(ErrorKind::data, {"e.laz", "d.laz", "EPSG:32632+5703", "EPSG:32632+5773"},
               [&] { one.add("e.laz", wkt(with_heights(kZone32, kNavd88))); });
  expect_error(ErrorKind::data, {"f.las", "EPSG:32633", "d.laz", "EPSG:32632"},
               [&] { one.add("f.las", kZone33); });
  SharedCrs silent;
  silent.add("a.ply", {});
  silent.add("b.ply", {});
  EXPECT_EQ(silent.warning(), "");
  EXPECT_TRUE(silent.crs().empty());
}

}  // namespace
}  // namespace adasplats
