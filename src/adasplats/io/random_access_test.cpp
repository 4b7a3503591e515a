// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/las_writer.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

constexpr std::size_t kRows = 120'007;  // chunks of 50,000 points, and a rest

/// Points on a line, each with an intensity of its own.
struct Line {
  std::vector<double> x, y, z;
  std::vector<std::uint16_t> intensities;

  explicit Line(std::size_t rows) : y(rows), z(rows) {
    for (std::size_t i = 0; i < rows; ++i) {
      x.push_back(0.01 * static_cast<double>(i));
      intensities.push_back(static_cast<std::uint16_t>(i * 7));
    }
  }
  std::vector<ColumnView> columns() const {
    return {{"x", ColumnType::f64, x.data(), 8},
            {"y", ColumnType::f64, y.data(), 8},
            {"z", ColumnType::f64, z.data(), 8},
            {"intensity", ColumnType::u16, intensities.data(), 2}};
  }
};

Table read_span(const std::filesystem::path& file, RecordSpan span,
                const Executor* executor = nullptr) {
  LasReadOptions options;
  options.selection.records = span;
  options.executor = executor;
  return read_points(file, options);
}

/// Spans that cover a file give its rows once each, in order.
void expect_pieces(const std::filesystem::path& file, std::uint64_t piece) {
  SCOPED_TRACE(file.filename().string() + " by " + std::to_string(piece));
  const Table whole = read_points(file);
  const Executor executor(2);
  Table all;
  for (std::uint64_t first = 0; first < whole.rows; first += piece) {
    const Table part = read_span(file, {first, piece}, piece % 2 == 0 ? &executor : nullptr);
    for (const ReaderNote& note : part.notes) EXPECT_NE(note.kind, NoteKind::salvaged) << note.text;
    if (first == 0) {
      all = part;
      continue;
    }
    ASSERT_EQ(part.columns.size(), all.columns.size());
    all.rows += part.rows;
    for (std::size_t k = 0; k < all.columns.size(); ++k)
      std::visit(
          [&](auto& values) {
            const auto& more = std::get<std::decay_t<decltype(values)>>(part.columns[k].values);
            values.insert(values.end(), more.begin(), more.end());
          },
          all.columns[k].values);
  }
  ASSERT_EQ(all.rows, whole.rows);
  for (std::size_t k = 0; k < all.columns.size(); ++k)
    EXPECT_EQ(all.columns[k].values, whole.columns[k].values) << all.columns[k].name;
}

TEST(RandomAccess, SpansThatCoverAFileGiveEachPointOnce) {
  const TemporaryFolder folder;
  const Line line(kRows);
  write_las(folder.path() / "a.las", kRows, line.columns(), {});
  write_las(folder.path() / "a.laz", kRows, line.columns(), {.is_packed = true});
  write_ply(folder.path() / "a.ply", kRows, line.columns());
  for (const char* name : {"a.las", "a.laz", "a.ply"}) {
    const std::filesystem::path file = folder.path() / name;
    EXPECT_EQ(random_access_records(file), std::optional<std::uint64_t>(kRows)) << name;
    for (const std::uint64_t piece : {30'000U, 49'999U, 50'000U, 100'001U, 1'000'000U})
      expect_pieces(file, piece);
    EXPECT_EQ(read_span(file, {kRows, 5}).rows, 0U) << name;
  }
  EXPECT_EQ(read_span(folder.path() / "a.las", {10, 5}).rows, 5U);
  EXPECT_EQ(read_span(folder.path() / "a.ply", {kRows - 2, 5}).rows, 2U);
  EXPECT_EQ(read_span(folder.path() / "a.laz", {1, 60'000}).rows, 60'000U);
  EXPECT_EQ(read_span(folder.path() / "a.laz", {1, 5}).rows, 5U);
}

TEST(RandomAccess, AnExtentSelectsWithinASpan) {
  const TemporaryFolder folder;
  const Line line(kRows);
  LasReadOptions options;
  options.selection.extent = Extent{{999.995, -1, -1}, {1e6, 1, 1}};
  for (const char* name : {"a.las", "a.laz", "a.ply"}) {
    const std::filesystem::path file = folder.path() / name;
    if (file.extension() == ".ply")
      write_ply(file, kRows, line.columns());
    else
      write_las(file, kRows, line.columns(), {.is_packed = file.extension() == ".laz"});
    options.selection.records = {0, 100'000};
    EXPECT_EQ(read_points(file, options).rows, 0U) << name;
    options.selection.records = {100'000, 100'000};
    EXPECT_EQ(read_points(file, options).rows, kRows - 100'000) << name;
  }
}

TEST(RandomAccess, SomeFilesAreReadAtOnce) {
  const TemporaryFolder folder;
  const std::string head = "element vertex 2\nproperty float x\nproperty float y\n";
  const std::vector<std::filesystem::path> files = {
      folder.write("a.xyz", "1 2 3\n4 5 6\n"),
      folder.write("a.ply", "ply\nformat ascii 1.0\n" + head + "end_header\n1 2\n3 4\n"),
      folder.write("b.ply", "ply\nformat binary_little_endian 1.0\n" + head +
                                "property list uchar int k\nend_header\n" + std::string(18, '\0'))};
  for (const std::filesystem::path& file : files) {
    EXPECT_EQ(random_access_records(file), std::nullopt) << file;
    EXPECT_EQ(read_points(file).rows, 2U) << file;
    EXPECT_THROW(read_span(file, {0, 1}), std::logic_error) << file;
  }
}

TEST(RandomAccess, FilesThatEndEarlyAreErrorsInEveryPiece) {
  const TemporaryFolder folder;
  const Line line(1000);
  for (const char* name : {"a.las", "a.ply"}) {
    const std::filesystem::path file = folder.path() / name;
    if (file.extension() == ".ply")
      write_ply(file, 1000, line.columns());
    else
      write_las(file, 1000, line.columns(), {});
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 100);
    expect_error(ErrorKind::data, {name}, [&] { read_span(file, {0, 10}); });
  }
  EXPECT_LT(random_access_records(folder.path() / "a.las", true),
            std::optional<std::uint64_t>(1000));
  LasReadOptions options;
  options.salvage = true;
  options.selection.records = {990, 10};
  EXPECT_EQ(read_points(folder.path() / "a.las", options).notes.back().kind, NoteKind::salvaged);
}

}  // namespace
}  // namespace adasplats
