// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "adasplats/core/error.h"

namespace adasplats {

/// Reads values one behind the other out of bytes in memory; every access is checked.
class ByteReader {
 public:
  /// `what` is named in errors, "drive.mcap: byte 17: schema" say.
  ByteReader(std::string_view bytes, std::string what) : bytes_(bytes), what_(std::move(what)) {}

  template <class T>
  T number(bool swap_bytes = false) {
    static_assert(std::is_arithmetic_v<T>);
    char raw[sizeof(T)];
    std::memcpy(raw, take(sizeof(T)).data(), sizeof(T));
    if (swap_bytes) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }
  std::string_view take(std::uint64_t count) {
    if (count > remaining())
      throw error("ends early: " + std::to_string(count) + " bytes expected at byte " +
                  std::to_string(place_) + " of it, " + std::to_string(remaining()) + " found");
    const std::string_view part = bytes_.substr(place_, static_cast<std::size_t>(count));
    place_ += part.size();
    return part;
  }
  /// Bytes behind their number, 32 bits.
  std::string_view text() { return take(number<std::uint32_t>()); }

  std::size_t place() const { return place_; }
  std::size_t remaining() const { return bytes_.size() - place_; }
  Error error(const std::string& message) const { return {ErrorKind::data, what_ + " " + message}; }

 private:
  std::string_view bytes_;
  std::string what_;
  std::size_t place_ = 0;
};

}  // namespace adasplats
