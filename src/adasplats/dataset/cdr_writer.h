// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "adasplats/dataset/ros_messages.h"

namespace adasplats {

// Private to dataset/: how ROS 2 messages are encoded and defined.

static_assert(std::endian::native == std::endian::little, "messages are written little-endian");

inline constexpr std::uint64_t kRosNanoseconds = 1'000'000'000;
/// Between the definition of a message and those of its parts.
inline constexpr std::string_view kRosSeparator =
    "================================================================================\n";
inline constexpr std::string_view kRosTime =
    "MSG: builtin_interfaces/Time\n"
    "int32 sec\n"
    "uint32 nanosec\n";
inline constexpr std::string_view kRosHeader =
    "MSG: std_msgs/Header\n"
    "builtin_interfaces/Time stamp\n"
    "string frame_id\n";

/// Values in CDR layout: each at a multiple of its size after the encapsulation.
class CdrWriter {
 public:
  explicit CdrWriter(std::size_t bytes) {
    bytes_.reserve(bytes);
    bytes_.append("\0\1\0\0", kEncapsulationBytes);  // CDR_LE, no options
  }
  template <class T>
  CdrWriter& put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    while ((bytes_.size() - kEncapsulationBytes) % sizeof(T) != 0) bytes_ += '\0';
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  CdrWriter& text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.append(value).push_back('\0');
    return *this;
  }
  CdrWriter& time(double time_s) {
    const std::uint64_t time_ns = ros_time_ns(time_s);
    return put(static_cast<std::int32_t>(time_ns / kRosNanoseconds))
        .put(static_cast<std::uint32_t>(time_ns % kRosNanoseconds));
  }
  CdrWriter& header(double time_s, std::string_view frame) { return time(time_s).text(frame); }
  /// Reserves an array of bytes and returns its begin.
  char* array(std::size_t size) {
    put(static_cast<std::uint32_t>(size));
    bytes_.resize(bytes_.size() + size);
    return bytes_.data() + bytes_.size() - size;
  }
  std::string take() { return std::move(bytes_); }

 private:
  static constexpr std::size_t kEncapsulationBytes = 4;
  std::string bytes_;
};

}  // namespace adasplats
