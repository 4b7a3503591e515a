// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/laz_writer.h"

#include <algorithm>
#include <cstring>

#include "adasplats/io/las/las_header.h"
#include "adasplats/io/laz/layered_writer.h"
#include "adasplats/io/laz/laz_item.h"

namespace adasplats {
namespace {

constexpr std::size_t kPlainFormat = 6;
constexpr std::uint32_t kChunkPoints = 50000;  // as LASzip does
constexpr unsigned kItemVersion = 3;

/// Bytes of the colours of a format.
std::size_t colour_bytes_of(std::size_t point_format) {
  return las_format(point_format).min_bytes - las_format(kPlainFormat).min_bytes;
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

std::string laszip_record(std::size_t point_format, std::size_t record_bytes) {
  constexpr std::size_t kRgbBytes = 6;
  std::vector<LazItem> items = {
      {LazItemType::point14, las_format(kPlainFormat).min_bytes, kItemVersion}};
  const std::size_t colours = colour_bytes_of(point_format);
  const std::size_t extras = record_bytes - las_format(point_format).min_bytes;
  if (colours > 0)
    items.push_back({colours == kRgbBytes ? LazItemType::rgb14 : LazItemType::rgb_nir14, colours,
                     kItemVersion});
  if (extras > 0) items.push_back({LazItemType::extra_bytes14, extras, kItemVersion});
  std::string record;
  append(record, LazCompressor::layered);
  append(record, std::uint16_t{0});  // coder
  // The version of LASzip with this format.
  append(record, std::uint8_t{3});
  append(record, std::uint8_t{4});
  append(record, std::uint16_t{3});
  append(record, std::uint32_t{0});  // options
  append(record, kChunkPoints);
  append(record, std::int64_t{-1});  // number of special extended records: none
  append(record, std::int64_t{-1});  // their offset: none
  append(record, static_cast<std::uint16_t>(items.size()));
  for (const LazItem& item : items) {
    append(record, item.type);
    append(record, static_cast<std::uint16_t>(item.bytes));
    append(record, static_cast<std::uint16_t>(item.version));
  }
  return record;
}

void LazWriter::write(const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  const std::size_t full = kChunkPoints * record_bytes_;
  while (bytes > 0) {
    const std::size_t part = std::min(bytes, full - records_.size());
    records_.append(from, part);
    from += part;
    bytes -= part;
    if (records_.size() == full) pack();
  }
}

void LazWriter::pack() {
  chunks_.push_back(pack_layered_chunk(reinterpret_cast<const std::byte*>(records_.data()),
                                       records_.size() / record_bytes_, record_bytes_,
                                       colour_bytes_of(point_format_)));
  records_.clear();
}

void LazWriter::finish(ByteSink& file, std::uint64_t points_at) {
  if (!records_.empty()) pack();
  std::uint64_t table_at = points_at + sizeof(table_at);
  std::vector<std::uint32_t> sizes;
  for (const std::string& chunk : chunks_) {
    table_at += chunk.size();
    sizes.push_back(static_cast<std::uint32_t>(chunk.size()));
  }
  file.write(&table_at, sizeof(table_at));
  for (const std::string& chunk : chunks_) file.write(chunk);
  std::string table;
  append(table, std::uint32_t{0});  // version
  append(table, static_cast<std::uint32_t>(sizes.size()));
  if (!sizes.empty()) table += pack_chunk_table(sizes);
  file.write(table);
}

}  // namespace adasplats
