// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/laz_layout.h"

#ifdef ADASPLATS_HAVE_LASZIP

#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats {
namespace {

// LASzip's record: 34 bytes, the last two the number of items, then 6 bytes an item.
constexpr std::size_t kLaszipBytes = 34;
constexpr std::size_t kItemBytes = 6;
constexpr std::uint16_t kLaszipRecordId = 22204;

template <class T>
T value_at(std::span<const std::byte> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.subspan(offset, sizeof(T)).data(), sizeof(T));
  return value;
}

template <class T>
T value_in_file(const std::filesystem::path& path, std::uint64_t offset) {
  InputFile file(path);
  file.skip(offset);
  return value_at<T>(file.peek(sizeof(T)), 0);
}

/// One part of a point as LASzip packs it (laszip.hpp, LASitem).
struct Item {
  std::uint16_t type;
  std::size_t bytes;
};

/// The items of a point format in their order; what is left of the record are extra bytes.
std::vector<Item> expected_items(const LasHeader& header) {
  const std::size_t format = header.format;
  std::vector<Item> items;
  if (format < 6) {
    items.push_back({6, 20});
    if (format == 1 || format >= 3) items.push_back({7, 8});
    if (format == 2 || format == 3 || format == 5) items.push_back({8, 6});
    if (format == 4 || format == 5) items.push_back({9, 29});
  } else {
    items.push_back({10, 30});
    if (format == 7) items.push_back({11, 6});
    if (format == 8 || format == 10) items.push_back({12, 8});
    if (format >= 9) items.push_back({13, 29});
  }
  std::size_t bytes = 0;
  for (const Item& item : items) bytes += item.bytes;
  constexpr std::uint16_t kExtraBytes = 0;
  constexpr std::uint16_t kExtraBytesLayered = 14;
  if (header.record_bytes > bytes)
    items.push_back({format < 6 ? kExtraBytes : kExtraBytesLayered, header.record_bytes - bytes});
  return items;
}

/// Checks LASzip's record: LASzip reads beyond its buffers where the items are not those of the
/// point format. Gives whether the points come in chunks.
bool check_items(const InputFile& file, std::span<const std::byte> record, std::size_t bytes,
                 const LasHeader& header) {
  const std::vector<Item> expected = expected_items(header);
  const bool is_layered = header.format >= 6;
  bool matches = bytes == kLaszipBytes + expected.size() * kItemBytes &&
                 value_at<std::uint16_t>(record, 32) == expected.size();
  for (std::size_t k = 0; matches && k < expected.size(); ++k) {
    const std::size_t place = kLaszipBytes + k * kItemBytes;
    const auto version = value_at<std::uint16_t>(record, place + 4);
    matches = value_at<std::uint16_t>(record, place) == expected[k].type &&
              value_at<std::uint16_t>(record, place + 2) == expected[k].bytes &&
              (is_layered ? version >= 3 && version <= 4 : version >= 1 && version <= 2);
  }
  // 1: one stream, 2: chunks, 3: chunks of layers, which only formats 6 to 10 have.
  const int compressor = bytes < kLaszipBytes ? 0 : int{value_at<std::uint16_t>(record, 0)};
  if (!matches || (is_layered ? compressor != 3 : compressor != 1 && compressor != 2)) {
    throw file.error_here("LAZ: the record 'laszip encoded' is broken or not of point format " +
                          std::to_string(header.format) + " with " +
                          std::to_string(header.record_bytes) + " bytes");
  }
  return compressor != 1;
}

/// Walks the variable length records; gives whether the points come in chunks.
bool check_records(InputFile& file, const LasHeader& header) {
  file.skip(header.header_bytes);
  std::optional<bool> is_chunked;
  for (std::uint64_t k = 0; k < header.vlr_count; ++k) {
    const std::uint64_t room = header.points_offset_bytes - file.offset();
    const std::span<const std::byte> record = file.peek(kVlrHeaderBytes);
    const std::size_t bytes = value_at<std::uint16_t>(record, 20);
    if (room < kVlrHeaderBytes + bytes) {
      throw file.error_here("LAZ: variable length record " + std::to_string(k) + " of " +
                            std::to_string(bytes) + " bytes reaches into the points");
    }
    const std::string_view user(reinterpret_cast<const char*>(record.data()) + 2, 16);
    const bool is_laszip = user.starts_with("laszip encoded") &&
                           value_at<std::uint16_t>(record, 18) == kLaszipRecordId;
    file.skip(kVlrHeaderBytes);
    if (is_laszip && is_chunked) throw file.error_here("LAZ: a second record 'laszip encoded'");
    if (is_laszip) is_chunked = check_items(file, file.peek(bytes), bytes, header);
    file.skip(bytes);
  }
  if (!is_chunked) throw file.error_here("marked as LAZ, but no record 'laszip encoded'");
  return *is_chunked;
}

void check_chunk_table(const InputFile& file, const LasHeader& header) {
  const std::uint64_t first_chunk = header.points_offset_bytes + 8;
  auto table = value_in_file<std::uint64_t>(file.path(), header.points_offset_bytes);
  // A writer that could not go back leaves -1 there and the place at the file's end.
  if (table == ~std::uint64_t{0})
    table = value_in_file<std::uint64_t>(file.path(), file.size_bytes() - 8);
  if (table < first_chunk || table > file.size_bytes() - 8) {
    throw file.error_here("LAZ: the table of chunks is said to begin at byte " +
                          std::to_string(table) + ", outside the file or before the points");
  }
  const auto chunks = value_in_file<std::uint32_t>(file.path(), table + 4);
  if (chunks > table - first_chunk) {
    throw file.error_here("LAZ: found " + std::to_string(chunks) + " chunks in " +
                          std::to_string(table - first_chunk) + " bytes");
  }
}

}  // namespace

LasHeader read_laz_layout(const std::filesystem::path& path) {
  InputFile file(path);
  const LasHeader header = read_las_header(file);
  const bool is_chunked = check_records(file, header);
  if (is_chunked && header.points > 0) check_chunk_table(file, header);
  return header;
}

}  // namespace adasplats

#endif
