// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_files.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

using Doubles = std::vector<double>;

Doubles column(const Table& table, std::string_view name) {
  Doubles values;
  const Column* found = table.find(name);
  if (found == nullptr) return values;
  for (std::size_t i = 0; i < table.rows; ++i) values.push_back(found->as_double(i));
  return values;
}

Doubles doubles(const auto& values) { return {values.begin(), values.end()}; }

/// A scan whose firings return once, twice, twice with the first one dropped, and once.
Scan scan_with_returns() {
  Scan scan = scan_number(8, 5);
  scan.rings = {0, 0, 0, 0, 1};
  scan.columns = {4, 5, 5, 6, 6};
  scan.return_indices = {0, 0, 1, 1, 0};
  return scan;
}

void expect_columns_of(const Table& table, const Scan& scan) {
  ASSERT_EQ(table.rows, scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec3d p{column(table, "x")[i], column(table, "y")[i], column(table, "z")[i]};
    EXPECT_TRUE(p == vec_cast<double>(scan.positions[i]));
  }
  EXPECT_EQ(column(table, "intensity"), doubles(scan.intensities));
  EXPECT_EQ(column(table, "label"), doubles(scan.classes));
  EXPECT_EQ(column(table, "instance"), doubles(scan.instances));
  EXPECT_EQ(column(table, "ring"), doubles(scan.rings));
  EXPECT_EQ(column(table, "column"), doubles(scan.columns));
  const Doubles times = column(table, "time");
  ASSERT_EQ(times.size(), scan.knots.empty() ? 0 : scan.times_s.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR(times[i], static_cast<double>(scan.times_s[i]) - 0.05, 1e-8);
  EXPECT_EQ(column(table, "range"), doubles(scan.ranges_m));
  EXPECT_EQ(column(table, "return_index"), doubles(scan.return_indices));
}

// Oracle: round trip through read_ply and read_pcd.
TEST(ScanFiles, PlyAndPcd) {
  const TemporaryFolder folder;
  for (const Scan& scan : {scan_number(3, 20), scan_with_returns(), scan_number(1, 1)}) {
    write_scan_ply(folder.path() / "scan.ply", scan);
    const Table ply = read_ply(folder.path() / "scan.ply");
    expect_columns_of(ply, scan);
    EXPECT_EQ(ply.columns.size(), scan.return_indices.empty() ? 10U : 11U);
    write_scan_pcd(folder.path() / "scan.pcd", scan);
    expect_columns_of(read_pcd(folder.path() / "scan.pcd"), scan);
  }
}

// Oracle: a quarter turn to the left about z is the quaternion (sqrt(1/2), 0, 0, sqrt(1/2)).
TEST(ScanFiles, ViewpointOfPcd) {
  const TemporaryFolder folder;
  Scan scan = scan_number(0, 1);
  scan.world_from_sensor = {{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, {5, -1.5, 0.25}};
  write_scan_pcd(folder.path() / "scan.pcd", scan);
  const std::string text = read_file(folder.path() / "scan.pcd");
  EXPECT_NE(text.find("\nVIEWPOINT 5 -1.5 0.25 0.70710678118654"), std::string::npos) << text;
  EXPECT_NE(text.find(" 0 0 0.70710678118654"), std::string::npos) << text;
}

TEST(ScanFiles, EmptyScansAndScansWithoutAttributes) {
  const TemporaryFolder folder;
  Scan bare = scan_number(2, 3);
  bare.intensities.clear();
  bare.classes.clear();
  bare.instances.clear();
  Scan still = bare;
  still.knots.clear();
  still.duration_s = 0;
  for (const Scan& scan : {Scan{}, bare, still}) {
    write_scan_ply(folder.path() / "scan.ply", scan);
    EXPECT_EQ(read_ply(folder.path() / "scan.ply").columns.size(), scan.knots.empty() ? 6U : 7U);
    expect_columns_of(read_ply(folder.path() / "scan.ply"), scan);
    write_scan_pcd(folder.path() / "scan.pcd", scan);
    expect_columns_of(read_pcd(folder.path() / "scan.pcd"), scan);
    write_scan_las(folder.path() / "scan.las", scan);
    EXPECT_EQ(read_las(folder.path() / "scan.las").rows, scan.size());
    write_scan_npz(folder.path() / "scan.npz", scan);
    write_scan_npy(folder.path() / "scan.npy", scan);
    EXPECT_EQ(read_file(folder.path() / "scan.npz").find("labels.npy"), std::string::npos);
    EXPECT_NE(read_file(folder.path() / "scan.npz").find("rings.npy"), std::string::npos);
  }
}

// Oracle: round trip through read_las; LAS holds millimetres, 16 bits of intensity, classes
// up to 255 in the field of its own and all of them in `label`.
TEST(ScanFiles, Las) {
  const TemporaryFolder folder;
  Scan scan = scan_with_returns();
  scan.intensities = {0, 0.5F, 1, 7, std::numeric_limits<float>::quiet_NaN()};
  scan.classes = {0, 40, 255, 256, 259};
  write_scan_las(folder.path() / "scan.las", scan);
  const Table table = read_las(folder.path() / "scan.las");
  ASSERT_EQ(table.rows, 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(column(table, "x")[i], static_cast<double>(scan.positions[i].x), 0.000501);
    EXPECT_NEAR(column(table, "z")[i], static_cast<double>(scan.positions[i].z), 0.000501);
    EXPECT_EQ(column(table, "gps_time")[i],
              scan.time_s - 0.05 + static_cast<double>(scan.times_s[i]));
  }
  EXPECT_EQ(column(table, "intensity"), (Doubles{0, 32768, 65535, 65535, 0}));
  EXPECT_EQ(column(table, "classification"), (Doubles{0, 40, 255, 0, 0}));
  EXPECT_EQ(column(table, "label"), (Doubles{0, 40, 255, 256, 259}));
  EXPECT_EQ(column(table, "return_number"), (Doubles{1, 1, 2, 2, 1}));
  EXPECT_EQ(column(table, "number_of_returns"), (Doubles{1, 2, 2, 2, 1}));
  const std::string bytes = read_file(folder.path() / "scan.las");
  for (const char* name : {"intensity_value", "label", "instance", "ring", "column", "range"})
    EXPECT_NE(bytes.find(name), std::string::npos) << name;
  write_scan_las(folder.path() / "scan.las", scan, 255);
  EXPECT_EQ(column(read_las(folder.path() / "scan.las"), "intensity")[2], 257);
}

// Oracle: the same scan as LAS.
TEST(ScanFiles, LazMatchesLas) {
  const TemporaryFolder folder;
  const Scan scan = scan_with_returns();
  write_scan_las(folder.path() / "scan.las", scan);
  write_scan_las(folder.path() / "scan.laz", scan);
  const std::string bytes = read_file(folder.path() / "scan.laz");
  EXPECT_NE(bytes.find("laszip encoded"), std::string::npos);
  const Table wanted = read_las(folder.path() / "scan.las");
  const Table found = read_las(folder.path() / "scan.laz");
  ASSERT_EQ(found.rows, wanted.rows);
  ASSERT_EQ(found.columns.size(), wanted.columns.size());
  for (std::size_t k = 0; k < found.columns.size(); ++k)
    EXPECT_EQ(found.columns[k].values, wanted.columns[k].values) << found.columns[k].name;
  const auto files = encode_scan_files(ScanFormat::laz, "scan", scan);
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].bytes, bytes);
}

