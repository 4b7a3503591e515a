// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

using io_test::values_of;
using Doubles = std::vector<double>;
using Names = std::vector<std::string>;

Table read_point_text(const std::string& content, const std::string& name = "file.txt") {
  const TemporaryFolder folder;
  return read_text_points(folder.write(name, content));
}

void expect_text_error(const std::string& content, const std::vector<std::string>& parts,
                       const std::string& name = "file.txt") {
  expect_error(ErrorKind::data, parts, [&] { read_point_text(content, name); });
}

Names names_of(const Table& table) {
  Names names;
  for (const Column& column : table.columns) names.push_back(column.name);
  return names;
}

TEST(TextPoints, EverySeparatorAndLineEnd) {
  for (const char* separator : {" ", "\t", ",", ";", " , ", "; ", "   "}) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
      std::string content = "\xef\xbb\xbf";
      for (const char* a : {"1.5", "-2e3"})
        content += std::string(a) + separator + "600000.125" + separator + "+4" + end + end;
      const Table table = read_point_text(content);
      EXPECT_EQ(table.rows, 2U);
      EXPECT_EQ(names_of(table), (Names{"x", "y", "z"}));
      EXPECT_EQ(values_of(table, "x"), (Doubles{1.5, -2000})) << separator;
      EXPECT_EQ(values_of(table, "y"), (Doubles{600000.125, 600000.125}));
      EXPECT_EQ(values_of(table, "z"), (Doubles{4, 4}));
    }
  }
}

TEST(TextPoints, NamesOfColumnsWithoutAHeader) {
  EXPECT_EQ(names_of(read_point_text("1 2 3 4")), (Names{"x", "y", "z", "intensity"}));
  EXPECT_EQ(names_of(read_point_text("1 2 3 4 5")),
            (Names{"x", "y", "z", "intensity", "column_5"}));
  EXPECT_EQ(names_of(read_point_text("1 2 3 4 5 6")),
            (Names{"x", "y", "z", "column_4", "column_5", "column_6"}));
  const Names with_colour = {"x", "y", "z", "intensity", "red", "green", "blue"};
  EXPECT_EQ(names_of(read_point_text("1 2 3 4 5 6 7")), with_colour);
  EXPECT_EQ(names_of(read_point_text("1\n1 2 3 4 5 6 7")), with_colour);
  EXPECT_EQ(names_of(read_point_text("1\n1 2 3 4 5 6")),
            (Names{"x", "y", "z", "red", "green", "blue"}));
}

TEST(TextPoints, ColumnsWithoutNamesAreNoted) {
  const auto note_of = [](const std::string& content) {
    const Table table = read_point_text(content);
    EXPECT_LE(table.notes.size(), 1U);
    if (table.notes.empty()) return std::string();
    EXPECT_EQ(table.notes[0].kind, NoteKind::unnamed_columns);
    return table.notes[0].text;
  };
  for (const char* clear : {"1 2 3\n", "1\n1 2 3 4\n", "1\n1 2 3 4 5 6 7\n", "x y z w\n1 2 3 4\n"})
    EXPECT_EQ(note_of(clear), "") << clear;
  EXPECT_NE(note_of("1 2 3 4\n").find("x, y and z, 4 as intensity; name them"), std::string::npos);
  EXPECT_NE(note_of("1 2 3 4 5\n").find("5 is skipped"), std::string::npos);
  EXPECT_NE(note_of("1 2 3 4 5 6 7 8\n").find("4 to 8 are skipped"), std::string::npos);
  std::string timed;
  for (int k = 0; k < 10; ++k) timed += std::to_string(k) + " 1 2 3\n";
  EXPECT_NE(note_of(timed).find("column 1 ascends"), std::string::npos);
}

TEST(TextPoints, HeaderOfNames) {
  for (const char* header : {"X,Y,\"Z\",Time", "X, Y, Z, Time,", "#X,Y,Z,Time", "//X Y Z Time",
                             "# a comment\n# X;Y;Z;Time"}) {
    const Table table = read_point_text(std::string(header) + "\n1,2,3,4\n5,6,7,8,\n");
    EXPECT_EQ(names_of(table), (Names{"x", "y", "z", "time"})) << header;
    EXPECT_EQ(values_of(table, "time"), (Doubles{4, 8}));
  }
  // A comment that is not a list of the names stays one.
  const Table table = read_point_text("# made by me\n1 2 3\n# later\n// too\n4 5 6\n");
  EXPECT_EQ(names_of(table), (Names{"x", "y", "z"}));
  EXPECT_EQ(table.comments, (Names{"made by me", "later", "too"}));
  EXPECT_EQ(table.rows, 2U);
}

