// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

using io_test::bytes_of;
using io_test::put;
using io_test::values_of;
using Doubles = std::vector<double>;
using Notes = std::vector<ReaderNote>;

/// A header as the specification lays it out, with nothing between it and the points.
std::string las_header(int minor, int format, int record_bytes, std::uint32_t points) {
  const std::size_t bytes = minor == 4 ? 375 : (minor == 3 ? 235 : 227);
  std::string header(bytes, '\0');
  for (std::size_t k = 0; k < 4; ++k) header[k] = "LASF"[k];
  put(header, 24, std::uint8_t{1});
  put(header, 25, static_cast<std::uint8_t>(minor));
  put(header, 94, static_cast<std::uint16_t>(bytes));
  put(header, 96, static_cast<std::uint32_t>(bytes));
  put(header, 104, static_cast<std::uint8_t>(format));
  put(header, 105, static_cast<std::uint16_t>(record_bytes));
  put(header, 107, points);
  for (const std::size_t axis : {0U, 1U, 2U}) {
    put(header, 131 + 8 * axis, 0.01);
    put(header, 155 + 8 * axis, 1000.0 * static_cast<double>(axis));
  }
  return header;
}

/// A record of any format whose first 12 bytes are x, y, z and whose other bytes count up from 0
/// at byte 12, so that the values show their offsets.
std::string las_record(std::size_t bytes, std::int32_t x, std::int32_t y, std::int32_t z) {
  std::string record = bytes_of(x) + bytes_of(y) + bytes_of(z);
  while (record.size() < bytes) record += static_cast<char>(record.size());
  return record;
}

Table read_las_bytes(const std::string& content, bool salvage = false) {
  const TemporaryFolder folder;
  return read_las(folder.write("file.las", content), {salvage});
}

void expect_las_error(const std::string& content, const std::vector<std::string>& parts) {
  expect_error(ErrorKind::data, parts, [&] { read_las_bytes(content); });
}

double u16_at(int offset) { return offset + 256.0 * (offset + 1); }

/// The f64 whose bytes are offset, offset + 1, ...
double f64_at(int offset) {
  std::string bytes;
  for (int k = 0; k < 8; ++k) bytes += static_cast<char>(offset + k);
  double value = 0;
  std::memcpy(&value, bytes.data(), 8);
  return value;
}

// Offsets of ASPRS LAS 1.4 R15, tables 7 to 17, written down here a second time.
TEST(Las, FieldsOfEveryPointFormat) {
  struct Expected {
    int format, bytes, minor, gps_time, colour;
  };
  for (const Expected& e : std::vector<Expected>{{0, 20, 0, 0, 0},
                                                 {1, 28, 1, 20, 0},
                                                 {2, 26, 2, 0, 20},
                                                 {3, 34, 2, 20, 28},
                                                 {4, 57, 3, 20, 0},
                                                 {5, 63, 3, 20, 28},
                                                 {6, 30, 4, 22, 0},
                                                 {7, 36, 4, 22, 30},
                                                 {8, 38, 4, 22, 30},
                                                 {9, 59, 4, 22, 0},
                                                 {10, 67, 4, 22, 30}}) {
    SCOPED_TRACE(e.format);
    const auto bytes = static_cast<std::size_t>(e.bytes) + 3;  // with extra bytes
    std::string records = las_record(bytes, 1, -2, 2147483647) + las_record(bytes, 4, 5, 6);
    if (e.format >= 6)  // all flags but withheld
      for (const std::size_t row : {0U, 1U}) put(records, row * bytes + 15, std::uint8_t{0x0b});
    const Table table = read_las_bytes(las_header(e.minor, e.format, e.bytes + 3, 2) + records);
    EXPECT_EQ(values_of(table, "x"), (Doubles{1 * 0.01, 4 * 0.01}));
    EXPECT_EQ(values_of(table, "y"), (Doubles{-2 * 0.01 + 1000, 5 * 0.01 + 1000}));
    EXPECT_EQ(values_of(table, "z")[0], 2147483647 * 0.01 + 2000);
    EXPECT_EQ(values_of(table, "intensity")[1], u16_at(12));
    const bool wide = e.format >= 6;
    EXPECT_EQ(values_of(table, "return_number")[0], wide ? 14 : (14 & 7));
    EXPECT_EQ(values_of(table, "number_of_returns")[0], wide ? 0 : (14 >> 3));
    EXPECT_EQ(values_of(table, "classification")[0], wide ? 16 : 15);
    EXPECT_EQ(values_of(table, "user_data")[0], 17);
    EXPECT_EQ(values_of(table, "point_source_id")[0], u16_at(wide ? 20 : 18));
    ASSERT_EQ(table.find("gps_time") != nullptr, e.gps_time != 0);
    if (e.gps_time != 0) {
      EXPECT_EQ(values_of(table, "gps_time")[1], f64_at(e.gps_time));
    }
    ASSERT_EQ(table.find("blue") != nullptr, e.colour != 0);
    if (e.colour != 0) {
      EXPECT_EQ(values_of(table, "red")[1], u16_at(e.colour));
      EXPECT_EQ(values_of(table, "green")[1], u16_at(e.colour + 2));
      EXPECT_EQ(values_of(table, "blue")[1], u16_at(e.colour + 4));
    }
  }
}

