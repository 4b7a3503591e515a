// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/las_header.h"

namespace adasplats {
namespace {

using io_test::values_of;

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

struct Points {
  std::vector<float> x = {1.2344F, -70.0F, 0.0F};
  std::vector<double> y = {0.0005, 1e6, -2147483.647};
  std::vector<float> z = {0, 1, 2};
  std::vector<std::uint16_t> intensity = {0, 1, 65535};
  std::vector<std::uint8_t> return_number = {1, 1, 2};
  std::vector<std::uint8_t> returns = {1, 2, 2};
  std::vector<std::uint8_t> classification = {0, 40, 255};
  std::vector<double> time = {0.5, 1e9, -1};
  std::vector<std::uint16_t> label = {0, 40, 259};
  std::vector<float> range = {1.5F, 2.5F, 1e-30F};

  std::vector<ColumnView> columns() const {
    return {{"x", ColumnType::f32, x.data(), 4},
            {"y", ColumnType::f64, y.data(), 8},
            {"z", ColumnType::f32, z.data(), 4},
            {"intensity", ColumnType::u16, intensity.data(), 2},
            {"label", ColumnType::u16, label.data(), 2},
            {"return_number", ColumnType::u8, return_number.data(), 1},
            {"number_of_returns", ColumnType::u8, returns.data(), 1},
            {"classification", ColumnType::u8, classification.data(), 1},
            {"gps_time", ColumnType::f64, time.data(), 8},
            {"range", ColumnType::f32, range.data(), 4}};
  }
};

std::vector<double> doubles(const auto& values) { return {values.begin(), values.end()}; }

// Oracle: our reader, tested against the specification and files of other programs.
TEST(LasWriter, RoundTrip) {
  const TemporaryFolder folder;
  const Points points;
  write_las(folder.path() / "a.las", 3, points.columns());
  const Table table = read_las(folder.path() / "a.las");
  EXPECT_EQ(table.rows, 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(values_of(table, "x")[i], static_cast<double>(points.x[i]), 0.000501);
    EXPECT_NEAR(values_of(table, "y")[i], points.y[i], 0.000501);
    EXPECT_NEAR(values_of(table, "z")[i], static_cast<double>(points.z[i]), 1e-9);
  }
  EXPECT_EQ(values_of(table, "intensity"), doubles(points.intensity));
  EXPECT_EQ(values_of(table, "return_number"), doubles(points.return_number));
  EXPECT_EQ(values_of(table, "number_of_returns"), doubles(points.returns));
  EXPECT_EQ(values_of(table, "classification"), doubles(points.classification));
  EXPECT_EQ(values_of(table, "gps_time"), points.time);
  EXPECT_EQ(values_of(table, "label"), doubles(points.label));
  EXPECT_EQ(values_of(table, "range"), doubles(points.range));
}

// Oracle: ASPRS LAS 1.4 R15, tables 3, 16 and 24, written down here a second time.
TEST(LasWriter, HeaderAndExtraBytes) {
  const TemporaryFolder folder;
  const Points points;
  write_las(folder.path() / "a.las", 3, points.columns());
  const std::string bytes = read_file(folder.path() / "a.las");
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(at<std::uint16_t>(bytes, 6), 16);
  const std::size_t begin = 375 + 54 + 2 * 192;
  EXPECT_EQ(at<std::uint32_t>(bytes, 96), begin);
  EXPECT_EQ(at<std::uint8_t>(bytes, 104), 6);
  EXPECT_EQ(at<std::uint16_t>(bytes, 105), 36);
  EXPECT_EQ(at<std::uint32_t>(bytes, 107), 0U);  // the old count of formats 6 and above
  EXPECT_EQ(at<std::uint64_t>(bytes, 247), 3U);
  EXPECT_EQ(at<std::uint64_t>(bytes, 255), 2U);
  EXPECT_EQ(at<std::uint64_t>(bytes, 263), 1U);
  EXPECT_DOUBLE_EQ(at<double>(bytes, 179), 1.234);  // greatest x
  EXPECT_DOUBLE_EQ(at<double>(bytes, 187), -70.0);  // least x
  EXPECT_DOUBLE_EQ(at<double>(bytes, 195), 1e6);    // greatest y
  EXPECT_DOUBLE_EQ(at<double>(bytes, 219), 0.0);    // least z
  EXPECT_EQ(bytes.substr(375 + 2, 9), "LASF_Spec");
  EXPECT_EQ(at<std::uint16_t>(bytes, 375 + 18), 4);
  EXPECT_EQ(at<std::uint16_t>(bytes, 375 + 20), 2 * 192);
  const std::size_t second = 375 + 54 + 192;
  EXPECT_EQ(at<std::uint8_t>(bytes, second - 192 + 2), 3);  // unsigned short
  EXPECT_EQ(at<std::uint8_t>(bytes, second + 2), 9);        // float
  EXPECT_EQ(bytes.substr(second + 4, 6), std::string("range\0", 6));
  EXPECT_EQ(bytes.size(), begin + 3 * 36);
  const std::size_t last = begin + 2 * 36;
  EXPECT_EQ(at<std::int32_t>(bytes, last + 4), -2147483647);
  EXPECT_EQ(at<std::uint8_t>(bytes, last + 14), 2 | 2 << 4);
  EXPECT_EQ(at<std::uint16_t>(bytes, last + 30), 259);
  EXPECT_EQ(at<float>(bytes, last + 32), 1e-30F);
}

// Oracles: our reader; the formats of tables 17 and 18.
TEST(LasWriter, ColoursAnglesAndFlagsAreKept) {
  const TemporaryFolder folder;
  const Points points;
  const std::vector<std::uint16_t> red = {0, 256, 65535}, green = {1, 2, 3}, blue = {9, 8, 7},
                                   nir = {5, 0, 6};
  const std::vector<std::int16_t> angle = {-3000, 0, 167};
  const std::vector<std::uint8_t> overlap = {0, 1, 0}, channel = {3, 0, 2}, edge = {1, 0, 0},
                                  number = {0, 1, 15};
  std::vector<ColumnView> columns = points.columns();
  columns[5].data = number.data();
  columns.push_back({"red", ColumnType::u16, red.data(), 2});
  columns.push_back({"green", ColumnType::u16, green.data(), 2});
  EXPECT_THROW(write_las(folder.path() / "a.las", 3, columns), std::logic_error);
  columns.push_back({"blue", ColumnType::u16, blue.data(), 2});
  columns.push_back({"scan_angle", ColumnType::i16, angle.data(), 2});
  columns.push_back({"overlap", ColumnType::u8, overlap.data(), 1});
  columns.push_back({"scanner_channel", ColumnType::u8, channel.data(), 1});
  columns.push_back({"edge_of_flight_line", ColumnType::u8, edge.data(), 1});
  for (const std::size_t format : {7U, 8U}) {
    if (format == 8) columns.push_back({"nir", ColumnType::u16, nir.data(), 2});
    for (const char* const name : {"a.las", "a.laz"}) {
      const auto path = folder.path() / name;
      write_las(path, 3, columns, {.labels = "mine", .is_packed = is_laz_name(path)});
      EXPECT_EQ(read_las_facts(path).point_format, format);
      EXPECT_EQ(read_las_facts(path).labels, "mine");
      const Table table = read_las(path, {.all_fields = true});
      EXPECT_EQ(values_of(table, "red"), doubles(red));
      EXPECT_EQ(values_of(table, "green"), doubles(green));
      EXPECT_EQ(values_of(table, "blue"), doubles(blue));
      EXPECT_EQ(values_of(table, "overlap"), doubles(overlap));
      EXPECT_EQ(values_of(table, "scanner_channel"), doubles(channel));
      EXPECT_EQ(values_of(table, "edge_of_flight_line"), doubles(edge));
      EXPECT_EQ(values_of(table, "return_number"), doubles(number));
      EXPECT_EQ(values_of(table, "label"), doubles(points.label));
      EXPECT_NEAR(values_of(table, "scan_angle")[0], -18.0, 1e-5);
      EXPECT_EQ(table.find("synthetic"), nullptr);  // all 0
      EXPECT_EQ(table.find("nir") != nullptr, format == 8);
      if (format == 8) {
        EXPECT_EQ(values_of(table, "nir"), doubles(nir));
      }
      EXPECT_EQ(read_las(path).find("overlap"), nullptr);
    }
  }
}

TEST(LasWriter, OffsetKeepsLargeCoordinates) {
  const TemporaryFolder folder;
  const std::vector<double> x = {448262.123, 448262.124};
  const ColumnView columns[] = {{"x", ColumnType::f64, x.data(), 8},
                                {"y", ColumnType::f64, x.data(), 8},
                                {"z", ColumnType::f64, x.data(), 8}};
  LasWriteOptions options;
  options.scale_m = 1e-5;
  const auto path = folder.path() / "a.las";
  expect_error(ErrorKind::data, {"a.las", "point 0", "x = 448262.123"},
               [&] { write_las(path, 2, columns, options); });
  EXPECT_EQ(folder.file_count(), 0U);
  options.offset_m = {448000, 448000, 448000};
  write_las(path, 2, columns, options);
  const Table table = read_las(path);
  EXPECT_NEAR(values_of(table, "x")[1], 448262.124, 1e-9);
  EXPECT_EQ(values_of(table, "return_number")[1], 1);
  EXPECT_EQ(values_of(table, "number_of_returns")[1], 1);
}

// Oracles: our reader; table 4 of the specification, bit 4.
TEST(LasWriter, TheCoordinateSystemIsKept) {
  const TemporaryFolder folder;
  const Points points;
  const auto path = folder.path() / "a.las";
  LasWriteOptions options;
  options.crs = crs_of_wkt("PROJCS[\"UTM\",AUTHORITY[\"EPSG\",\"32632\"]]");
  write_las(path, 3, points.columns(), options);
  std::string bytes = read_file(path);
  EXPECT_EQ(at<std::uint16_t>(bytes, 6), 16);
  EXPECT_EQ(at<std::uint32_t>(bytes, 100), 2U);
  EXPECT_EQ(bytes.substr(375 + 2, 16), std::string("LASF_Projection\0", 16));
  EXPECT_EQ(at<std::uint16_t>(bytes, 375 + 18), 2112);
  EXPECT_EQ(bytes.substr(375 + 54, at<std::uint16_t>(bytes, 375 + 20)),
            options.crs.wkt + std::string(1, '\0'));
  EXPECT_EQ(read_las(path).crs, options.crs);
  EXPECT_EQ(values_of(read_las(path), "label"), doubles(points.label));
  options.crs = {{}, {{1, 1, 0, 2, 3072, 0, 1, 26910, 3078, 34736, 1, 1}, {0.5, 2}, "site|"}};
  write_las(path, 3, points.columns(), options);
  bytes = read_file(path);
  EXPECT_EQ(at<std::uint16_t>(bytes, 6), 0);
  EXPECT_EQ(at<std::uint32_t>(bytes, 100), 4U);
  EXPECT_EQ(read_las(path).crs, options.crs);
  EXPECT_EQ(values_of(read_las(path), "label"), doubles(points.label));
  options.crs = crs_of_wkt(std::string(70000, 'x'));
  expect_error(ErrorKind::data, {"a.las", "2112", "70001"},
               [&] { write_las(path, 3, points.columns(), options); });
}

TEST(LasWriter, NoPointsAndNoExtraBytes) {
  const TemporaryFolder folder;
  const ColumnView columns[] = {{"x", ColumnType::f32, nullptr, 4},
                                {"y", ColumnType::f32, nullptr, 4},
                                {"z", ColumnType::f32, nullptr, 4}};
  write_las(folder.path() / "a.las", 0, columns);
  EXPECT_EQ(read_file(folder.path() / "a.las").size(), 375U);
  EXPECT_EQ(read_las(folder.path() / "a.las").rows, 0U);
}

TEST(LasWriter, DataThatLasCannotStore) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.las";
  Points points;
  points.y[1] = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorKind::data, {"point 1", "y"}, [&] { write_las(path, 3, points.columns()); });
  points = {};
  points.x[2] = 3e6F;
  expect_error(ErrorKind::data, {"point 2", "x"}, [&] { write_las(path, 3, points.columns()); });
  points = {};
  points.return_number[1] = 16;
  expect_error(ErrorKind::data, {"point 1", "return"},
               [&] { write_las(path, 3, points.columns()); });
  points = {};
  std::vector<ColumnView> columns = points.columns();
  columns[3].type = ColumnType::f32;
  EXPECT_THROW(write_las(path, 3, columns), std::logic_error);
  columns = points.columns();
  columns.erase(columns.begin());
  EXPECT_THROW(write_las(path, 3, columns), std::logic_error);
  columns = points.columns();
  const std::string longer(32, 'a');
  columns[4].name = longer;
  EXPECT_THROW(write_las(path, 3, columns), std::logic_error);
  EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace adasplats
