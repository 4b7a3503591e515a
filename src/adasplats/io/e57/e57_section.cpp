// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/e57_section.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "adasplats/io/base/records.h"
#include "adasplats/io/e57/field_decoder.h"

namespace adasplats {
namespace {

constexpr std::size_t kSectionHeaderBytes = 32;
constexpr std::size_t kPacketStartBytes = 4;  // kind, flags, length: the same in all packets
constexpr std::size_t kDataHeaderBytes = 6;
constexpr std::uint8_t kIndexPacket = 0, kDataPacket = 1, kIgnoredPacket = 2;

/// The minimum bits of a record, at least one for each field: that bounds the memory for fields
/// that take no bits since they are equal in all points.
std::uint64_t min_record_bits(const E57Scan& scan) {
  std::uint64_t bits = 0;
  for (const E57Field& field : scan.fields)
    bits += field.codec == E57Codec::other ? 8 : field.bits;  // a text has a length byte
  return std::max<std::uint64_t>({1, bits, scan.fields.size()});
}

/// Walks the packets of a section.
class PacketReader {
 public:
  PacketReader(PagedFile& file, const E57Scan& scan, const E57Section& section,
               const std::vector<bool>& wanted)
      : file_(file), scan_(scan), offset_(section.packets), end_(section.end) {
    for (std::size_t k = 0; k < scan.fields.size(); ++k) {
      decoders_.emplace_back();
      if (wanted[k]) decoders_.back().emplace(scan.fields[k], scan.points);
    }
  }

  std::vector<std::vector<double>> read() {
    while (offset_ < end_ && !is_complete()) take_packet();
    std::vector<std::vector<double>> values;
    for (std::size_t k = 0; k < decoders_.size(); ++k) {
      auto& decoder = decoders_[k];
      if (decoder && !decoder->is_complete())
        throw file_.error_at(end_ - 1, scan_.name + ": the section of its points ends here, with " +
                                           std::to_string(decoder->values().size()) +
                                           " values of " + scan_.fields[k].name +
                                           ", recordCount is " + std::to_string(scan_.points));
      values.push_back(decoder ? decoder->take_values() : std::vector<double>());
    }
    return values;
  }

 private:
  bool is_complete() const {
    return std::ranges::all_of(
        decoders_, [](const auto& decoder) { return !decoder || decoder->is_complete(); });
  }

  Error error(const std::string& message) const {
    return file_.error_at(offset_, scan_.name + ": " + message);
  }

  void take_packet() {
    std::array<std::byte, kPacketStartBytes> start{};
    if (end_ - offset_ < start.size()) throw error("no room for another packet");
    file_.read(offset_, start);
    const std::size_t bytes = std::size_t{1} + load_value<std::uint16_t>(&start[2]);
    if (bytes < start.size() || bytes > end_ - offset_)
      throw error("found a packet of " + std::to_string(bytes) + " bytes, the section has " +
                  std::to_string(end_ - offset_) + " more");
    const auto kind = load_value<std::uint8_t>(&start[0]);
    if (kind == kDataPacket) {
      packet_.resize(bytes);
      file_.read(offset_, packet_);
      take_data();
    } else if (kind != kIndexPacket && kind != kIgnoredPacket) {
      throw error("found a packet of kind " + std::to_string(kind) +
                  ", expected 0 (index), 1 (data) or 2 (ignored)");
    }
    offset_ += bytes;
  }

  void take_data() {
    const std::size_t fields = decoders_.size();
    const std::size_t streams =
        packet_.size() < kDataHeaderBytes ? 0 : load_value<std::uint16_t>(&packet_[4]);
    if (streams != fields)
      throw error("found a packet of " + std::to_string(streams) + " fields, the points have " +
                  std::to_string(fields));
    std::size_t from = kDataHeaderBytes + 2 * streams;
    for (std::size_t k = 0; k < streams; ++k) {
      const std::size_t length_at = kDataHeaderBytes + 2 * k;
      const std::size_t bytes = length_at + 2 > packet_.size()
                                    ? packet_.size()
                                    : load_value<std::uint16_t>(&packet_[length_at]);
      if (from > packet_.size() || bytes > packet_.size() - from)
        throw error("the fields of a packet are longer than the packet");
      if (decoders_[k]) decoders_[k]->take(std::span(packet_).subspan(from, bytes));
      from += bytes;
    }
  }

  PagedFile& file_;
  const E57Scan& scan_;
  std::uint64_t offset_;
  std::uint64_t end_;
  std::vector<std::optional<FieldDecoder>> decoders_;  ///< none: not wanted
  std::vector<std::byte> packet_;
};

}  // namespace

E57Section read_e57_section(PagedFile& file, const E57Scan& scan) {
  E57Section section;
  section.begin = file.logical_offset(scan.section_offset, scan.name + ": the section of points");
  std::array<std::byte, kSectionHeaderBytes> header{};
  file.read(section.begin, header);
  const auto reject = [&](const std::string& message) {
    throw file.error_at(section.begin, scan.name + ": " + message);
  };
  const auto kind = load_value<std::uint8_t>(&header[0]);
  if (kind != 1)
    reject("found a section of kind " + std::to_string(kind) + ", expected 1 (points)");
  const auto bytes = load_value<std::uint64_t>(&header[8]);
  if (bytes < header.size() || bytes > file.size_bytes() - section.begin)
    reject("found a section of " + std::to_string(bytes) + " bytes, the file has " +
           std::to_string(file.size_bytes() - section.begin) + " from here on");
  section.end = section.begin + bytes;
  section.packets =
      file.logical_offset(load_value<std::uint64_t>(&header[16]), scan.name + ": its first packet");
  if (section.packets < section.begin + header.size() || section.packets > section.end)
    reject("its first packet is outside the section");
  const std::uint64_t room = 8 * (section.end - section.packets) / min_record_bits(scan);
  if (scan.points > room)
    reject("found room for at most " + std::to_string(room) + " points, recordCount is " +
           std::to_string(scan.points));
  return section;
}

std::vector<std::vector<double>> read_e57_fields(PagedFile& file, const E57Scan& scan,
                                                 const E57Section& section,
                                                 const std::vector<bool>& wanted) {
  return PacketReader(file, scan, section, wanted).read();
}

}  // namespace adasplats
