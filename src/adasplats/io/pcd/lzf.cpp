// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pcd/lzf.h"

#include <cstring>

namespace adasplats {

std::optional<std::vector<std::byte>> unpack_lzf(std::span<const std::byte> packed,
                                                 std::size_t unpacked_bytes) {
  std::vector<std::byte> unpacked(unpacked_bytes);
  std::size_t in = 0;
  std::size_t out = 0;
  while (in < packed.size()) {
    const std::size_t control = std::to_integer<std::size_t>(packed[in++]);
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() - in || length > unpacked_bytes - out) return std::nullopt;
      std::memcpy(unpacked.data() + out, packed.data() + in, length);
      in += length;
      out += length;
      continue;
    }
    std::size_t length = control >> 5;
    const std::size_t more_bytes = length == 7 ? 2 : 1;
    if (packed.size() - in < more_bytes) return std::nullopt;
    if (length == 7) length += std::to_integer<std::size_t>(packed[in++]);
    length += 2;
    const std::size_t distance =
        ((control & 31) << 8) + std::to_integer<std::size_t>(packed[in++]) + 1;
    if (distance > out || length > unpacked_bytes - out) return std::nullopt;
    // The source may overlap the target: copying byte by byte repeats the bytes just written.
    for (std::size_t k = 0; k < length; ++k, ++out) unpacked[out] = unpacked[out - distance];
  }
  if (out != unpacked_bytes) return std::nullopt;
  return unpacked;
}

}  // namespace adasplats