TEST(TextPoints, NamesMayHaveTheirUnit) {
  const Table table =
      read_point_text("Z [m];X[m];Y (m);time [ns];GPS Time (s);Intensity [-]\n3;1;2;4;5;6\n");
  EXPECT_EQ(names_of(table), (Names{"z", "x", "y", "time [ns]", "gps time", "intensity"}));
  EXPECT_EQ(values_of(table, "x"), (Doubles{1}));
  // Nothing takes feet for metres.
  EXPECT_EQ(names_of(read_point_text("x [ft],y [ft],z [ft]\n1,2,3\n")),
            (Names{"x [ft]", "y [ft]", "z [ft]"}));
}

TEST(TextPoints, EmptyCellsAreMissingValues) {
  const Table table = read_point_text("x,y,z,w\n1,2,3,\n1,2,3,4\n1,2,,nan\n");
  EXPECT_TRUE(std::isnan(values_of(table, "w")[0]));
  EXPECT_EQ(values_of(table, "w")[1], 4);
  EXPECT_TRUE(std::isnan(values_of(table, "z")[2]));
}

TEST(TextPoints, PtsCounts) {
  EXPECT_EQ(read_point_text("2\n1 2 3\n4 5 6\n", "f.pts").rows, 2U);
  EXPECT_EQ(read_point_text("2\n1 2 3\n4 5 6\n1\n7 8 9\n", "f.pts").rows, 3U) << "two scans";
  expect_text_error("3\n1 2 3\n4 5 6\n", {"after 2", "is 3"});
  expect_text_error("18446744073709551615\n1 2 3\n", {"18446744073709551615"});
  expect_text_error("18446744073709551615\n1 2 3\n1\n", {"2^64"});
  const Table more = read_point_text("1\n1 2 3\n4 5 6\n");
  EXPECT_EQ(more.rows, 2U);
  EXPECT_EQ(
      more.notes,
      (std::vector<ReaderNote>{{NoteKind::wrong_count, "the file states 1 points and has 2"}}));
  EXPECT_EQ(read_point_text("0\n").rows, 0U);
  EXPECT_EQ(read_point_text("x y z\n").rows, 0U);
}

TEST(TextPoints, BadLinesAreErrorsWithTheirNumber) {
  expect_text_error("1 2 3\n\n4 5\n", {"file.txt:3", "found 2 columns", "expected 3"});
  expect_text_error("1 2 3\n4 5 6 7\n", {"file.txt:2", "'7' after the last"});
  expect_text_error("1 2 3\n4 abc 6\n", {"file.txt:2", "column 2 (y)", "'abc'"});
  expect_text_error("1;2;3\n4;5,5;6\n", {"file.txt:2", "'5,5'"});
  expect_text_error("1 2 3\n4 1e999 6\n", {"file.txt:2", "'1e999'"});
  expect_text_error("x y z\na b c\n", {"file.txt:2", "'a'"});
  expect_text_error("1 2\n", {"file.txt:1", "found 2 columns"});
  expect_text_error("1 2 3\n7\n", {"file.txt:2", "found 1 columns"});
  expect_text_error("# nothing\n\n", {"no points"});
  expect_text_error("", {"empty"});
  expect_text_error(std::string("\0\1\2\3\n1 2 3 4", 12), {"file.txt"});
}

TEST(TextPoints, ALineWithoutEndIsNotAText) {
  expect_text_error(std::string(40 << 20, 'x'), {"file.txt:1", "16 MiB"});
}

// The oracle: the transform by hand, row vectors as PTX writes them.
TEST(Ptx, ScansAreTransformedToTheWorld) {
  const std::string first =
      "1\n3\n10 20 30\n0 1 0\n-1 0 0\n0 0 1\n"
      "0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n"
      "1 2 3 0.5\n0 0 0 0.25\n4 5 6 0.75\n";
  const std::string second =
      "2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n7 8 9 1\n0 0 0 0\n";
  const Table table = read_point_text(first + second, "FILE.PTX");
  // x turns to y by 90 degrees: (1, 2, 3) -> (-2, 1, 3).
  EXPECT_EQ(values_of(table, "x"), (Doubles{8, 5, 7}));
  EXPECT_EQ(values_of(table, "y"), (Doubles{21, 24, 8}));
  EXPECT_EQ(values_of(table, "z"), (Doubles{33, 36, 9}));
  EXPECT_EQ(values_of(table, "intensity"), (Doubles{0.5, 0.75, 1}));
  EXPECT_EQ(values_of(table, "sensor_x"), (Doubles{10, 10, 0}));
  EXPECT_EQ(values_of(table, "sensor_y"), (Doubles{20, 20, 0}));
  EXPECT_EQ(values_of(table, "sensor_z"), (Doubles{30, 30, 0}));
  EXPECT_EQ(table.notes,
            (std::vector<ReaderNote>{{NoteKind::no_return, "2 points without a return"}}));
}