TEST(Las, ClassificationFlagsAreNotPartOfTheClass) {
  std::string record = las_record(20, 0, 0, 0);
  put(record, 15, std::uint8_t{0x62});
  EXPECT_EQ(values_of(read_las_bytes(las_header(2, 0, 20, 1) + record), "classification"),
            Doubles{2});
}

// Oracle: tables 8 and 17 of the specification: bit 7 of the classification, bit 2 of the flags.
TEST(Las, WithheldPointsAreLeftOut) {
  for (const int format : {0, 6}) {
    const std::size_t bytes = (format == 0 ? 20U : 30U) + 1;
    std::string records;
    for (const int x : {1, 2, 3}) records += las_record(bytes, x, 0, 0);
    for (std::size_t row = 0; row < 3; ++row) put(records, row * bytes + 15, std::uint8_t{0});
    put(records, bytes + 15, static_cast<std::uint8_t>(format == 0 ? 0x82 : 0x04));
    const std::string header = las_header(4, format, static_cast<int>(bytes), 3);
    const Table table = read_las_bytes(header + records);
    EXPECT_EQ(table.rows, 2U);
    EXPECT_EQ(values_of(table, "x"), (Doubles{0.01, 0.03}));
    EXPECT_EQ(table.notes, (Notes{{NoteKind::withheld, "1 of 3 points"}}));
    for (const std::size_t row : {0U, 2U})
      put(records, row * bytes + 15, static_cast<std::uint8_t>(format == 0 ? 0x80 : 0x04));
    EXPECT_EQ(read_las_bytes(header + records).rows, 0U);
  }
}

// Fault 21.
/// A variable length record.
std::string las_vlr(const std::string& user, std::uint16_t number, const std::string& content) {
  std::string record(54, '\0');
  for (std::size_t k = 0; k < user.size(); ++k) record[2 + k] = user[k];
  put(record, 18, number);
  put(record, 20, static_cast<std::uint16_t>(content.size()));
  return record + content;
}

/// A file of one point with extra bytes and the given records.
std::string las_with(const std::string& records, std::uint32_t count, std::size_t extra_bytes) {
  const std::size_t bytes = 20 + extra_bytes;
  std::string header = las_header(2, 0, static_cast<int>(bytes), 1);
  put(header, 96, static_cast<std::uint32_t>(header.size() + records.size()));
  put(header, 100, count);
  return header + records + las_record(bytes, 1, 2, 3);
}

/// Table 24: type, options and name.
std::string extra_descriptor(std::uint8_t type, std::uint8_t options, const std::string& name) {
  std::string descriptor(192, '\0');
  put(descriptor, 2, type);
  put(descriptor, 3, options);
  for (std::size_t k = 0; k < name.size(); ++k) descriptor[4 + k] = name[k];
  return descriptor;
}

