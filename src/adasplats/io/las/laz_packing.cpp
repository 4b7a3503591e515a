// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>

#include "adasplats/io/base/records.h"
#include "adasplats/io/las/las_vlrs.h"
#include "adasplats/io/las/laz_layout.h"
#include "adasplats/io/las/laz_writer.h"

namespace adasplats {
namespace {

// LASzip's record (laszip.hpp): 34 bytes, the last two the number of items, then 6 bytes an item.
constexpr std::size_t kLaszipBytes = 34;
constexpr std::size_t kItemBytes = 6;
constexpr std::size_t kCoderAt = 2, kChunkPointsAt = 12, kItemCountAt = 32;

/// The items of a point format in their order, without versions; the rest of the record is extra
/// bytes.
std::vector<LazItem> expected_items(const LasHeader& header) {
  using Type = LazItemType;
  const std::size_t format = header.format;
  std::vector<LazItem> items;
  if (format < 6) {
    items.push_back({Type::point10, 20});
    if (format == 1 || format >= 3) items.push_back({Type::gps_time11, 8});
    if (format == 2 || format == 3 || format == 5) items.push_back({Type::rgb12, 6});
    if (format >= 4) items.push_back({Type::wave_packet13, 29});
  } else {
    items.push_back({Type::point14, 30});
    if (format == 7) items.push_back({Type::rgb14, 6});
    if (format == 8 || format == 10) items.push_back({Type::rgb_nir14, 8});
    if (format >= 9) items.push_back({Type::wave_packet14, 29});
  }
  std::size_t bytes = 0;
  for (const LazItem& item : items) bytes += item.bytes;
  if (header.record_bytes > bytes) {
    items.push_back(
        {format < 6 ? Type::extra_bytes : Type::extra_bytes14, header.record_bytes - bytes});
  }
  return items;
}

bool is_known_version(LazItemType type, unsigned version) {
  switch (type) {
    case LazItemType::wave_packet13: return version == 1;
    case LazItemType::wave_packet14: return version == 3 || version == 4;
    case LazItemType::point14:
    case LazItemType::rgb14:
    case LazItemType::rgb_nir14:
    // LASzip's prototype wrote 2 for the same format.
    case LazItemType::extra_bytes14: return version >= 2 && version <= 4;
    default: return version == 1 || version == 2;
  }
}

/// Reads LASzip's record; `file` is at its content.
class PackingReader {
 public:
  PackingReader(const InputFile& file, std::span<const std::byte> record, const LasHeader& header)
      : file_(file), record_(record), header_(header) {}

  LazPacking read() const {
    if (record_.size() < kLaszipBytes) throw broken();
    LazPacking packing;
    packing.compressor = compressor();
    const auto coder = at<std::uint16_t>(kCoderAt);
    if (coder != 0)
      throw file_.error_here("LAZ: found coder " + std::to_string(coder) + ", expected 0");
    packing.chunk_points = at<std::uint32_t>(kChunkPointsAt);
    // LASzip uses both for chunks of variable size.
    if (packing.chunk_points == 0) packing.chunk_points = kVariableChunks;
    packing.record_bytes = header_.record_bytes;
    packing.items = items();
    return packing;
  }

 private:
  template <class T>
  T at(std::size_t offset) const {
    return load_value<T>(record_.subspan(offset, sizeof(T)).data());
  }

  Error broken() const {
    return file_.error_here(
        "LAZ: the record 'laszip encoded' is damaged or does not match point format " +
        std::to_string(header_.format) + " with " + std::to_string(header_.record_bytes) +
        " bytes");
  }

  LazCompressor compressor() const {
    const auto number = at<std::uint16_t>(0);
    const bool is_layered = header_.format >= 6;
    if (number < 1 || number > 3) {
      throw file_.error_here("LAZ: found compressor " + std::to_string(number) +
                             ", expected 1, 2 or 3");
    }
    if (is_layered != (number == 3)) {
      throw file_.error_here("LAZ: found compressor " + std::to_string(number) +
                             " for point format " + std::to_string(header_.format) + ", expected " +
                             (is_layered ? "3" : "1 or 2"));
    }
    return static_cast<LazCompressor>(number);
  }

  std::vector<LazItem> items() const {
    std::vector<LazItem> items = expected_items(header_);
    if (record_.size() != kLaszipBytes + items.size() * kItemBytes ||
        at<std::uint16_t>(kItemCountAt) != items.size())
      throw broken();
    for (std::size_t k = 0; k < items.size(); ++k) {
      const std::size_t place = kLaszipBytes + k * kItemBytes;
      const auto type = at<std::uint16_t>(place);
      items[k].version = at<std::uint16_t>(place + 4);
      if (type != static_cast<std::uint16_t>(items[k].type) ||
          at<std::uint16_t>(place + 2) != items[k].bytes)
        throw broken();
      if (!is_known_version(items[k].type, items[k].version)) {
        throw file_.error_here("LAZ: found version " + std::to_string(items[k].version) +
                               " of item " + std::to_string(type) + ", which is unknown");
      }
    }
    return items;
  }

  const InputFile& file_;
  std::span<const std::byte> record_;
  const LasHeader& header_;
};

}  // namespace

LazPacking read_laz_packing(InputFile& file, const LasHeader& header) {
  std::optional<LazPacking> packing;
  file.skip(header.header_bytes);
  for (std::uint64_t k = 0; k < header.vlr_count; ++k) {
    const std::uint64_t room = header.points_offset_bytes - file.offset();
    const std::span<const std::byte> start = file.peek(kVlrHeaderBytes);
    const std::size_t bytes = load_value<std::uint16_t>(&start[20]);
    if (room < kVlrHeaderBytes + bytes) {
      throw file.error_here("LAZ: variable length record " + std::to_string(k) + " of " +
                            std::to_string(bytes) + " bytes reaches into the points");
    }
    const std::string_view user(reinterpret_cast<const char*>(start.data()) + 2, 16);
    const bool is_laszip =
        user.starts_with(kLaszipUser) && load_value<std::uint16_t>(&start[18]) == kLaszipRecordId;
    file.skip(kVlrHeaderBytes);
    if (is_laszip && packing) throw file.error_here("LAZ: a second record 'laszip encoded'");
    if (is_laszip) packing = PackingReader(file, file.peek(bytes).first(bytes), header).read();
    file.skip(bytes);
  }
  if (!packing) throw file.error_here("marked as LAZ, but without a record 'laszip encoded'");
  return *packing;
}

}  // namespace adasplats
