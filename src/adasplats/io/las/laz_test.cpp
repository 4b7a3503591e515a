// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/laz/laz_samples_test.h"

namespace adasplats {
namespace {

using io_test::put;
using laz_test::kLazSamples;
using laz_test::laz_file;
using laz_test::LazSample;

Table read_bytes(const std::string& content, const LasReadOptions& options = {}) {
  const TemporaryFolder folder;
  return read_las(folder.write("file.laz", content), options);
}

void expect_broken(const std::string& content, const std::vector<std::string>& parts) {
  expect_error(ErrorKind::data, parts, [&] { read_bytes(content); });
}

void expect_equal_columns(const Table& found, const Table& expected) {
  ASSERT_EQ(found.rows, expected.rows);
  ASSERT_EQ(found.columns.size(), expected.columns.size());
  for (std::size_t k = 0; k < found.columns.size(); ++k) {
    EXPECT_EQ(found.columns[k].name, expected.columns[k].name);
    EXPECT_EQ(found.columns[k].values, expected.columns[k].values) << found.columns[k].name;
  }
}

std::size_t points_at(const std::string& file) {
  std::uint32_t at = 0;
  std::memcpy(&at, file.data() + 96, sizeof at);
  return at;
}

std::size_t table_at(const std::string& file) {
  std::uint64_t at = 0;
  std::memcpy(&at, file.data() + points_at(file), sizeof at);
  return static_cast<std::size_t>(at);
}

/// "chunks of points": format 5, three chunks of 16, 16 and 8 points.
const LazSample& chunked() { return kLazSamples[1]; }
/// "layers, variable chunks, ...": format 10.
const LazSample& layered() { return kLazSamples[2]; }

// Oracle: the records that LASzip was given, read as LAS.
TEST(Laz, HasTheColumnsOfTheCompressedRecords) {
  const Executor executor(2);
  for (const LazSample& sample : kLazSamples) {
    SCOPED_TRACE(sample.name);
    const Table expected = read_bytes(las_file(sample));
    ASSERT_EQ(expected.rows, sample.rows);
    ASSERT_NE(expected.find("both"), nullptr);
    expect_equal_columns(read_bytes(laz_file(sample)), expected);
    expect_equal_columns(read_bytes(laz_file(sample), {.executor = &executor}), expected);
  }
}

// A box of the header that the points are not in: unpacked from broken data, most likely.
TEST(Laz, PointsOutsideTheBoxAreAFault) {
  std::string file = laz_file(chunked());
  for (const std::size_t axis : {0U, 1U, 2U}) {
    put(file, 179 + 16 * axis, 1000.0);
    put(file, 187 + 16 * axis, -1000.0);
  }
  EXPECT_EQ(read_bytes(file).rows, 40U);
  put(file, 179, 20.0);  // x
  expect_broken(file, {"damaged LAZ at point ", "of 40", "outside the header's box"});
  const Table salvaged = read_bytes(file, {.salvage = true});
  EXPECT_LT(salvaged.rows, 40U);
  EXPECT_GT(salvaged.rows, 0U);
}

TEST(Laz, TheOffsetOfTheChunkTableMayBeAtTheEnd) {
  for (const LazSample& sample : {chunked(), layered()}) {
    std::string file = laz_file(sample);
    const std::uint64_t table = table_at(file);
    put(file, points_at(file), ~std::uint64_t{0});
    expect_equal_columns(read_bytes(file + io_test::bytes_of(table)), read_bytes(las_file(sample)));
    expect_broken(file + io_test::bytes_of(std::uint64_t{1} << 60), {"chunk table"});
  }
}

// As a writer leaves it that was interrupted, and as a copy that was.
TEST(Laz, WithoutATableChunksAreReadOneByOne) {
  std::string file = laz_file(chunked());
  const Table expected = read_bytes(las_file(chunked()));
  const std::uint64_t points = points_at(file);
  std::string interrupted = file.substr(0, table_at(file));
  put(interrupted, points, points);
  expect_equal_columns(read_bytes(interrupted), expected);
  const std::string cut = file.substr(0, table_at(file));
  expect_broken(cut, {"chunk table", "outside the file"});
  expect_equal_columns(read_bytes(cut, {.salvage = true}), expected);
  // Within the last chunk.
  const Table salvaged = read_bytes(cut.substr(0, cut.size() - 30), {.salvage = true});
  EXPECT_GE(salvaged.rows, 32U);
  EXPECT_LT(salvaged.rows, 40U);
  const ReaderNote note = {NoteKind::salvaged, std::to_string(salvaged.rows) + " of 40 records"};
  EXPECT_EQ(salvaged.notes.back(), note);

  std::string variable = laz_file(layered());
  put(variable, points_at(variable), std::uint64_t{points_at(variable)});
  expect_broken(variable, {"no chunk table", "variable size"});
}

TEST(Laz, BrokenTablesAreErrors) {
  const std::string file = laz_file(chunked());
  const std::size_t table = table_at(file);
  std::string broken = file;
  put(broken, table, std::uint32_t{1});
  expect_broken(broken, {"version 1 of the chunk table"});
  broken = file;
  put(broken, table + 4, std::uint32_t{0xffffffff});
  expect_broken(broken, {"4294967295 chunks"});
  broken = file;
  put(broken, table + 4, std::uint32_t{2});
  expect_broken(broken, {"chunk table has 32 points", "states 40"});
  broken = file;
  put(broken, points_at(file), std::uint64_t{10});
  expect_broken(broken, {"byte 10", "before the points"});
  // 2^32 points in some hundred bytes: reported before anything is allocated.
  broken = laz_file(layered());
  put(broken, 247, std::uint64_t{1} << 40);
  expect_broken(broken, {"chunk table has 40 points", "1099511627776"});
}

TEST(Laz, UnknownCompressionIsAnError) {
  const std::string file = laz_file(chunked());
  const std::size_t record = file.find("laszip encoded") - 2 + 54;
  const auto with = [&](std::size_t at, auto value) {
    std::string changed = file;
    put(changed, record + at, value);
    return changed;
  };
  expect_broken(with(0, std::uint16_t{0}), {"compressor 0"});
  expect_broken(with(0, std::uint16_t{3}), {"compressor 3 for point format 5"});
  expect_broken(with(2, std::uint16_t{1}), {"coder 1"});
  expect_broken(with(32, std::uint16_t{2}), {"'laszip encoded' is damaged", "65 bytes"});
  expect_broken(with(34, std::uint16_t{10}), {"'laszip encoded' is damaged"});
  expect_broken(with(38, std::uint16_t{3}), {"version 3 of item 6"});
}

// Of every chunk the second half: nothing but an error, whichever model meets the zeros.
TEST(Laz, ChunksThatEndEarlyAreErrors) {
  for (const LazSample& sample : kLazSamples) {
    SCOPED_TRACE(sample.name);
    const std::string file = laz_file(sample);
    const std::size_t points = points_at(file);
    const std::string cut = file.substr(0, points + (file.size() - points) / 2);
    expect_error(ErrorKind::data, {"file.laz"}, [&] { read_bytes(cut); });
  }
}

}  // namespace
}  // namespace adasplats