// Oracle: table 24 of the specification.
TEST(Las, AttributesInExtraBytes) {
  std::string scaled = extra_descriptor(4, 0x18, "height");
  put(scaled, 112, 0.5);
  put(scaled, 136, 100.0);
  const std::string fields = extra_descriptor(0, 3, "nothing") + extra_descriptor(3, 0, "label") +
                             extra_descriptor(13, 0, "pair") + scaled +
                             extra_descriptor(10, 0, "beyond the record");
  // 3 bytes of nothing, u16, two u16, i16, and one byte that nobody describes.
  const Table table =
      read_las_bytes(las_with(las_vlr("LASF_Spec", 4, fields), 1, 3 + 2 + 4 + 2 + 1));
  EXPECT_EQ(values_of(table, "label"), Doubles{u16_at(23)});
  EXPECT_EQ(values_of(table, "height"), Doubles{0.5 * u16_at(29) + 100});
  EXPECT_EQ(table.find("pair"), nullptr);
  EXPECT_EQ(table.find("beyond the record"), nullptr);
  EXPECT_EQ(table.columns.back().name, "height");
}

// ASPRS LAS 1.4 R15, table 4.
TEST(Las, TheClockOfTimesIsNoted) {
  std::string file = las_with(las_vlr("other", 1, "x"), 1, 0);
  EXPECT_TRUE(read_las_bytes(file).notes.empty());
  put(file, 6, std::uint16_t{17});
  EXPECT_EQ(read_las_bytes(file).notes, (Notes{{NoteKind::adjusted_gps, ""}}));
}

TEST(Las, LongitudesAndLatitudesAreNoted) {
  const auto notes = [](const std::string& record) {
    return read_las_bytes(las_with(record, 1, 0)).notes;
  };
  const auto keys = [](std::uint16_t model) {
    std::string directory;
    for (const int value : {1, 1, 0, 1, 1024, 0, 1, 0})
      directory += bytes_of(static_cast<std::uint16_t>(value));
    put(directory, 14, model);
    return las_vlr("LASF_Projection", 34735, directory);
  };
  EXPECT_EQ(notes(keys(2)), (Notes{{NoteKind::geographic, "GTModelType 2, geographic"}}));
  EXPECT_TRUE(notes(keys(1)).empty());
  const auto text = [](const std::string& wkt) { return las_vlr("LASF_Projection", 2112, wkt); };
  EXPECT_EQ(notes(text("GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\"]]")),
            (Notes{{NoteKind::geographic, "GEOGCS[\"WGS 84\""}}));
  EXPECT_TRUE(notes(text("PROJCS[\"UTM 31N\",GEOGCS[\"WGS 84\"]]")).empty());
  EXPECT_TRUE(notes(text("GEOCCS[\"ECEF\"]")).empty());
  EXPECT_TRUE(notes(las_vlr("other", 2112, "GEOGCS[\"x\"]")).empty());
}

