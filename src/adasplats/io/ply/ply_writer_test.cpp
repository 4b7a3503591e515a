// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

using io_test::bytes_of;
using io_test::values_of;

template <class T>
const std::vector<T>& typed(const Table& table, std::string_view name) {
  return std::get<std::vector<T>>(table.find(name)->values);
}

TEST(PlyWriter, BytesAsWrittenByHand) {
  struct Point {
    float x;
    std::uint8_t label;
  };
  const std::vector<Point> points = {{1.5F, 7}, {-2.0F, 9}};
  const std::vector<ColumnView> columns = {
      {"x", ColumnType::f32, &points[0].x, sizeof(Point)},
      {"label", ColumnType::u8, &points[0].label, sizeof(Point)}};
  const std::vector<std::string> comments = {"one", "two\nelement vertex 9"};
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "file.ply";
  write_ply(path, points.size(), columns, comments);
  EXPECT_EQ(read_file(path),
            "ply\nformat binary_little_endian 1.0\ncomment one\ncomment two element vertex 9\n"
            "element vertex 2\nproperty float x\nproperty uchar label\nend_header\n" +
                bytes_of(1.5F) + "\x07" + bytes_of(-2.0F) + "\x09");
}

// Round trip over several of the writer's chunks, with NaN and the extremes of every type.
TEST(PlyWriter, RoundTripOfEveryType) {
  constexpr std::size_t kRows = 100003;
  std::vector<std::int8_t> a(kRows);
  std::vector<std::uint16_t> b(kRows);
  std::vector<std::int32_t> c(kRows);
  std::vector<double> d(kRows);
  for (std::size_t k = 0; k < kRows; ++k) {
    a[k] = static_cast<std::int8_t>(k);
    b[k] = static_cast<std::uint16_t>(k * 7);
    c[k] = static_cast<std::int32_t>(k) * -20011;
    d[k] = 1e300 / static_cast<double>(k + 1);
  }
  c[5] = std::numeric_limits<std::int32_t>::min();
  d[3] = std::numeric_limits<double>::denorm_min();
  const std::vector<ColumnView> columns = {{"a", ColumnType::i8, a.data(), 1},
                                           {"b", ColumnType::u16, b.data(), 2},
                                           {"c", ColumnType::i32, c.data(), 4},
                                           {"d", ColumnType::f64, d.data(), 8}};
  const TemporaryFolder folder;
  for (const std::size_t rows : {std::size_t{0}, std::size_t{1}, kRows}) {
    write_ply(folder.path() / "file.ply", rows, columns);
    const Table table = read_ply(folder.path() / "file.ply");
    ASSERT_EQ(table.rows, rows);
    const auto begins_with = [rows](const auto& all, const auto& read) {
      return read.size() == rows && std::equal(read.begin(), read.end(), all.begin());
    };
    EXPECT_TRUE(begins_with(a, typed<std::int8_t>(table, "a")));
    EXPECT_TRUE(begins_with(b, typed<std::uint16_t>(table, "b")));
    EXPECT_TRUE(begins_with(c, typed<std::int32_t>(table, "c")));
    EXPECT_TRUE(begins_with(d, typed<double>(table, "d")));
  }
}

TEST(PlyWriter, MeshRoundTrip) {
  const std::vector<double> x = {0, 1, 2, 3};
  const std::vector<std::uint32_t> corners = {0, 1, 2, 3, 2, 1};
  const std::vector<std::uint8_t> classes = {4, 200};
  const std::vector<ColumnView> vertex_columns = {{"x", ColumnType::f64, x.data(), 8}};
  const std::vector<ColumnView> face_columns = {{"class", ColumnType::u8, classes.data(), 1}};
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "mesh.ply";
  write_ply_mesh(path, x.size(), vertex_columns, corners, face_columns);
  EXPECT_TRUE(ply_has_faces(path));
  const MeshTable mesh = read_ply_mesh(path);
  EXPECT_EQ(typed<double>(mesh.vertices, "x"), x);
  EXPECT_EQ(mesh.triangle_vertices, corners);
  EXPECT_EQ(typed<std::uint8_t>(mesh.faces, "class"), classes);
}

TEST(PlyWriter, RejectsWhatPlyCannotStore) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "file.ply";
  const std::uint64_t value = 1;
  const std::vector<ColumnView> wide = {{"x", ColumnType::u64, &value, 8}};
  const std::vector<ColumnView> blank = {{"a b", ColumnType::u8, &value, 8}};
  EXPECT_THROW(write_ply(path, 1, wide), std::logic_error);
  EXPECT_THROW(write_ply(path, 1, blank), std::logic_error);
  const std::vector<std::uint32_t> two = {0, 0};
  const std::vector<std::uint32_t> outside = {0, 0, 1};
  EXPECT_THROW(write_ply_mesh(path, 1, {}, two, {}), std::logic_error);
  EXPECT_THROW(write_ply_mesh(path, 1, {}, outside, {}), std::logic_error);
  EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace adasplats
