// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "adasplats/io/bags/byte_reader.h"
#include "adasplats/io/bags/recording.h"

namespace adasplats {

/// Reads the values of one ROS message in order.
/// - ROS 1 ("msg" of the ROS wiki): little-endian, without padding.
/// - CDR (OMG DDS-XTypes 1.3, 7.4, versions 1 and 2 of final types): after 4 bytes with the byte
///   order, each value at a multiple of its size (at most 4 in version 2); the length of texts
///   includes a final zero.
class RosReader {
 public:
  RosReader(std::string_view bytes, MessageEncoding encoding, const std::string& what)
      : reader_(bytes, what), is_cdr_(encoding == MessageEncoding::cdr) {
    static_assert(std::endian::native == std::endian::little);
    if (encoding == MessageEncoding::other)
      throw reader_.error("has an unsupported serialization, expected cdr or ros1");
    if (!is_cdr_) return;
    const auto high = reader_.number<std::uint8_t>();
    const auto low = reader_.number<std::uint8_t>();
    reader_.take(2);  // options
    constexpr std::uint8_t kPlain1 = 0, kPlain2 = 6;
    const std::uint8_t kind = low & 0xfe;
    if (high != 0 || (kind != kPlain1 && kind != kPlain2))
      throw reader_.error("begins with an encapsulation of " + std::to_string(high) + " " +
                          std::to_string(low) + ", expected plain CDR (0 0, 0 1, 0 6 or 0 7)");
    swap_ = (low & 1) == 0;
    max_alignment_ = kind == kPlain2 ? 4 : 8;
  }

  bool is_ros1() const { return !is_cdr_; }

  template <class T>
  T number() {
    align(sizeof(T));
    return reader_.number<T>(swap_);
  }
  std::string text() {
    const std::uint32_t size = number<std::uint32_t>();
    std::string_view bytes = reader_.take(size);
    if (is_cdr_ && bytes.ends_with('\0')) bytes.remove_suffix(1);
    return std::string(bytes);
  }
  /// uint8[]
  std::string_view bytes() {
    const std::uint32_t size = number<std::uint32_t>();
    return reader_.take(size);
  }
  /// The number of elements that follow, of at least `min_bytes` each.
  std::uint32_t count(std::size_t min_bytes) {
    const std::uint32_t count = number<std::uint32_t>();
    if (count > reader_.remaining() / min_bytes)
      throw reader_.error("states " + std::to_string(count) + " elements, but has " +
                          std::to_string(reader_.remaining()) + " bytes");
    return count;
  }
  /// uint8[N] of a fixed length
  std::string_view take(std::size_t bytes) { return reader_.take(bytes); }
  Error error(const std::string& message) const { return reader_.error(message); }

 private:
  void align(std::size_t size) {
    if (!is_cdr_) return;
    constexpr std::size_t kEncapsulationBytes = 4;
    const std::size_t alignment = size < max_alignment_ ? size : max_alignment_;
    const std::size_t over = (reader_.place() - kEncapsulationBytes) % alignment;
    if (over != 0) reader_.take(alignment - over);
  }

  ByteReader reader_;
  bool is_cdr_;
  bool swap_ = false;
  std::size_t max_alignment_ = 8;
};

}  // namespace adasplats