// Oracle: the units' numbers in GeoTIFF 1.0, section 6.3.1.3.
TEST(Las, UnitsOtherThanTheMetreAreNoted) {
  const auto notes = [](int key, int unit) {
    std::string directory;
    for (const int value : {1, 1, 0, 2, 1024, 0, 1, 1, key, 0, 1, unit})
      directory += bytes_of(static_cast<std::uint16_t>(value));
    return read_las_bytes(las_with(las_vlr("LASF_Projection", 34735, directory), 1, 0)).notes;
  };
  const auto both = [](int system, int unit) {
    std::string directory;
    for (const int value : {1, 1, 0, 2, 3072, 0, 1, system, 3076, 0, 1, unit})
      directory += bytes_of(static_cast<std::uint16_t>(value));
    return read_las_bytes(las_with(las_vlr("LASF_Projection", 34735, directory), 1, 0)).notes;
  };
  const auto not_metres = [](const char* what) { return Notes{{NoteKind::not_metres, what}}; };
  EXPECT_TRUE(both(2263, 9001).empty());  // a stated unit has precedence
  EXPECT_EQ(both(2263, 9003).size(), 1U);
  for (const int key : {3076, 4099})
    for (const int unit : {9001, 0, 32767}) EXPECT_TRUE(notes(key, unit).empty());
  EXPECT_EQ(notes(3076, 9002),
            not_metres("x and y in feet (0.3048 m), by GeoTIFF key 3076 = 9002"));
  EXPECT_EQ(notes(4099, 9003),
            not_metres("z in US survey feet (1200/3937 m), by GeoTIFF key 4099 = 9003"));
  EXPECT_EQ(notes(3076, 9005),
            not_metres("x and y in the unit EPSG 9005, by GeoTIFF key 3076 = 9005"));
  // Systems by their codes alone (EPSG registry).
  EXPECT_EQ(notes(3072, 2263), not_metres("x and y in US survey feet (1200/3937 m), by EPSG:2263"));
  EXPECT_EQ(notes(4096, 8228), not_metres("z in feet (0.3048 m), by EPSG:8228"));
  EXPECT_EQ(notes(3072, 10480),
            (Notes{{NoteKind::unknown_unit, "x and y in the unit of EPSG:10480"}}));
  for (const int metres : {32632, 2154, 0, 32767}) EXPECT_TRUE(notes(3072, metres).empty());
  const std::string wkt = "PROJCS[\"x\",GEOGCS[\"y\",UNIT[\"degree\",0.017]],UNIT[\"ft\",0.3048]]";
  EXPECT_EQ(read_las_bytes(las_with(las_vlr("LASF_Projection", 2112, wkt), 1, 0)).notes,
            not_metres("x and y in ft (0.3048 m), by the WKT"));
}

const std::string kWktOfZone32 = "PROJCS[\"WGS 84 / UTM zone 32N\",AUTHORITY[\"EPSG\",\"32632\"]]";
const std::string kWktOfZone33 = "PROJCS[\"WGS 84 / UTM zone 33N\",AUTHORITY[\"EPSG\",\"32633\"]]";

std::string utm_keys(int code) {
  std::string directory;
  for (const int value : {1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, code, 0, 0, 0, 0})
    directory += bytes_of(static_cast<std::uint16_t>(value));
  return las_vlr("LASF_Projection", 34735, directory);
}

// Oracle: table 4 of the specification, bit 4.
TEST(Las, TheCoordinateSystemIsTheTextOrTheKeys) {
  const std::string text = las_vlr("LASF_Projection", 2112, kWktOfZone32 + std::string(3, '\0'));
  EXPECT_TRUE(read_las_bytes(las_with(las_vlr("other", 2112, kWktOfZone32), 1, 0)).crs.empty());
  EXPECT_TRUE(read_las_bytes(las_with(las_vlr("LASF_Projection", 2112, " \n"), 1, 0)).crs.empty());
  EXPECT_EQ(read_las_bytes(las_with(text, 1, 0)).crs.wkt, kWktOfZone32);
  EXPECT_EQ(read_las_bytes(las_with(utm_keys(32633), 1, 0)).crs.name(), "EPSG:32633");
  std::string both = las_with(text + utm_keys(32633), 2, 0);
  EXPECT_EQ(read_las_bytes(both).crs.name(), "EPSG:32633");
  // Three keys of four numbers each and those of the whole; padding is none.
  EXPECT_EQ(read_las_bytes(both).crs.keys.directory.size(), 12U);
  put(both, 6, std::uint16_t{1 << 4});
  EXPECT_EQ(read_las_bytes(both).crs.name(), "EPSG:32632 (WGS 84 / UTM zone 32N)");
  const std::string doubles = las_vlr("LASF_Projection", 34736, bytes_of(9.5) + bytes_of(1.0));
  const std::string ascii = las_vlr("LASF_Projection", 34737, std::string("grid|\0\0", 7));
  const Crs crs = read_las_bytes(las_with(utm_keys(32767) + doubles + ascii, 3, 0)).crs;
  EXPECT_EQ(crs.keys.doubles, (Doubles{9.5, 1}));
  EXPECT_EQ(crs.keys.ascii, "grid|");
}

