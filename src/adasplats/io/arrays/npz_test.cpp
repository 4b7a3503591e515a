// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/arrays/npz.h"

#include <gtest/gtest.h>

#include <array>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"

namespace adasplats {
namespace {

std::uint32_t number_at(const std::string& bytes, std::size_t offset, int count) {
  std::uint32_t value = 0;
  for (int k = count - 1; k >= 0; --k)
    value = value << 8 | static_cast<unsigned char>(bytes.at(offset + static_cast<std::size_t>(k)));
  return value;
}

/// CRC-32 bit by bit (APPNOTE 4.4.7: the polynomial 0xedb88320).
std::uint32_t crc_of(const std::string& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

/// Name and content of every file, from the directory at the end (APPNOTE 4.3.12, 4.3.16).
std::vector<std::pair<std::string, std::string>> unzipped(const std::string& zip) {
  const std::size_t end = zip.size() - 22;
  EXPECT_EQ(number_at(zip, end, 4), 0x06054b50U);
  const std::uint32_t count = number_at(zip, end + 10, 2);
  std::size_t entry = number_at(zip, end + 16, 4);
  EXPECT_EQ(entry + number_at(zip, end + 12, 4), end);
  std::vector<std::pair<std::string, std::string>> files;
  for (std::uint32_t k = 0; k < count; ++k) {
    EXPECT_EQ(number_at(zip, entry, 4), 0x02014b50U);
    EXPECT_EQ(number_at(zip, entry + 10, 2), 0U);  // stored
    const std::uint32_t bytes = number_at(zip, entry + 24, 4);
    const std::uint32_t name_bytes = number_at(zip, entry + 28, 2);
    const std::uint32_t local = number_at(zip, entry + 42, 4);
    const std::string name = zip.substr(entry + 46, name_bytes);
    EXPECT_EQ(number_at(zip, local, 4), 0x04034b50U);
    // Both headers agree.
    EXPECT_EQ(zip.substr(local + 4, 26), zip.substr(entry + 6, 26));
    EXPECT_EQ(zip.substr(local + 30, name_bytes), name);
    files.emplace_back(name, zip.substr(local + 30 + name_bytes, bytes));
    EXPECT_EQ(number_at(zip, entry + 16, 4), crc_of(files.back().second));
    entry += 46 + name_bytes;
  }
  EXPECT_EQ(entry, end);
  return files;
}

// Oracle: PKWARE's APPNOTE, read here a second time, and write_npy.
TEST(Npz, HoldsTheFilesOfWriteNpy) {
  const TemporaryFolder folder;
  const std::array<float, 6> points = {1, 2, 3, 4, 5, 6};
  const std::array<std::uint16_t, 3> rings = {7, 8, 65535};
  const std::array<double, 1> time = {1e300};
  const NamedArray arrays[] = {{"points", {ColumnType::f32, {2, 3}, points.data()}},
                               {"rings", {ColumnType::u16, {3}, rings.data()}},
                               {"none_yet", {ColumnType::u8, {0, 4}, nullptr}},
                               {"time", {ColumnType::f64, {1, 1, 1}, time.data()}}};
  write_npz(folder.path() / "a.npz", arrays);
  const auto files = unzipped(read_file(folder.path() / "a.npz"));
  ASSERT_EQ(files.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    write_npy(folder.path() / "a.npy", arrays[k].array);
    EXPECT_EQ(files[k].first, arrays[k].name + ".npy");
    EXPECT_EQ(files[k].second, read_file(folder.path() / "a.npy"));
  }
  EXPECT_NE(files[3].second.find("'<f8', 'fortran_order': False, 'shape': (1, 1, 1), }"),
            std::string::npos);
}

TEST(Npz, NoArraysAndBadNames) {
  const TemporaryFolder folder;
  write_npz(folder.path() / "none.npz", {});
  EXPECT_TRUE(unzipped(read_file(folder.path() / "none.npz")).empty());
  const NpyArray empty = {ColumnType::u8, {0}, nullptr};
  for (const std::string name : {"", "a/b", "a.npy", "é"}) {
    const NamedArray arrays[] = {{name, empty}};
    EXPECT_THROW(write_npz(folder.path() / "a.npz", arrays), std::logic_error) << name;
  }
  const NamedArray twins[] = {{"a", empty}, {"a", empty}};
  EXPECT_THROW(write_npz(folder.path() / "a.npz", twins), std::logic_error);
  const NamedArray shapeless[] = {{"a", {ColumnType::u8, {}, nullptr}}};
  EXPECT_THROW(write_npz(folder.path() / "a.npz", shapeless), std::logic_error);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Npz, TooLargeForZip) {
  const TemporaryFolder folder;
  const NamedArray huge[] = {{"a", {ColumnType::u8, {std::size_t{1} << 32}, nullptr}}};
  expect_error(ErrorKind::data, {"a.npz", "4 GiB"},
               [&] { write_npz(folder.path() / "a.npz", huge); });
  EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace adasplats
