// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace adasplats {

/// Private to io/packets: numbers in network byte order, and sizes of headers.

inline constexpr std::size_t kEthernetBytes = 14, kIpv4Bytes = 20, kUdpBytes = 8;
inline constexpr std::uint16_t kEtherIpv4 = 0x0800;
inline constexpr std::uint8_t kProtocolUdp = 17;
/// Units of 8 bytes that the offset of a fragment counts.
inline constexpr std::size_t kFragmentUnit = 8;
inline constexpr std::uint16_t kMoreFragments = 0x2000, kFragmentOffset = 0x1FFF;

template <std::unsigned_integral T>
T big_endian_at(std::string_view bytes, std::size_t place) {
  T value = 0;
  for (std::size_t k = 0; k < sizeof(T); ++k)
    value = static_cast<T>(value << 8U) | static_cast<std::uint8_t>(bytes[place + k]);
  return value;
}

template <std::unsigned_integral T>
void append_big_endian(std::string& bytes, T value) {
  for (std::size_t k = sizeof(T); k-- > 0;) bytes += static_cast<char>(value >> (8 * k) & 0xFFU);
}

template <std::unsigned_integral T>
void append_little_endian(std::string& bytes, T value) {
  for (std::size_t k = 0; k < sizeof(T); ++k) bytes += static_cast<char>(value >> (8 * k) & 0xFFU);
}

/// Continues `sum` of an Internet checksum (RFC 1071), not yet inverted. Only the last part may
/// have an odd number of bytes.
inline std::uint32_t add_to_checksum(std::string_view bytes, std::uint32_t sum) {
  for (std::size_t k = 0; k < bytes.size(); k += 2) {
    const std::uint32_t low = k + 1 < bytes.size() ? static_cast<std::uint8_t>(bytes[k + 1]) : 0U;
    sum += static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[k])) << 8U | low;
  }
  while (sum >> 16U != 0) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return sum;
}

}  // namespace adasplats