// Norwegian files have Latin-1 texts; the keys keep their parts of the text.
TEST(Las, KeysWithLatin1BecomeUtf8) {
  std::string directory;
  for (const int value : {1, 1, 0, 2, 3073, 34737, 4, 0, 4097, 34737, 6, 4})
    directory += bytes_of(static_cast<std::uint16_t>(value));
  const Crs crs = read_las_bytes(las_with(las_vlr("LASF_Projection", 34735, directory) +
                                              las_vlr("LASF_Projection", 34737, "p\xe5 |h\xf8yde|"),
                                          2, 0))
                      .crs;
  EXPECT_EQ(crs.name(), "p\xc3\xa5  + h\xc3\xb8yde");
  EXPECT_EQ(crs.keys.ascii, "p\xc3\xa5 |h\xc3\xb8yde|");
}

/// An extended record behind a file of LAS 1.4 that has one point.
std::string las_with_extended(const std::string& user, std::uint16_t number,
                              const std::string& content) {
  std::string file = las_header(4, 6, 30, 1) + las_record(30, 1, 2, 3);
  put(file, 390, std::uint8_t{0});
  put(file, 235, std::uint64_t{file.size()});
  put(file, 243, std::uint32_t{1});
  std::string start(60, '\0');
  for (std::size_t k = 0; k < user.size(); ++k) start[2 + k] = user[k];
  put(start, 18, number);
  put(start, 20, std::uint64_t{content.size()});
  return file + start + content;
}

TEST(Las, ExtendedRecordsAreRead) {
  const std::string file = las_with_extended("LASF_Projection", 2112, kWktOfZone33);
  EXPECT_EQ(read_las_bytes(file).crs.wkt, kWktOfZone33);
  EXPECT_TRUE(read_las_bytes(file).notes.empty());
  EXPECT_TRUE(read_las_bytes(las_with_extended("other", 2112, kWktOfZone33)).crs.empty());
  const Notes said = {{NoteKind::left_out, "extended records that reach beyond the file's end"}};
  for (const std::size_t cut : {1U, 30U, 110U}) {
    SCOPED_TRACE(cut);
    const Table table = read_las_bytes(file.substr(0, file.size() - cut));
    EXPECT_EQ(table.rows, 1U);
    EXPECT_EQ(table.notes, said);
  }
  std::string far = file;
  put(far, 235, ~std::uint64_t{0});
  EXPECT_EQ(read_las_bytes(far).notes, said);
  std::string large = las_with_extended("LASF_Projection", 2112, std::string(17 << 20, 'x'));
  expect_las_error(large, {"2112", "LASF_Projection", "bytes"});
}

TEST(Las, FactsOfTheHeader) {
  const TemporaryFolder folder;
  std::string content = las_with_extended("LASF_Projection", 2112, kWktOfZone33);
  for (std::size_t k = 0; k < 7; ++k) content[58 + k] = "so\x01 ft\x00"[k];
  const LasFacts facts = read_las_facts(folder.write("a.las", content));
  EXPECT_EQ(facts.version, "1.4");
  EXPECT_EQ(facts.point_format, 6U);
  EXPECT_EQ(facts.points, 1U);
  EXPECT_EQ(facts.software, "so? ft");
  EXPECT_TRUE(facts.scale == (Vec3d{0.01, 0.01, 0.01}));
  EXPECT_TRUE(facts.offset == (Vec3d{0, 1000, 2000}));
  EXPECT_EQ(read_crs(folder.path() / "a.las").wkt, kWktOfZone33);
  EXPECT_TRUE(is_las(folder.path() / "a.las"));
}

TEST(Las, NoPointsIsAnEmptyTable) {
  const Table table = read_las_bytes(las_header(2, 3, 34, 0));
  EXPECT_EQ(table.rows, 0U);
  EXPECT_NE(table.find("red"), nullptr);
}

