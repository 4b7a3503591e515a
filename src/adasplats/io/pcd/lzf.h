// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace adasplats {

/// Maximum expansion of LZF: 3 bytes give at most 264.
inline constexpr std::uint64_t kLzfLargestRatio = 88;

/// Decompresses an LZF stream of exactly `unpacked_bytes`; nothing if the stream is damaged or has
/// another size. The format: a control byte below 32 begins a run of control + 1 literal bytes;
/// else its upper 3 bits (7: plus the next byte) are a length - 2 and its lower 5 bits with the
/// following byte a distance back - 1.
std::optional<std::vector<std::byte>> unpack_lzf(std::span<const std::byte> packed,
                                                 std::size_t unpacked_bytes);

}  // namespace adasplats