TEST(ScanFiles, LasWithoutLabels) {
  const TemporaryFolder folder;
  Scan scan = scan_number(2, 2);
  scan.classes.clear();
  scan.intensities.clear();
  write_scan_las(folder.path() / "scan.las", scan);
  scan.knots.clear();
  scan.duration_s = 0;
  write_scan_las(folder.path() / "still.las", scan);
  EXPECT_EQ(column(read_las(folder.path() / "still.las"), "gps_time"),
            (Doubles{scan.time_s, scan.time_s}));
  const Table table = read_las(folder.path() / "scan.las");
  EXPECT_EQ(column(table, "classification"), (Doubles{0, 0}));
  EXPECT_EQ(column(table, "intensity"), (Doubles{0, 0}));
}

// Oracle: by hand.
TEST(ScanValues, ReturnsOfFirings) {
  EXPECT_TRUE(returns_of_firings({}).empty());
  EXPECT_EQ(returns_of_firings(scan_number(0, 2)), (std::vector<std::uint8_t>{1, 1}));
  EXPECT_EQ(returns_of_firings(scan_with_returns()), (std::vector<std::uint8_t>{1, 2, 2, 2, 1}));
  // Firings of a pattern whose columns all have one number.
  Scan free = scan_with_returns();
  free.rings.assign(5, 0);
  free.columns.assign(5, 0);
  free.return_indices = {0, 1, 0, 1, 2};
  EXPECT_EQ(returns_of_firings(free), (std::vector<std::uint8_t>{2, 2, 3, 3, 3}));
}