// Fault 15.
TEST(Las, GarbageInTheHeader) {
  const std::string good = las_header(2, 0, 20, 1) + las_record(20, 1, 2, 3);
  EXPECT_EQ(read_las_bytes(good).rows, 1U);
  const auto with = [&](std::size_t offset, auto value) {
    std::string bad = good;
    put(bad, offset, value);
    return bad;
  };
  expect_las_error(with(100, std::uint32_t{1069128089}),
                   {"byte 100", "1069128089", "at most 0 fit"});
  expect_las_error(with(100, std::uint32_t{1}), {"byte 100", "at most 0 fit"});
  expect_las_error(with(0, 'X'), {"'XASF'"});
  expect_las_error(with(24, std::uint8_t{2}), {"version 2.2"});
  expect_las_error(with(25, std::uint8_t{9}), {"version 1.9"});
  expect_las_error(with(94, std::uint16_t{100}), {"byte 94", "100"});
  expect_las_error(with(94, std::uint16_t{65535}), {"offset of the points"});
  expect_las_error(with(96, std::uint32_t{226}), {"byte 96", "226"});
  expect_las_error(with(96, std::uint32_t{0xffffffff}), {"byte 96", "4294967295"});
  expect_las_error(with(104, std::uint8_t{11}), {"point format 11"});
  expect_las_error(with(105, std::uint16_t{19}), {"byte 105", "19 bytes"});
  expect_las_error(with(105, std::uint16_t{0}), {"byte 105"});
  expect_las_error(good.substr(0, 100), {"ends here"});
  expect_las_error("LA", {"'LA'"});
  expect_las_error(las_header(4, 6, 30, 0).substr(0, 300), {"byte 300", "ends here"});
}

// Fault 16.
TEST(Las, FewerRecordsThanTheHeaderStates) {
  for (const std::uint32_t points : {3U, 0xffffffffU}) {
    const std::string content =
        las_header(2, 0, 20, points) + las_record(20, 1, 0, 0) + las_record(20, 2, 0, 0) + "short";
    expect_las_error(content, {"byte 227", "holds 2 of " + std::to_string(points)});
    const Table table = read_las_bytes(content, true);
    EXPECT_EQ(values_of(table, "x"), (Doubles{0.01, 0.02}));
    EXPECT_EQ(table.notes,
              (Notes{{NoteKind::salvaged, "2 of " + std::to_string(points) + " records"}}));
  }
}

TEST(Las, SalvageOfAWholeFileChangesNothing) {
  const Table table = read_las_bytes(las_header(2, 0, 20, 1) + las_record(20, 1, 0, 0), true);
  EXPECT_EQ(table.rows, 1U);
  EXPECT_TRUE(table.notes.empty());
}

// Fault 20.
TEST(Las, InvalidScaleAndOffset) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const auto with = [](std::size_t offset, double value) {
    std::string bad = las_header(2, 0, 20, 1) + las_record(20, 1, 2, 3);
    put(bad, offset, value);
    return bad;
  };
  for (const double scale : {0.0, -0.01, kNaN, kInf, 1e300})
    expect_las_error(with(139, scale), {"byte 139", "y scale"});
  for (const double offset : {1e300, -1e13, kNaN, -kInf})
    expect_las_error(with(171, offset), {"byte 171", "z offset"});
  EXPECT_EQ(read_las_bytes(with(155, 7e6)).rows, 1U);
}

// Fault 22: the 64-bit count of LAS 1.4 rules over the 32-bit one.
TEST(Las, CountsOf64Bits) {
  std::string header = las_header(4, 6, 30, 0);
  put(header, 247, std::uint64_t{2});
  std::string records = las_record(30, 1, 0, 0) + las_record(30, 2, 0, 0);
  for (const std::size_t row : {0U, 1U}) put(records, row * 30 + 15, std::uint8_t{0});  // no flags
  EXPECT_EQ(read_las_bytes(header + records).rows, 2U);
  // 2^32 + 2 must not be taken for 2, nor 2^64 - 1 wrap.
  put(header, 247, (std::uint64_t{1} << 32) + 2);
  expect_las_error(header + records, {"holds 2 of 4294967298"});
  put(header, 247, ~std::uint64_t{0});
  expect_las_error(header + records, {"18446744073709551615"});
  EXPECT_EQ(read_las_bytes(header + records, true).rows, 2U);
}

TEST(Las, LazWithoutLaszipsRecord) {
  std::string content = las_header(2, 0, 20, 1) + las_record(20, 1, 2, 3);
  put(content, 104, std::uint8_t{0x80});
  expect_las_error(content, {"marked as LAZ", "'laszip encoded'"});
}

}  // namespace
}  // namespace adasplats
