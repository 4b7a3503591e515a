// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ept/potree_octree.h"

#include <gtest/gtest.h>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

using io_test::bytes_of;
using io_test::values_of;

/// As PotreeConverter 2.1 writes it.
std::string metadata(const std::string& encoding, int points) {
  return R"({"version": "2.0", "points": )" + std::to_string(points) +
         R"(, "projection": "", "hierarchy": {"firstChunkSize": 22},
        "offset": [1000, 2000, 0], "scale": [0.001, 0.001, 0.01], "encoding": ")" +
         encoding + R"(", "attributes": [
        {"name": "position", "size": 12, "numElements": 3, "elementSize": 4, "type": "int32",
         "scale": [1, 1, 1], "offset": [0, 0, 0]},
        {"name": "intensity", "size": 2, "numElements": 1, "elementSize": 2, "type": "uint16"},
        {"name": "gps-time", "size": 8, "numElements": 1, "elementSize": 8, "type": "double"},
        {"name": "rgb", "size": 6, "numElements": 3, "elementSize": 2, "type": "uint16"}]})";
}

std::string point_bytes(std::int32_t x, std::uint16_t intensity) {
  return bytes_of(x) + bytes_of(std::int32_t{-5}) + bytes_of(std::int32_t{7}) +
         bytes_of(intensity) + bytes_of(14323.5) + bytes_of(std::uint16_t{1}) +
         bytes_of(std::uint16_t{2}) + bytes_of(std::uint16_t{3});
}

TEST(PotreeOctree, AllPoints) {
  const TemporaryFolder folder;
  folder.write("metadata.json", metadata("DEFAULT", 2));
  const auto file = folder.write("octree.bin", point_bytes(1, 60000) + point_bytes(2500, 0));
  ASSERT_TRUE(is_potree_octree(file));
  const Table table = read_points(file);
  EXPECT_EQ(values_of(table, "x"), (std::vector<double>{1000.001, 1002.5}));
  EXPECT_EQ(values_of(table, "y"), (std::vector<double>{1999.995, 1999.995}));
  EXPECT_EQ(values_of(table, "z"), (std::vector<double>{0.07, 0.07}));
  EXPECT_EQ(values_of(table, "intensity"), (std::vector<double>{60000, 0}));
  EXPECT_EQ(values_of(table, "gps-time"), (std::vector<double>{14323.5, 14323.5}));
  EXPECT_EQ(values_of(table, "blue"), (std::vector<double>{3, 3}));
}

TEST(PotreeOctree, WhatCannotBeRead) {
  const TemporaryFolder folder;
  const auto file = folder.write("octree.bin", point_bytes(1, 2));
  EXPECT_FALSE(is_potree_octree(file));
  const auto reject = [&](const std::vector<std::string>& parts, const std::string& facts) {
    folder.write("metadata.json", facts);
    expect_error(ErrorKind::data, parts, [&] { read_points(file); });
  };
  reject({"metadata.json", "'BROTLI'", "LAZ"}, metadata("BROTLI", 1));
  reject({"octree.bin", "holds 1 points", "states 2"}, metadata("DEFAULT", 2));
  reject({"metadata.json", "no attributes"}, R"({"encoding": "DEFAULT", "points": 1})");
  reject({"metadata.json", "attribute 'a'", "'half'"},
         R"({"encoding": "DEFAULT", "points": 1,
             "attributes": [{"name": "a", "type": "half", "numElements": 1}]})");
}

}  // namespace
}  // namespace adasplats
