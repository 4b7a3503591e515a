// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/copc.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/mutator_test.h"
#include "adasplats/io/las/copc_file_test.h"
#include "adasplats/io/laz/laz_samples_test.h"

namespace adasplats {
namespace {

using io_test::bytes_of;
using io_test::Mutator;
using io_test::put;
using io_test::values_of;
using laz_test::CopcFile;
using laz_test::entry;
using laz_test::kLazSamples;
using laz_test::laz_file;

Table read_copc_bytes(const std::string& bytes, const PointSelection& selection = {},
                      const Executor* executor = nullptr) {
  const TemporaryFolder folder;
  LasReadOptions options;
  options.selection = selection;
  options.executor = executor;
  return read_points(folder.write("a.copc.laz", bytes), options);
}

/// The rows of `all` that are in both a list of ranges of rows and an extent, by brute force.
Table expected(const Table& all, const std::vector<std::pair<std::size_t, std::size_t>>& ranges,
               const Extent& extent = {}) {
  std::vector<bool> kept(all.rows);
  for (const auto& [begin, end] : ranges)
    for (std::size_t row = begin; row < end; ++row)
      kept[row] = extent.contains(
          {values_of(all, "x")[row], values_of(all, "y")[row], values_of(all, "z")[row]});
  Table table = all;
  keep_rows(kept, table);
  return table;
}

void expect_equal(const Table& found, const Table& wanted) {
  ASSERT_EQ(found.rows, wanted.rows);
  ASSERT_EQ(found.columns.size(), wanted.columns.size());
  for (std::size_t k = 0; k < found.columns.size(); ++k)
    EXPECT_EQ(found.columns[k].values, wanted.columns[k].values) << found.columns[k].name;
}

TEST(Copc, LevelsAreThoseOfTheOctree) {
  const CopcFile file;
  const Table all = read_copc_bytes(file.bytes());
  ASSERT_EQ(all.rows, 40U);
  const std::size_t first = file.chunks()[0].points, second = first + file.chunks()[1].points;
  const Executor executor(2);
  for (const Executor* const threads : {static_cast<const Executor*>(nullptr), &executor}) {
    expect_equal(read_copc_bytes(file.bytes(), {.level = 0}, threads), expected(all, {{0, first}}));
    expect_equal(read_copc_bytes(file.bytes(), {.level = 1}, threads),
                 expected(all, {{0, second}}));
    expect_equal(read_copc_bytes(file.bytes(), {.level = 2}, threads), all);
    expect_equal(read_copc_bytes(file.bytes(), {.level = 4000000000}, threads), all);
  }
  EXPECT_TRUE(read_copc_bytes(file.bytes(), {.level = 0}).notes.empty());
  // 8 m on level 0, 4 m on level 1: the first that is as fine as that.
  EXPECT_EQ(read_copc_bytes(file.bytes(), {.resolution_m = 100.0}).rows, first);
  EXPECT_EQ(read_copc_bytes(file.bytes(), {.resolution_m = 8.0}).rows, first);
  EXPECT_EQ(read_copc_bytes(file.bytes(), {.resolution_m = 7.9}).rows, second);
  EXPECT_EQ(read_copc_bytes(file.bytes(), {.resolution_m = 4.0}).rows, second);
  EXPECT_EQ(read_copc_bytes(file.bytes(), {.resolution_m = 0.1}).rows, 40U);
  EXPECT_EQ(read_copc_bytes(file.bytes(), {.level = 0, .resolution_m = 0.1}).rows, first);
}

TEST(Copc, ExtentsAreThoseOfPointsAndOfCubes) {
  CopcFile file;
  const Table all = read_copc_bytes(file.bytes());
  std::vector<double> x = values_of(all, "x");
  std::ranges::sort(x);
  Extent half;
  half.low.x = x[20];
  put(file.bytes(), CopcFile::kInfoAt, 400.0);  // all cubes meet it
  expect_equal(read_copc_bytes(file.bytes(), {.extent = half}), expected(all, {{0, 40}}, half));
  expect_equal(read_copc_bytes(file.bytes(), {.extent = half, .level = 0}),
               expected(all, {{0, file.chunks()[0].points}}, half));
  Extent nowhere;
  nowhere.low.z = 5000;
  EXPECT_EQ(read_copc_bytes(file.bytes(), {.extent = nowhere}).rows, 0U);
  // An extent that contains all points, but does not overlap the root's cube.
  put(file.bytes(), CopcFile::kInfoAt, -2000.0);
  Extent right;
  right.low.x = -350;
  EXPECT_EQ(read_copc_bytes(file.bytes(), {.extent = right}).rows, 0U);
  // One that the cube of 1-0-0-0 alone does not meet, which is not unpacked then: zeros instead of
  // its chunk are no fault.
  put(file.bytes(), CopcFile::kInfoAt, -400.0);
  const std::size_t first = file.chunks()[0].points;
  std::string without = file.bytes();
  for (std::size_t k = 0; k < file.chunks()[1].bytes; ++k)
    without[file.chunks()[1].offset_bytes + k] = '\0';
  const Table found = read_copc_bytes(without, {.extent = right});
  expect_equal(found, expected(all, {{0, first}, {first + file.chunks()[1].points, 40}}, right));
}

TEST(Copc, OctreesThatContradictThemselvesAreErrors) {
  const CopcFile sound;
  const PointSelection all = {.level = 9};
  const auto expect_broken = [&](std::size_t at, auto value,
                                 const std::vector<std::string>& parts) {
    std::string file = sound.bytes();
    put(file, at, value);
    expect_error(ErrorKind::data, parts, [&] { read_copc_bytes(file, all); });
  };
  const std::size_t root = sound.root_page_at(), inner = sound.inner_page_at();
  const std::size_t info = CopcFile::kInfoAt;
  expect_broken(info + 24, 0.0, {"cube"});
  expect_broken(info + 32, -1.0, {"spacing"});
  expect_broken(info + 40, ~std::uint64_t{0}, {"page of node 0-0-0-0"});
  expect_broken(info + 48, std::uint64_t{0}, {"page of node 0-0-0-0"});
  expect_broken(info + 48, std::uint64_t{33}, {"page of node 0-0-0-0"});
  expect_broken(info + 48, ~std::uint64_t{31}, {"page of node 0-0-0-0"});
  // Keys: no such level, beyond the level's cubes, outside of the page's node, twice.
  expect_broken(root, std::int32_t{31}, {"node 31-0-0-0"});
  expect_broken(root, std::int32_t{-1}, {"node -1-0-0-0"});
  expect_broken(root + 4, std::int32_t{1}, {"node 0-1-0-0"});
  expect_broken(root + 4, std::int32_t{-1}, {"node 0--1-0-0"});
  expect_broken(inner + 32 + 4, std::int32_t{1}, {"node 2-1-0-0", "not in node 1-1-0-0"});
  expect_broken(root + 32, std::int32_t{0}, {"node 0-0-0-0 occurs twice"});
  // Points: fewer than none, a chunk that is none, another's size, the points of another.
  expect_broken(root + 28, std::int32_t{-2}, {"-2 points"});
  expect_broken(root + 24, std::int32_t{-5}, {"-5 bytes"});
  expect_broken(root + 16, std::uint64_t{7}, {"node 0-0-0-0", "chunk table"});
  expect_broken(root + 24, std::int32_t{100}, {"in 100 bytes", "chunk table"});
  expect_broken(root + 28, std::int32_t{1}, {"1 points", "chunk table"});
  std::string twice = sound.bytes();
  twice.replace(root + 32 + 16, 16, twice.substr(root + 16, 16));
  expect_error(ErrorKind::data, {"node 1-0-0-0", "another node"},
               [&] { read_copc_bytes(twice, all); });
  // A page that leads to itself, for its own node and for another.
  std::string cycle = sound.bytes();
  cycle.replace(inner + 16, 16, cycle.substr(root + 64 + 16, 16));
  expect_error(ErrorKind::data, {"node 1-1-0-0 occurs twice"},
               [&] { read_copc_bytes(cycle, all); });
  cycle = sound.bytes();
  cycle.replace(inner + 32 + 16, 16, cycle.substr(root + 64 + 16, 16));
  expect_error(ErrorKind::data, {"page of node 2-3-0-0 occurs twice"},
               [&] { read_copc_bytes(cycle, all); });
  // None of it matters when all points are read.
  EXPECT_EQ(read_copc_bytes(cycle).rows, 40U);
}

// Nothing but an error of ours may escape, and no point may come twice.
TEST(Copc, DamagedFilesEndInErrors) {
  const CopcFile sound;
  const TemporaryFolder folder;
  const std::string& file = sound.bytes();
  const std::string info = file.substr(CopcFile::kInfoAt, 56);
  const std::string pages = file.substr(sound.root_page_at());
  Mutator mutator(7);
  std::size_t read_well = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string broken = file;
    std::string part = mutator.mutate(round % 2 == 0 ? info : pages, pages);
    if (round % 2 == 0) {
      part.resize(info.size());
      broken.replace(CopcFile::kInfoAt, info.size(), part);
    } else {
      broken = file.substr(0, sound.root_page_at()) + part;
    }
    Extent extent;
    extent.low.x = round % 3 == 0 ? 0 : -1e9;
    try {
      const Table table =
          read_points(folder.write("a.laz", broken), {.selection = {.extent = extent, .level = 9}});
      EXPECT_LE(table.rows, 40U);
      ++read_well;
    } catch (const Error& error) {
      EXPECT_EQ(exit_code(error.kind()), exit_code(ErrorKind::data)) << error.what();
    }
  }
  EXPECT_GT(read_well, 100U);
  EXPECT_LT(read_well, 1900U);
}

TEST(Copc, OtherFilesHaveNoLevels) {
  for (const PointSelection& selection : {PointSelection{.level = 0}, {.resolution_m = 1.0}}) {
    const TemporaryFolder folder;
    const std::string word = selection.level ? "`level`" : "`resolution`";
    const auto laz = folder.write("a.laz", laz_file(kLazSamples[2]));
    const auto las = folder.write("a.las", las_file(kLazSamples[2]));
    const auto text = folder.write("a.xyz", "1 2 3\n");
    for (const auto& path : {laz, las, text})
      expect_error(ErrorKind::usage, {path.string(), word, "COPC"},
                   [&] { read_points(path, {.selection = selection}); });
  }
}

// Oracle: brute force.
TEST(Extents, OfFilesWithoutLevels) {
  const TemporaryFolder folder;
  Extent half;
  const Table all = read_points(folder.write("a.laz", laz_file(kLazSamples[1])));
  std::vector<double> x = values_of(all, "x");
  std::ranges::sort(x);
  half.high.x = x[20];
  const LasReadOptions options = {.selection = {.extent = half}};
  const Table wanted = expected(all, {{0, all.rows}}, half);
  ASSERT_GE(wanted.rows, 20U);
  ASSERT_LT(wanted.rows, all.rows);
  expect_equal(read_points(folder.path() / "a.laz", options), wanted);
  expect_equal(read_points(folder.write("a.las", las_file(kLazSamples[1])), options), wanted);
  const auto text = folder.write("a.csv", "X,Y,Z,label\n1,2,3,4\n5,6,7,8\n5.5,nan,7,9\n9,9,9,10\n");
  const Table some = read_points(text, {.selection = {.extent = Extent{{5, 6, 7}, {6, 7, 8}}}});
  ASSERT_EQ(some.rows, 1U);
  EXPECT_EQ(values_of(some, "label"), std::vector<double>{8});
  const auto one = folder.write("b.csv", "x,y,label\n1,2,4\n");
  expect_error(ErrorKind::data, {"b.csv", "`extent`"}, [&] { read_points(one, options); });
}

// By the header's box a LAZ file is left packed: a point far beyond the box is no fault then.
TEST(Extents, FilesBeyondAreNotUnpacked) {
  std::string file = laz_file(kLazSamples[1]);
  for (const std::size_t axis : {0U, 1U, 2U}) {
    put(file, 179 + 16 * axis, 1000.0);
    put(file, 187 + 16 * axis, -1000.0);
  }
  Extent far;
  far.low.y = 1100;
  EXPECT_EQ(read_copc_bytes(file, {.extent = far}).rows, 0U);
  std::uint32_t points_at = 0;
  std::memcpy(&points_at, &file[96], 4);
  put(file, points_at + 8 + 8, std::int32_t{2000000000});  // z of the first point, as it is
  EXPECT_EQ(read_copc_bytes(file, {.extent = far}).rows, 0U);
  far.low.y = 900;
  expect_error(ErrorKind::data, {"damaged LAZ"}, [&] { read_copc_bytes(file, {.extent = far}); });
}

}  // namespace
}  // namespace adasplats
