// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "adasplats/io/base/files_test.h"
#include "adasplats/io/las/copc.h"
#include "adasplats/io/laz/laz_samples_test.h"

namespace adasplats::laz_test {

/// A node's entry: level, x, y, z, offset, bytes and points (-1: a page).
inline std::string entry(std::array<std::int32_t, 4> key, std::uint64_t offset, std::size_t bytes,
                         std::int64_t points) {
  std::string text;
  for (const std::int32_t number : key) text += io_test::bytes_of(number);
  return text + io_test::bytes_of(offset) + io_test::bytes_of(static_cast<std::int32_t>(bytes)) +
         io_test::bytes_of(static_cast<std::int32_t>(points));
}

/// A COPC of the sample "layers, variable chunks": its first chunk is the root's, its second that
/// of node 1-0-0-0, its third, on another page, that of node 2-3-0-0. Written after the
/// specification: the info record first, pages at the end.
class CopcFile {
 public:
  static constexpr std::size_t kInfoAt = 375 + 54;

  CopcFile() {
    file_ = laz_file(kLazSamples[2]);
    std::string record(54 + 160, '\0');
    for (std::size_t k = 0; k < 4; ++k) record[2 + k] = "copc"[k];
    io_test::put(record, 18, std::uint16_t{1});
    io_test::put(record, 20, std::uint16_t{160});
    // A cube of 1024 m about the points, 8 m between points of the root.
    for (const std::size_t axis : {0U, 1U, 2U}) io_test::put(record, 54 + 8 * axis, 0.0);
    io_test::put(record, 54 + 24, 512.0);
    io_test::put(record, 54 + 32, 8.0);
    file_.insert(375, record);
    std::uint32_t points_at = 0, records = 0;
    std::uint64_t table_at = 0;
    std::memcpy(&points_at, &file_[96], 4);
    points_at += static_cast<std::uint32_t>(record.size());
    io_test::put(file_, 96, points_at);
    std::memcpy(&records, &file_[100], 4);
    io_test::put(file_, 100, records + 1);
    std::memcpy(&table_at, &file_[points_at], 8);
    io_test::put(file_, points_at, table_at + record.size());
    const TemporaryFolder folder;
    chunks_ = read_laz_layout(folder.write("a.laz", file_), false).chunks;
    add_pages();
  }

  const std::vector<LazChunk>& chunks() const { return chunks_; }
  const std::string& bytes() const { return file_; }
  std::string& bytes() { return file_; }
  std::size_t root_page_at() const { return root_page_at_; }
  std::size_t inner_page_at() const { return root_page_at_ + 3 * 32; }

 private:
  static std::string entry_of(std::array<std::int32_t, 4> key, const LazChunk& chunk) {
    return entry(key, chunk.offset_bytes, static_cast<std::size_t>(chunk.bytes),
                 static_cast<std::int64_t>(chunk.points));
  }
  void add_pages() {
    root_page_at_ = file_.size();
    io_test::put(file_, kInfoAt + 40, std::uint64_t{root_page_at_});
    io_test::put(file_, kInfoAt + 48, std::uint64_t{3 * 32});
    file_ += entry_of({0, 0, 0, 0}, chunks_.at(0));
    file_ += entry_of({1, 0, 0, 0}, chunks_.at(1));
    file_ += entry({1, 1, 0, 0}, inner_page_at(), 64, -1);
    file_ += entry({1, 1, 0, 0}, 0, 0, 0);  // a node without points
    file_ += entry_of({2, 3, 0, 0}, chunks_.at(2));
  }

  std::string file_;
  std::vector<LazChunk> chunks_;
  std::size_t root_page_at_ = 0;
};

}  // namespace adasplats::laz_test