TEST(Ptx, SeveralStationsWithTheIdentityAreNotRegistered) {
  const std::string axes = "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  const std::string own = axes + "0 0 0 1\n1 2 3 4\n", moved = axes + "5 0 0 1\n1 2 3 4\n";
  const Table one = read_point_text(own, "f.ptx");
  ASSERT_EQ(one.notes.size(), 1U);
  EXPECT_EQ(one.notes[0].kind, NoteKind::own_frame);
  expect_text_error(own + own + own, {"f.ptx", "all 3 stations", "identity"}, "f.ptx");
  EXPECT_EQ(values_of(read_point_text(own + moved, "f.ptx"), "sensor_x"), (Doubles{0, 5}));
  EXPECT_TRUE(read_point_text(own + moved, "f.ptx").notes.empty());
}

TEST(Ptx, ColoursAndErrors) {
  const auto scan = [](const std::string& counts, const std::string& points) {
    return counts + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" + points;
  };
  const Table table = read_point_text(scan("1\n1\n", "1 2 3 4 5 6 7\n"), "f.ptx");
  EXPECT_EQ(names_of(table), (Names{"x", "y", "z", "intensity", "red", "green", "blue", "sensor_x",
                                    "sensor_y", "sensor_z"}));
  EXPECT_EQ(values_of(table, "green"), Doubles{6});
  expect_text_error(scan("1\n3\n", "1 2 3 4\n1 2 3 4\n"), {"room for at most 2"}, "f.ptx");
  expect_text_error(scan("1\n2\n", "1 2 3 4            \n"), {"within a scan"}, "f.ptx");
  expect_text_error(scan("4294967296\n4294967296\n", "1 2 3 4\n"), {"2^64"}, "f.ptx");
  expect_text_error(scan("1\n-1\n", "1 2 3 4\n"), {"'-1'"}, "f.ptx");
  expect_text_error(scan("1\n1\n", "1 2 3\n   "), {"f.ptx:11", "found 3 numbers"}, "f.ptx");
  expect_text_error(scan("1\n1\n", "1 2 x 4\n"), {"f.ptx:11", "'x'"}, "f.ptx");
  expect_text_error(scan("1\n1\n", "1 2 3 4 5 6 7 8\n"), {"'8'"}, "f.ptx");
  expect_text_error("1\n1\n0 0 nan\n", {"f.ptx:3", "'nan'"}, "f.ptx");
}

// The header and two rows of Livox Viewer.
TEST(TextPoints, HexadecimalNumbersAndTexts) {
  const Table table = read_point_text(
      "Version,Error Code,Operator,Timestamp,X,Y,Z,Reflectivity\n"
      "5,0x0000001F,anna,1619684812000,1.5,2,3,7\n5,0X10,bert,1619684812001,4,5,6,8\n");
  EXPECT_EQ(values_of(table, "error code"), (Doubles{31, 16}));
  EXPECT_EQ(values_of(table, "x"), (Doubles{1.5, 4}));
  EXPECT_EQ(table.find("operator"), nullptr);
  ASSERT_EQ(table.notes.size(), 1U);
  EXPECT_EQ(table.notes[0], (ReaderNote{NoteKind::left_out, "columns of text: 'operator'"}));
  expect_text_error("x,y,z,intensity\n1,2,3,high\n", {"column 4 (intensity)", "'high'"});
  expect_text_error("x,y,z,other\n1,2,3,4\n1,2,3,high\n", {":3:", "'high'"});
}

// The header of VeloView.
TEST(TextPoints, TablesOfVeloView) {
  const Table table = read_point_text(
      "\"intensity\",\"laser_id\",\"adjustedtime\",\"timestamp\",\"Points_m_XYZ:0\","
      "\"Points_m_XYZ:1\",\"Points_m_XYZ:2\"\n9,3,3600000005,5,1.5,2.5,3.5\n");
  EXPECT_EQ(names_of(table),
            (Names{"intensity", "laser_id", "adjustedtime_us", "hour_us", "x", "y", "z"}));
  EXPECT_EQ(names_of(read_point_text("Points:0,Points:1,Points:2,timestamp\n1,2,3,4\n")),
            (Names{"x", "y", "z", "timestamp"}));
  EXPECT_EQ(names_of(read_point_text("x,y,z,laser_id,Points:0\n1,2,3,4,5\n")).back(), "points:0");
}

}  // namespace
}  // namespace adasplats
