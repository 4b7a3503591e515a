// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/e57/e57_file_test.h"

// Files that are composed here by the standard's layout; what they hold is computed here, too.
namespace adasplats {
namespace {

using io_test::data_packet;
using io_test::E57Composer;
using io_test::float_field;
using io_test::integer_field;
using io_test::other_packet;
using io_test::PackedBits;
using io_test::pose_element;
using io_test::stream_of;
using io_test::values_of;
using io_test::xyz_fields;

using Doubles = std::vector<double>;
using Notes = std::vector<ReaderNote>;

Table read_composed(const std::string& content) {
  const TemporaryFolder folder;
  return read_points(folder.write("a.e57", content));
}

std::vector<std::string> names_of_columns(const Table& table) {
  std::vector<std::string> names;
  for (const Column& column : table.columns) names.push_back(column.name);
  return names;
}

/// x, y and z of three points as doubles.
std::vector<std::string> three_points() {
  return {stream_of<double>({1, 2, 3}), stream_of<double>({4, 5, 6}), stream_of<double>({7, 8, 9})};
}

TEST(E57, PointsWithoutAPoseHaveNoSensor) {
  E57Composer composer;
  composer.add_scan(3, xyz_fields(), three_points(), "<pose type=\"Structure\"/>");
  const Table table = read_composed(composer.file());
  EXPECT_EQ(names_of_columns(table), (std::vector<std::string>{"x", "y", "z"}));
  EXPECT_EQ(values_of(table, "x"), (Doubles{1, 2, 3}));
  EXPECT_EQ(values_of(table, "y"), (Doubles{4, 5, 6}));
  EXPECT_EQ(values_of(table, "z"), (Doubles{7, 8, 9}));
  EXPECT_TRUE(table.notes.empty());
}

// Oracle: a quarter turn about z takes (x, y, z) to (-y, x, z); half a turn about x to (x, -y, -z).
TEST(E57, ScansGoThroughTheirPoses) {
  E57Composer composer;
  const std::string quarter = std::to_string(std::sqrt(0.5));
  composer.add_scan(3, xyz_fields(), three_points(),
                    pose_element({quarter, "0", "0", quarter, "600000.5", "5e6", "-3"}));
  composer.add_scan(3, xyz_fields(), three_points(),
                    pose_element({"", "1", "0", "0", "10", "20", "30"}));
  const Table table = read_composed(composer.file());
  const Doubles x = {600000.5 - 4, 600000.5 - 5, 600000.5 - 6, 11, 12, 13};
  const Doubles y = {5e6 + 1, 5e6 + 2, 5e6 + 3, 16, 15, 14};
  const Doubles z = {4, 5, 6, 23, 22, 21};
  ASSERT_EQ(table.rows, 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(values_of(table, "x")[i], x[i], 1e-9);
    EXPECT_NEAR(values_of(table, "y")[i], y[i], 1e-9);
    EXPECT_NEAR(values_of(table, "z")[i], z[i], 1e-9);
  }
  EXPECT_EQ(values_of(table, "sensor_x"), (Doubles{600000.5, 600000.5, 600000.5, 10, 10, 10}));
  EXPECT_EQ(values_of(table, "sensor_y"), (Doubles{5e6, 5e6, 5e6, 20, 20, 20}));
  EXPECT_EQ(values_of(table, "sensor_z"), (Doubles{-3, -3, -3, 30, 30, 30}));
}

// A cloud made of several scans may have a pose, but no scanner stood there.
TEST(E57, MergedCloudsHaveNoSensor) {
  E57Composer composer;
  const std::string pose = pose_element({"1", "0", "0", "0", "100", "0", "0"});
  composer.add_scan(3, xyz_fields(), three_points(), pose);
  composer.add_scan(3, xyz_fields(), three_points(),
                    pose +
                        "<originalGuids type=\"Vector\"><vectorChild type=\"String\">a"
                        "</vectorChild><vectorChild type=\"String\">b</vectorChild>"
                        "</originalGuids>");
  const Table table = read_composed(composer.file());
  EXPECT_EQ(values_of(table, "x"), (Doubles{101, 102, 103, 101, 102, 103}));
  const Doubles sensors = values_of(table, "sensor_x");
  EXPECT_EQ(sensors[2], 100);
  for (const std::size_t i : {3U, 4U, 5U}) EXPECT_TRUE(std::isnan(sensors[i]));
}

TEST(E57, SphericalPointsAreSeenFromTheirScanner) {
  E57Composer composer;
  const double quarter = std::acos(0.0);
  composer.add_scan(
      4,
      float_field("sphericalRange") + float_field("sphericalAzimuth") +
          float_field("sphericalElevation") + integer_field("sphericalInvalidState", 0, 2),
      {stream_of<double>({2, 3, 4, 5}), stream_of<double>({0, quarter, 0.3, 0}),
       stream_of<double>({0, 0, quarter, 1}),
       PackedBits().put_bits(0, 2).put_bits(0, 2).put_bits(0, 2).put_bits(1, 2).bytes()});
  const Table table = read_composed(composer.file());
  const Doubles expected = {2, 0, 0, 0, 3, 0, 0, 0, 4};
  ASSERT_EQ(table.rows, 3U);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(values_of(table, std::string(1, "xyz"[axis]))[i], expected[3 * i + axis], 1e-15);
  EXPECT_EQ(values_of(table, "sensor_x"), (Doubles{0, 0, 0}));
  EXPECT_EQ(table.notes, (Notes{{NoteKind::no_return, "1 points without a return"}}));
}

// As in PTX, a point in the scanner is none; in a cloud without a scanner the origin is a place.
TEST(E57, PointsWithoutAReturnAreLeftOut) {
  const std::string fields = xyz_fields() + integer_field("cartesianInvalidState", 0, 2);
  const std::vector<std::string> streams = {
      stream_of<double>({1, 0, 3, 4}), stream_of<double>({1, 0, 3, 4}),
      stream_of<double>({1, 0, 3, 4}), std::string(1, '\x90')};  // 0, 0, 1, 2
  E57Composer cloud, scan;
  cloud.add_scan(4, fields, streams);
  scan.add_scan(4, fields, streams, pose_element({"1", "", "", "", "1", "", ""}));
  EXPECT_EQ(values_of(read_composed(cloud.file()), "x"), (Doubles{1, 0}));
  const Table table = read_composed(scan.file());
  EXPECT_EQ(values_of(table, "x"), (Doubles{2}));
  EXPECT_EQ(table.notes, (Notes{{NoteKind::no_return, "3 points without a return"}}));
}

TEST(E57, ScaledIntegersOfOddWidths) {
  constexpr std::size_t kPoints = 1000;
  PackedBits x, y, z;
  for (std::size_t i = 0; i < kPoints; ++i) {
    x.put_bits(i, 10);                               // from -500
    y.put_bits(i * 7, 13);                           // from 3
    z.put_bits(0x123456789abcdefULL * (i + 1), 64);  // all of them
  }
  const std::string fields =
      integer_field("cartesianX", -500, 499, "scale=\"0.001\" offset=\"100\"") +
      integer_field("cartesianY", 3, 3 + 7000, "scale=\"2\"") +
      "<cartesianZ type=\"ScaledInteger\" scale=\"1e-9\"/>";
  for (const std::size_t packet_bytes : {1U, 3U, 100U, 8000U}) {
    E57Composer composer;
    composer.add_scan(kPoints, fields, {x.bytes(), y.bytes(), z.bytes()}, "", packet_bytes);
    const Table table = read_composed(composer.file());
    ASSERT_EQ(table.rows, kPoints);
    const Doubles xs = values_of(table, "x"), ys = values_of(table, "y"),
                  zs = values_of(table, "z");
    for (std::size_t i = 0; i < kPoints; ++i) {
      const auto number = static_cast<double>(i);
      EXPECT_EQ(xs[i], (number - 500) * 0.001 + 100);
      EXPECT_EQ(ys[i], (3 + 7 * number) * 2);
      // -2^63 and the stored number, which wraps to a signed one with its highest bit turned.
      const auto whole =
          static_cast<std::int64_t>((0x123456789abcdefULL * (i + 1)) ^ 0x8000000000000000ULL);
      EXPECT_EQ(zs[i], static_cast<double>(whole) * 1e-9);
    }
  }
}

// Streams of one packet belong to different records; packets of an index and ignored ones lie
// between.
TEST(E57, StreamsAdvanceOnTheirOwn) {
  const std::vector<std::string> streams = three_points();
  const std::string packets =
      other_packet('\0', 16) + data_packet({streams[0], "", streams[2].substr(0, 3)}) +
      other_packet('\2', 2000) + data_packet({"", streams[1].substr(0, 9), ""}) +
      data_packet({"", "", ""}) + data_packet({"", streams[1].substr(9), streams[2].substr(3)}) +
      other_packet('\2', 4);
  E57Composer composer;
  composer.add_scan_at(composer.add_section(packets), 3, xyz_fields());
  const Table table = read_composed(composer.file());
  EXPECT_EQ(values_of(table, "x"), (Doubles{1, 2, 3}));
  EXPECT_EQ(values_of(table, "y"), (Doubles{4, 5, 6}));
  EXPECT_EQ(values_of(table, "z"), (Doubles{7, 8, 9}));
}

TEST(E57, ColumnsOfTheStandardAndOfExtensions) {
  E57Composer composer;
  const std::string fields =
      xyz_fields() + float_field("intensity", true) + integer_field("colorRed", 0, 255) +
      integer_field("colorGreen", 7, 7) + integer_field("colorBlue", 0, 65535) +
      integer_field("rowIndex", 0, 7) + integer_field("columnIndex", 2, 5) +
      integer_field("returnIndex", 0, 3) + integer_field("returnCount", 0, 7) +
      float_field("timeStamp") + "<name type=\"String\"/>" +
      integer_field("las:classification", 0, 255) + integer_field("las:x", 0, 255) +
      integer_field("isIntensityInvalid", 0, 1);
  std::vector<std::string> streams = three_points();
  streams.insert(streams.end(),
                 {stream_of<float>({0.5F, -66, 0.25F}), "\x01\x80\xff", "",
                  stream_of<std::uint16_t>({0, 1, 65535}),
                  PackedBits().put_bits(1, 3).put_bits(2, 3).put_bits(7, 3).bytes(),
                  PackedBits().put_bits(0, 2).put_bits(1, 2).put_bits(3, 2).bytes(),
                  PackedBits().put_bits(0, 2).put_bits(1, 2).put_bits(2, 2).bytes(),
                  PackedBits().put_bits(3, 3).put_bits(3, 3).put_bits(3, 3).bytes(),
                  stream_of<double>({0.5, 1.5, 2.5}),
                  std::string("\x06"
                              "abc\0\0",
                              6),
                  "\x02\x05\x06", "\x0a\x0b\x0c", PackedBits().put_bits(4, 3).bytes()});
  composer.add_scan(3, fields, streams);
  const Table table = read_composed(composer.file());
  EXPECT_EQ(names_of_columns(table),
            (std::vector<std::string>{"x", "y", "z", "intensity", "red", "green", "blue", "row",
                                      "column", "return_number", "number_of_returns", "timestamp",
                                      "classification", "las:x"}));
  EXPECT_EQ(values_of(table, "intensity")[1], -66);
  EXPECT_TRUE(std::isnan(values_of(table, "intensity")[2]));
  EXPECT_EQ(values_of(table, "red"), (Doubles{1, 128, 255}));
  EXPECT_EQ(values_of(table, "green"), (Doubles{7, 7, 7}));
  EXPECT_EQ(values_of(table, "blue"), (Doubles{0, 1, 65535}));
  EXPECT_EQ(values_of(table, "row"), (Doubles{1, 2, 7}));
  EXPECT_EQ(values_of(table, "column"), (Doubles{2, 3, 5}));
  EXPECT_EQ(values_of(table, "return_number"), (Doubles{1, 2, 3}));
  EXPECT_EQ(values_of(table, "number_of_returns"), (Doubles{3, 3, 3}));
  EXPECT_EQ(values_of(table, "timestamp"), (Doubles{0.5, 1.5, 2.5}));
  EXPECT_EQ(values_of(table, "classification"), (Doubles{2, 5, 6}));
  EXPECT_EQ(values_of(table, "las:x"), (Doubles{10, 11, 12}));
}

std::string limits_of(const std::string& least, const std::string& most) {
  return "<intensityLimits type=\"Structure\"><intensityMinimum type=\"Float\">" + least +
         "</intensityMinimum><intensityMaximum type=\"Float\">" + most +
         "</intensityMaximum></intensityLimits>";
}

// Oracle: by hand.
TEST(E57, IntensitiesAreBetweenTheirLimits) {
  std::vector<std::string> streams = three_points();
  streams.push_back(stream_of<float>({100, 150, 200}));
  const std::string fields = xyz_fields() + float_field("intensity", true);
  const auto two_scans = [&](const std::string& first, const std::string& second) {
    E57Composer composer;
    composer.add_scan(3, fields, streams, first);
    composer.add_scan(3, fields, streams, second);
    composer.add_scan(3, xyz_fields(), three_points());  // has no intensities to limit
    return read_composed(composer.file());
  };
  const auto first_six = [](const Table& table) {
    Doubles values = values_of(table, "intensity");
    values.resize(6);
    return values;
  };
  const Table both = two_scans(limits_of("100", "200"), limits_of("0", "400"));
  EXPECT_EQ(first_six(both), (Doubles{0, 0.5, 1, 0.25, 0.375, 0.5}));
  EXPECT_TRUE(std::isnan(values_of(both, "intensity")[7]));
  EXPECT_TRUE(both.notes.empty());
  const Doubles stored = {100, 150, 200, 100, 150, 200};
  const Table one = two_scans(limits_of("100", "200"), "");
  EXPECT_EQ(first_six(one), stored);
  ASSERT_EQ(one.notes.size(), 1U);
  EXPECT_EQ(one.notes[0].kind, NoteKind::intensity_scale);
  EXPECT_NE(one.notes[0].text.find("1 of 2 scans have intensityLimits"), std::string::npos);
  EXPECT_EQ(first_six(two_scans(limits_of("0", "0"), limits_of("", ""))), stored) << "not known";
  const Table beyond = two_scans(limits_of("0", "160"), limits_of("100", "200"));
  EXPECT_EQ(first_six(beyond)[2], 1.25);
  ASSERT_EQ(beyond.notes.size(), 1U);
  EXPECT_NE(beyond.notes[0].text.find("1 intensities exceed"), std::string::npos);
  const std::string scaled =
      "<intensityLimits type=\"Structure\"><intensityMinimum type=\"ScaledInteger\" scale=\"10\" "
      "offset=\"50\">5</intensityMinimum><intensityMaximum type=\"Integer\">200"
      "</intensityMaximum></intensityLimits>";
  EXPECT_EQ(first_six(two_scans(scaled, scaled)), (Doubles{0, 0.5, 1, 0, 0.5, 1}));
  EXPECT_THROW(two_scans(limits_of("much", "more"), ""), Error);
}

TEST(E57, ColumnsThatOnlySomeScansHave) {
  E57Composer composer;
  std::vector<std::string> streams = three_points();
  composer.add_scan(3, xyz_fields(), streams);
  streams.insert(streams.end(), {"\x01\x02\x03", "\x04\x05\x06"});
  composer.add_scan(
      3, xyz_fields() + integer_field("intensity", 0, 255) + integer_field("colorRed", 0, 255),
      streams);
  const Table table = read_composed(composer.file());
  EXPECT_EQ(names_of_columns(table), (std::vector<std::string>{"x", "y", "z", "intensity"}));
  EXPECT_TRUE(std::isnan(values_of(table, "intensity")[0]));
  EXPECT_EQ(values_of(table, "intensity")[5], 3);
  EXPECT_EQ(table.notes,
            (Notes{{NoteKind::left_out, "column 'red', which only 1 of 2 scans have"}}));
}

// dateTimeValue counts seconds of GPS time, timeStamp from there.
TEST(E57, TimesOfScansWithAStart) {
  const std::string start =
      "<acquisitionStart type=\"Structure\"><dateTimeValue type=\"Float\">1e9</dateTimeValue>"
      "</acquisitionStart>";
  std::vector<std::string> streams = three_points();
  streams.push_back(stream_of<double>({0, 0.5, 1}));
  const std::string fields = xyz_fields() + float_field("timeStamp");
  E57Composer both, one;
  both.add_scan(3, fields, streams, start);
  one.add_scan(3, fields, streams, start);
  one.add_scan(3, fields, streams);
  EXPECT_EQ(values_of(read_composed(both.file()), "timestamp"), (Doubles{1e9, 1e9 + 0.5, 1e9 + 1}));
  EXPECT_EQ(values_of(read_composed(one.file()), "timestamp"), (Doubles{0, 0.5, 1, 0, 0.5, 1}));
}

TEST(E57, NotesOfAFile) {
  E57Composer composer;
  composer.add_scan(3, xyz_fields(), three_points());
  const auto notes = [&](const std::string& more) {
    return read_composed(composer.file(more)).notes;
  };
  EXPECT_EQ(notes("<coordinateMetadata>PROJCS[\"a\",UNIT[\"ft\",0.3048]]</coordinateMetadata>"),
            (Notes{{NoteKind::not_metres, "x and y in ft (0.3048 m), by the WKT"}}));
  EXPECT_EQ(
      notes("<coordinateMetadata><![CDATA[GEOGCS[\"WGS 84\",DATUM[]]]]></coordinateMetadata>"),
      (Notes{{NoteKind::geographic, "GEOGCS[\"WGS 84\""}}));
  EXPECT_EQ(read_composed(composer.file("<coordinateMetadata>PROJCS[\"a\"]</coordinateMetadata>"))
                .crs.wkt,
            "PROJCS[\"a\"]");
  EXPECT_EQ(notes("<images2D><vectorChild/><vectorChild/></images2D>"),
            (Notes{{NoteKind::left_out, "2 images"}}));
}

// A byte order mark, comments, entities, sections, a prefix of E57's own namespace, and zeros after
// the root, as some writers fill the section.
TEST(E57, XmlOfManyWriters) {
  const std::string xml =
      "\xef\xbb\xbf<?xml version=\"1.0\"?>\n<!-- a > b -->\n<e:e57Root "
      "xmlns:e=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\" xmlns:las='l'>\n"
      "<las:images2D><vectorChild/></las:images2D><e:images2D > <vectorChild/></e:images2D>"
      "<e:coordinateMetadata>\n PROJCS[&quot;&#65;&#xe9;&amp;<!-- & --><![CDATA[<&amp;\"]]]>"
      "</e:coordinateMetadata><e:data3D><e:vectorChild><e:points recordCount='0' fileOffset=\"0\">"
      "<e:prototype/></e:points></e:vectorChild></e:data3D></e:e57Root>\n" +
      std::string(9, '\0');
  const Table table = read_composed(E57Composer().file_of_xml(xml));
  EXPECT_EQ(table.notes, (Notes{{NoteKind::left_out, "1 images"}}));
  EXPECT_EQ(table.crs.wkt, "PROJCS[\"A\xc3\xa9&<&amp;\"]");
}

TEST(E57, ScansWithoutPoints) {
  E57Composer composer;
  composer.add_scan_at(0, 0, xyz_fields());
  EXPECT_EQ(read_composed(composer.file()).rows, 0U);
  composer.add_scan(3, xyz_fields(), three_points());
  EXPECT_EQ(values_of(read_composed(composer.file()), "x"), (Doubles{1, 2, 3}));
}

}  // namespace
}  // namespace adasplats
