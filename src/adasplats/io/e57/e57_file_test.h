// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/io/base/files_test.h"

/// Composes E57 files byte by byte, after ASTM E2807-11.
namespace adasplats::io_test {

inline constexpr std::size_t kE57PageBytes = 1024;
inline constexpr std::size_t kE57PayloadBytes = 1020;

/// CRC-32C a bit at a time, from its definition.
inline std::uint32_t plain_crc32c(std::string_view bytes) {
  std::uint32_t rest = 0xffffffff;
  for (const char byte : bytes) {
    rest ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ (rest % 2 == 1 ? 0x82f63b78 : 0);
  }
  return ~rest;
}

/// Pads any bytes to pages with valid checksums, and sets the length in the header.
inline std::string sealed_e57(std::string file) {
  file.resize((file.size() + kE57PageBytes - 1) / kE57PageBytes * kE57PageBytes);
  if (!file.empty()) put(file, 16, static_cast<std::uint64_t>(file.size()));
  for (std::size_t page = 0; page < file.size(); page += kE57PageBytes) {
    const std::uint32_t crc = plain_crc32c(std::string_view(file).substr(page, kE57PayloadBytes));
    file.replace(page + kE57PayloadBytes, 4, big_endian(crc));
  }
  return file;
}

/// Numbers of any bits, the lowest bit first.
class PackedBits {
 public:
  PackedBits& put_bits(std::uint64_t value, unsigned bits) {
    for (unsigned k = 0; k < bits; ++k, ++count_) {
      if (count_ % 8 == 0) bytes_ += '\0';
      const unsigned bit = (value >> k) & 1;
      bytes_.back() =
          static_cast<char>(static_cast<unsigned char>(bytes_.back()) | (bit << (count_ % 8)));
    }
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t count_ = 0;
};

/// The bytes of values one behind the other.
template <class T>
std::string stream_of(const std::vector<T>& values) {
  std::string bytes;
  for (const T& value : values) bytes += bytes_of(value);
  return bytes;
}

inline std::string data_packet(const std::vector<std::string>& streams) {
  std::string lengths, bytes;
  for (const std::string& stream : streams) {
    lengths += bytes_of(static_cast<std::uint16_t>(stream.size()));
    bytes += stream;
  }
  std::size_t size = 6 + lengths.size() + bytes.size();
  while (size % 4 != 0) {
    bytes += '\0';
    ++size;
  }
  return std::string("\1\0", 2) + bytes_of(static_cast<std::uint16_t>(size - 1)) +
         bytes_of(static_cast<std::uint16_t>(streams.size())) + lengths + bytes;
}

/// An index packet (kind 0) or an ignored one (2) of that many bytes.
inline std::string other_packet(char kind, std::size_t bytes) {
  return std::string(1, kind) + std::string(1, '\0') +
         bytes_of(static_cast<std::uint16_t>(bytes - 1)) + std::string(bytes - 4, '?');
}

class E57Composer {
 public:
  /// Packets of points as a section; its physical offset.
  std::uint64_t add_section(const std::string& packets) {
    const std::uint64_t begin = bytes_.size();
    bytes_ += std::string("\1\0\0\0\0\0\0\0", 8) +
              bytes_of(static_cast<std::uint64_t>(32 + packets.size())) +
              bytes_of(physical(begin + 32)) + bytes_of(std::uint64_t{0}) + packets;
    return physical(begin);
  }

  /// A scan of that many points in that many bytes of each stream to a packet.
  void add_scan(std::size_t points, const std::string& prototype,
                const std::vector<std::string>& streams, const std::string& more = "",
                std::size_t packet_bytes = 500) {
    std::string packets;
    std::size_t longest = 0;
    for (const std::string& stream : streams) longest = std::max(longest, stream.size());
    for (std::size_t from = 0; from < longest; from += packet_bytes) {
      std::vector<std::string> pieces;
      pieces.reserve(streams.size());
      for (const std::string& stream : streams)
        pieces.push_back(stream.substr(std::min(from, stream.size()), packet_bytes));
      packets += data_packet(pieces);
    }
    add_scan_at(add_section(packets), points, prototype, more);
  }

  void add_scan_at(std::uint64_t section, std::size_t points, const std::string& prototype,
                   const std::string& more = "") {
    scans_ += "<vectorChild type=\"Structure\">" + more + "\n<points type=\"CompressedVector\"" +
              " fileOffset=\"" + std::to_string(section) + "\" recordCount=\"" +
              std::to_string(points) + "\"><prototype type=\"Structure\">" + prototype +
              "</prototype><codecs type=\"Vector\"/></points></vectorChild>\n";
  }

  /// `more`: further elements of the root.
  std::string file(const std::string& more = "") const {
    return file_of_xml(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
        "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\" "
        "xmlns:las=\"http://www.astm.org/COMMIT/E57/2010-las-v1.0\">" +
        more + "<data3D type=\"Vector\">" + scans_ + "</data3D></e57Root>\n");
  }

  std::string file_of_xml(const std::string& xml) const {
    std::string logical = bytes_ + xml;
    put(logical, 24, physical(bytes_.size()));
    put(logical, 32, static_cast<std::uint64_t>(xml.size()));
    std::string pages;
    for (std::size_t from = 0; from < logical.size(); from += kE57PayloadBytes) {
      pages += logical.substr(from, kE57PayloadBytes);
      pages.resize((pages.size() + kE57PageBytes - 1) / kE57PageBytes * kE57PageBytes);
    }
    return sealed_e57(pages);
  }

  static std::uint64_t physical(std::uint64_t logical) {
    return logical / kE57PayloadBytes * kE57PageBytes + logical % kE57PayloadBytes;
  }

 private:
  std::string scans_;
  std::string bytes_ = "ASTM-E57" + bytes_of(std::uint32_t{1}) + std::string(28, '\0') +
                       bytes_of(std::uint64_t{kE57PageBytes});
};

inline std::string float_field(const std::string& name, bool is_single = false) {
  return "<" + name + " type=\"Float\"" + (is_single ? " precision=\"single\"/>" : "/>");
}

inline std::string integer_field(const std::string& name, std::int64_t least, std::int64_t most,
                                 const std::string& scaling = "") {
  return "<" + name + " type=\"" + (scaling.empty() ? "Integer" : "ScaledInteger") +
         "\" minimum=\"" + std::to_string(least) + "\" maximum=\"" + std::to_string(most) + "\" " +
         scaling + "/>";
}

inline std::string xyz_fields() {
  return float_field("cartesianX") + float_field("cartesianY") + float_field("cartesianZ");
}

/// A pose: quaternion w, x, y, z, then the position.
inline std::string pose_element(const std::vector<std::string>& numbers) {
  return "<pose type=\"Structure\"><rotation type=\"Structure\"><w>" + numbers.at(0) + "</w><x>" +
         numbers.at(1) + "</x><y>" + numbers.at(2) + "</y><z>" + numbers.at(3) +
         "</z></rotation><translation type=\"Structure\"><x>" + numbers.at(4) + "</x><y>" +
         numbers.at(5) + "</y><z>" + numbers.at(6) + "</z></translation></pose>";
}

}  // namespace adasplats::io_test