TEST(ScanValues, UnknownIntensityIsZero) {
  Scan scan = scan_number(0, 2);
  scan.intensities[1] = std::numeric_limits<float>::quiet_NaN();
  std::array<float, 8> values;
  const std::string bytes = points_with_intensity(scan);
  ASSERT_EQ(bytes.size(), sizeof(values));
  std::memcpy(values.data(), bytes.data(), sizeof(values));
  EXPECT_EQ(values[3], scan.intensities[0]);
  EXPECT_EQ(values[7], 0.0F);
}

// Oracle: the .npy format, version 1.0: magic, header length at byte 8, then the values.
template <class T>
std::vector<T> npy_values(const std::string& bytes, const std::string& shape) {
  std::uint16_t header_length = 0;
  std::memcpy(&header_length, bytes.data() + 8, sizeof(header_length));
  EXPECT_NE(bytes.substr(10, header_length).find(shape), std::string::npos);
  const std::size_t begin = 10U + header_length;
  std::vector<T> values((bytes.size() - begin) / sizeof(T));
  std::memcpy(values.data(), bytes.data() + begin, values.size() * sizeof(T));
  return values;
}

TEST(ScanFiles, Npy) {
  const TemporaryFolder folder;
  const Scan scan = scan_number(4, 5);
  write_scan_npy(folder.path() / "scan.npy", scan);
  const auto points = npy_values<float>(read_file(folder.path() / "scan.npy"), "(5, 4)");
  const auto labels =
      npy_values<std::uint32_t>(read_file(folder.path() / "scan_label.npy"), "(5,)");
  ASSERT_EQ(points.size(), 20U);
  ASSERT_EQ(labels.size(), 5U);
  EXPECT_EQ(points[4 * 3 + 2], scan.positions[3].z);
  EXPECT_EQ(points[4 * 3 + 3], scan.intensities[3]);
  EXPECT_EQ(labels[2], scan.instances[2] * 65536U + scan.classes[2]);
}

/// The stored file `name` of a zip archive, found by its local header.
std::string member(const std::string& zip, const std::string& name) {
  const std::size_t place = zip.find(name);
  if (place == std::string::npos || place < 30) return "";
  std::uint32_t bytes = 0;
  std::memcpy(&bytes, zip.data() + place - 30 + 22, sizeof(bytes));
  return zip.substr(place + name.size(), bytes);
}

// Oracle: as for Npy; the archive itself has tests of its own.
TEST(ScanFiles, Npz) {
  const TemporaryFolder folder;
  Scan scan = scan_with_returns();
  scan.world_from_sensor = {{}, {5, 1, 0.5}};
  write_scan_npz(folder.path() / "scan.npz", scan);
  const std::string zip = read_file(folder.path() / "scan.npz");
  const auto points = npy_values<float>(member(zip, "points.npy"), "(5, 3)");
  ASSERT_EQ(points.size(), 15U);
  EXPECT_EQ(points[3 * 4 + 1], scan.positions[4].y);
  EXPECT_EQ(npy_values<float>(member(zip, "intensities.npy"), "(5,)"), scan.intensities);
  EXPECT_EQ(npy_values<std::uint16_t>(member(zip, "labels.npy"), "(5,)"), scan.classes);
  EXPECT_EQ(npy_values<std::uint16_t>(member(zip, "instances.npy"), "(5,)"), scan.instances);
  EXPECT_EQ(npy_values<std::uint16_t>(member(zip, "rings.npy"), "(5,)"), scan.rings);
  EXPECT_EQ(npy_values<std::uint32_t>(member(zip, "columns.npy"), "(5,)"), scan.columns);
  EXPECT_EQ(npy_values<float>(member(zip, "times.npy"), "(5,)"), times_from_pose(scan));
  EXPECT_EQ(npy_values<float>(member(zip, "ranges.npy"), "(5,)"), scan.ranges_m);
  EXPECT_EQ(npy_values<std::uint8_t>(member(zip, "return_indices.npy"), "(5,)"),
            scan.return_indices);
  EXPECT_EQ(npy_values<double>(member(zip, "world_from_sensor.npy"), "(4, 4)"),
            (Doubles{1, 0, 0, 5, 0, 1, 0, 1, 0, 0, 1, 0.5, 0, 0, 0, 1}));
  EXPECT_EQ(npy_values<double>(member(zip, "time.npy"), "(1,)"), Doubles{scan.time_s});
}

}  // namespace
}  // namespace adasplats
