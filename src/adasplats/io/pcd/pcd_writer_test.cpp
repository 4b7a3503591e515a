// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pcd/pcd_writer.h"

#include <gtest/gtest.h>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

using io_test::values_of;

// Oracle: our reader, whose tests have files that PCL wrote.
TEST(PcdWriter, RoundTripOfEveryType) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.pcd";
  const std::vector<float> x = {1.5F, -2.25F, 1e30F};
  const std::vector<double> time = {1e300, 0, -1};
  const std::vector<std::uint8_t> u8 = {0, 1, 255};
  const std::vector<std::uint16_t> u16 = {0, 1, 65535};
  const std::vector<std::uint32_t> u32 = {0, 1, 0xffffffff};
  const std::vector<std::int32_t> i32 = {0, -1, 2147483647};
  const ColumnView columns[] = {
      {"x", ColumnType::f32, x.data(), 4},     {"time", ColumnType::f64, time.data(), 8},
      {"u8", ColumnType::u8, u8.data(), 1},    {"u16", ColumnType::u16, u16.data(), 2},
      {"u32", ColumnType::u32, u32.data(), 4}, {"i32", ColumnType::i32, i32.data(), 4}};
  write_pcd(path, 3, columns);
  const Table table = read_pcd(path);
  EXPECT_EQ(table.rows, 3U);
  EXPECT_EQ(values_of(table, "x"), std::vector<double>(x.begin(), x.end()));
  EXPECT_EQ(values_of(table, "time"), time);
  EXPECT_EQ(values_of(table, "u8"), std::vector<double>(u8.begin(), u8.end()));
  EXPECT_EQ(values_of(table, "u16"), std::vector<double>(u16.begin(), u16.end()));
  EXPECT_EQ(values_of(table, "u32"), std::vector<double>(u32.begin(), u32.end()));
  EXPECT_EQ(values_of(table, "i32"), std::vector<double>(i32.begin(), i32.end()));
}

// Oracle: the file that the format's description prints, by hand.
TEST(PcdWriter, Bytes) {
  const TemporaryFolder folder;
  const std::vector<float> points = {1, 2, 3, 4};
  const ColumnView columns[] = {{"x", ColumnType::f32, points.data(), 8},
                                {"y", ColumnType::f32, points.data() + 1, 8}};
  write_pcd(folder.path() / "a.pcd", 2, columns, {448262.25, -0.5, 0, 0.5, 0.5, -0.5, 0.5});
  std::string expected =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\n"
      "COUNT 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 448262.25 -0.5 0 0.5 0.5 -0.5 0.5\nPOINTS 2\n"
      "DATA binary\n";
  for (const float value : points) expected += io_test::bytes_of(value);
  EXPECT_EQ(read_file(folder.path() / "a.pcd"), expected);
}

TEST(PcdWriter, NoPointsAndBadNames) {
  const TemporaryFolder folder;
  const ColumnView none[] = {{"x", ColumnType::f32, nullptr, 4}};
  write_pcd(folder.path() / "a.pcd", 0, none);
  EXPECT_EQ(read_pcd(folder.path() / "a.pcd").rows, 0U);
  const ColumnView bad[] = {{"a b", ColumnType::f32, nullptr, 4}};
  EXPECT_THROW(write_pcd(folder.path() / "b.pcd", 0, bad), std::logic_error);
  EXPECT_EQ(folder.file_count(), 1U);
}

}  // namespace
}  // namespace adasplats
