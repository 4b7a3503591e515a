// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ept/ept_tile.h"

#include <gtest/gtest.h>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/bags/recording_files_test.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

using io_test::bytes_of;
using io_test::values_of;

const std::string kFacts =
    R"({"dataType": "binary", "points": 2, "srs": {"wkt": "+proj=geocent"}, "schema": [
        {"name": "X", "type": "signed", "size": 4, "scale": 0.01, "offset": 500000},
        {"name": "Y", "type": "signed", "size": 4, "scale": 0.01, "offset": 0},
        {"name": "Z", "type": "float", "size": 8},
        {"name": "Intensity", "type": "unsigned", "size": 2},
        {"name": "Classification", "type": "unsigned", "size": 1}]})";

std::string record(std::int32_t x, std::int32_t y, double z, std::uint16_t i, std::uint8_t c) {
  return bytes_of(x) + bytes_of(y) + bytes_of(z) + bytes_of(i) + bytes_of(c);
}

TEST(EptTile, RecordsByTheSchema) {
  const TemporaryFolder folder;
  folder.write("ept.json", kFacts);
  const auto tile = folder.write("ept-data/0-0-0-0.bin",
                                 record(100, -200, 3.5, 40000, 2) + record(101, 7, -1, 5, 66));
  ASSERT_TRUE(is_ept_tile(tile));
  EXPECT_EQ(ept_tile_points(tile), 2U);
  const Table table = read_points(tile);  // not as a KITTI scan
  ASSERT_EQ(table.rows, 2U);
  EXPECT_EQ(values_of(table, "x"), (std::vector<double>{500001, 500001.01}));
  EXPECT_EQ(values_of(table, "y"), (std::vector<double>{-2, 0.07}));
  EXPECT_EQ(values_of(table, "z"), (std::vector<double>{3.5, -1}));
  EXPECT_EQ(values_of(table, "Intensity"), (std::vector<double>{40000, 5}));
  EXPECT_EQ(values_of(table, "Classification"), (std::vector<double>{2, 66}));
  EXPECT_TRUE(read_crs(tile).empty());
}

TEST(EptTile, TheHierarchyCounts) {
  const TemporaryFolder folder;
  folder.write("ept.json", "{\"points\": 10}");
  EXPECT_EQ(ept_stated_points(folder.path()), 10U);
  folder.write("ept-hierarchy/0-0-0-0.json", "{\"0-0-0-0\": 3, \"1-0-0-0\": -1}");
  folder.write("ept-hierarchy/1-0-0-0.json", "{\"1-0-0-0\": 2}");
  EXPECT_EQ(ept_stated_points(folder.path()), 5U);
}

TEST(EptTile, Zstandard) {
  const TemporaryFolder folder;
  folder.write("ept.json", R"({"dataType": "zstandard", "points": 125, "schema": [
      {"name": "X", "type": "signed", "size": 4}, {"name": "Y", "type": "signed", "size": 4}]})");
  const auto tile = folder.write("ept-data/0-0-0-0.zst", bags_test::kPackedZeros[0].bytes);
  // As Entwine writes it: a frame that does not state its size (RFC 8878), one raw block.
  const auto other = folder.write("ept-data/1-0-0-0.zst",
                                  std::string("\x28\xb5\x2f\xfd\0\0\x41\0\0", 9) +
                                      bytes_of(std::int32_t{-3}) + bytes_of(std::int32_t{9}));
  try {
    EXPECT_EQ(ept_tile_points(tile), 125U);
    EXPECT_EQ(values_of(read_points(tile), "y"), std::vector<double>(125));
    EXPECT_EQ(values_of(read_points(other), "x"), std::vector<double>{-3});
    EXPECT_EQ(values_of(read_points(other), "y"), std::vector<double>{9});
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unavailable) << error.what();
  }
}

TEST(EptTile, OtherFilesAreNoTiles) {
  const TemporaryFolder folder;
  EXPECT_FALSE(is_ept_tile(folder.write("ept-data/0-0-0-0.bin", "x")));  // no ept.json
  folder.write("ept.json", kFacts);
  EXPECT_FALSE(is_ept_tile(folder.write("velodyne/000000.bin", "x")));
  EXPECT_FALSE(is_ept_tile(folder.write("ept-data/0-0-0-0.laz", "x")));
}

TEST(EptTile, Damage) {
  const TemporaryFolder folder;
  const auto tile = folder.write("ept-data/0-0-0-0.bin", record(1, 2, 3, 4, 5) + "x");
  const auto reject = [&](const std::vector<std::string>& parts, const std::string& facts) {
    folder.write("ept.json", facts);
    expect_error(ErrorKind::data, parts, [&] { read_points(tile); });
  };
  reject({"0-0-0-0.bin", "20 bytes", "points of 19 bytes"}, kFacts);
  reject({"ept.json", "not a JSON object"}, "{");
  reject({"ept.json", "array of dimensions"}, "{}");
  reject({"ept.json", "'X'", "size 3"},
         R"({"schema": [{"name": "X", "type": "signed", "size": 3}]})");
  reject({"ept.json", "'scale' is not a number"},
         R"({"schema": [{"name": "X", "type": "signed", "size": 4, "scale": "1"}]})");
  reject({"two dimensions 'x'"}, R"({"schema": [{"name": "X", "type": "signed", "size": 4},
                                     {"name": "X", "type": "signed", "size": 1}]})");
}

}  // namespace
}  // namespace adasplats
