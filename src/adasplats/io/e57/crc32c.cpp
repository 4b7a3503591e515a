// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/crc32c.h"

#include <array>
#include <cstring>

namespace adasplats {
namespace {

constexpr std::uint32_t kCastagnoliReversed = 0x82f63b78;
constexpr std::size_t kCrcStep = 8;  // bytes that are taken at once

/// kCrcTables[k][b]: what the byte b does to the remainder when k zero bytes follow it.
constexpr std::array<std::array<std::uint32_t, 256>, kCrcStep> make_crc_tables() {
  std::array<std::array<std::uint32_t, 256>, kCrcStep> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit)
      rest = (rest >> 1) ^ ((rest & 1) != 0 ? kCastagnoliReversed : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < kCrcStep; ++k)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t rest = tables[k - 1][byte];
      tables[k][byte] = (rest >> 8) ^ tables[0][rest & 0xff];
    }
  return tables;
}

constexpr auto kCrcTables = make_crc_tables();

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes) {
  std::uint32_t rest = 0xffffffff;
  for (; bytes.size() >= kCrcStep; bytes = bytes.subspan(kCrcStep)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), kCrcStep);
    word ^= rest;
    rest = 0;
    for (std::size_t k = 0; k < kCrcStep; ++k)
      rest ^= kCrcTables[kCrcStep - 1 - k][(word >> (8 * k)) & 0xff];
  }
  for (const std::byte byte : bytes)
    rest = (rest >> 8) ^ kCrcTables[0][(rest ^ std::to_integer<std::uint32_t>(byte)) & 0xff];
  return ~rest;
}

}  // namespace adasplats
