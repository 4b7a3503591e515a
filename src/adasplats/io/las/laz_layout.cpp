// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/laz_layout.h"

#include <algorithm>
#include <span>
#include <string>

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/packed_chunk.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {
namespace {

template <class T>
T value_in_file(const std::filesystem::path& path, std::uint64_t offset) {
  InputFile file(path);
  file.skip(offset);
  return load_value<T>(file.peek(sizeof(T)).data());
}

/// Decompresses the chunk table, entry by entry.
class ChunkTable {
 public:
  struct Entry {
    std::uint32_t points = 0;  ///< 0 if all chunks have the same number
    std::uint32_t bytes = 0;
  };

  /// `bytes` follow the number of chunks, and must outlive this object.
  ChunkTable(std::span<const std::byte> bytes, bool has_points)
      : has_points_(has_points), decoder_(bytes, is_broken_) {}
  ChunkTable(const ChunkTable&) = delete;
  ChunkTable& operator=(const ChunkTable&) = delete;

  /// The entry of the next chunk; meaningless once is_broken().
  Entry next() {
    if (has_points_) last_.points = integers_.decode(decoder_, last_.points, 0);
    last_.bytes = integers_.decode(decoder_, last_.bytes, 1);
    return last_;
  }
  /// Whether the bytes ended before the entries.
  bool is_broken() const { return is_broken_; }

 private:
  bool has_points_;
  bool is_broken_ = false;
  RangeDecoder decoder_;
  IntegerModel integers_{32, 2};
  Entry last_;
};

/// Offset of the chunk table; 0: the writer was interrupted before it wrote one.
std::uint64_t place_of_table(const InputFile& file, const LazLayout& layout) {
  const std::uint64_t points_at = layout.header.points_offset_bytes;
  auto table = value_in_file<std::uint64_t>(file.path(), points_at);
  if (table == points_at) return 0;
  // A writer that could not seek leaves -1 there, and the offset at the end of the file.
  if (table == ~std::uint64_t{0})
    table = value_in_file<std::uint64_t>(file.path(), file.size_bytes() - 8);
  if (table < layout.first_chunk_bytes || table > file.size_bytes() - 8) {
    throw file.error_here("LAZ: the chunk table is at byte " + std::to_string(table) +
                          ", outside the file or before the points");
  }
  return table;
}

/// Reads the entries of the table, and checks that the chunks are between the header and the table.
class TableReader {
 public:
  TableReader(InputFile& file, const LazLayout& layout)
      : file_(file), layout_(layout), table_at_(file.offset()) {}

  std::vector<LazChunk> read() {
    const auto version = load_value<std::uint32_t>(file_.peek(8).data());
    if (version != 0) {
      throw file_.error_here("LAZ: found version " + std::to_string(version) +
                             " of the chunk table, expected 0");
    }
    const std::uint64_t count = load_value<std::uint32_t>(file_.peek(8).data() + 4);
    const std::uint64_t room = table_at_ - layout_.first_chunk_bytes;
    if (count > room) {
      throw file_.error_here("LAZ: found " + std::to_string(count) + " chunks in " +
                             std::to_string(room) + " bytes");
    }
    file_.skip(8);
    return read_entries(count);
  }

 private:
  std::vector<LazChunk> read_entries(std::uint64_t count) {
    // An entry is two numbers of at most 54 bits: two symbols of 15 bits and 24 raw bits.
    const auto bytes =
        static_cast<std::size_t>(std::min<std::uint64_t>(file_.remaining(), 64 + 16 * count));
    const std::uint32_t of_all = layout_.packing.chunk_points;
    ChunkTable table(file_.peek(bytes).first(bytes), of_all == kVariableChunks);
    std::vector<LazChunk> chunks;
    std::uint64_t left = layout_.header.points;
    LazChunk chunk{layout_.first_chunk_bytes, 0, 0};
    for (std::uint64_t k = 0; k < count && left > 0; ++k) {
      chunk.offset_bytes += chunk.bytes;
      const ChunkTable::Entry entry = table.next();
      if (table.is_broken()) throw file_.error_here("LAZ: the chunk table is damaged");
      chunk.bytes = entry.bytes;
      chunk.points =
          of_all == kVariableChunks ? entry.points : std::min<std::uint64_t>(of_all, left);
      check(chunk, k, left);
      chunk.first_record = layout_.header.points - left;
      left -= chunk.points;
      if (chunk.points > 0) chunks.push_back(chunk);
    }
    if (left > 0) {
      throw file_.error_here("LAZ: the chunk table has " +
                             std::to_string(layout_.header.points - left) +
                             " points, the header states " + std::to_string(layout_.header.points));
    }
    return chunks;
  }

  void check(const LazChunk& chunk, std::uint64_t number, std::uint64_t left) const {
    const std::string name = "LAZ: chunk " + std::to_string(number);
    if (chunk.bytes > table_at_ - chunk.offset_bytes) {
      throw file_.error_here(name + " of " + std::to_string(chunk.bytes) + " bytes at byte " +
                             std::to_string(chunk.offset_bytes) + " reaches into the chunk table");
    }
    if (chunk.points > left || chunk.points > kMaxPointsPerByte * chunk.bytes) {
      throw file_.error_here(name + " has " + std::to_string(chunk.points) + " points in " +
                             std::to_string(chunk.bytes) + " bytes, expected at most " +
                             std::to_string(left) + " and " + std::to_string(kMaxPointsPerByte) +
                             " for each byte");
    }
  }

  InputFile& file_;
  const LazLayout& layout_;
  std::uint64_t table_at_;
};

/// Reads the chunks from the table if there is one.
void read_table(const std::filesystem::path& path, LazLayout& layout) {
  InputFile file(path);
  file.skip(layout.header.points_offset_bytes);
  const std::uint64_t table = place_of_table(file, layout);
  if (table == 0 && layout.packing.chunk_points != kVariableChunks) return;
  if (table == 0) throw file.error_here("LAZ: no chunk table, but chunks of variable size");
  file.skip(table - file.offset());
  layout.chunks = TableReader(file, layout).read();
  layout.has_table = true;
}

}  // namespace

LazLayout read_laz_layout(const std::filesystem::path& path, bool salvage) {
  InputFile file(path);
  LazLayout layout;
  layout.header = read_las_header(file);
  layout.packing = read_laz_packing(file, layout.header);
  layout.first_chunk_bytes = layout.header.points_offset_bytes;
  if (layout.packing.compressor == LazCompressor::one_stream) {
    layout.packing.chunk_points = kVariableChunks;
    return layout;
  }
  if (layout.header.points == 0) return layout;
  layout.first_chunk_bytes += 8;  // after the offset of the table
  try {
    read_table(path, layout);
  } catch (const Error& error) {
    const bool is_fixed = layout.packing.chunk_points != kVariableChunks;
    if (!salvage || !is_fixed || error.kind() != ErrorKind::data) throw;
    layout.chunks.clear();
  }
  return layout;
}

}  // namespace adasplats
