// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace adasplats {

/// The most that LZF can unpack from one byte: 3 bytes stand for 264 at best.
inline constexpr std::uint64_t kLzfLargestRatio = 88;

/// Unpacks an LZF stream that holds exactly `unpacked_bytes`; nothing where the stream is broken
/// or holds another amount. The format: a control byte below 32 begins a run of control + 1
/// literal bytes; else its upper 3 bits (7: plus the next byte) are a length - 2 and its lower 5
/// bits with the following byte a distance back - 1.
std::optional<std::vector<std::byte>> unpack_lzf(std::span<const std::byte> packed,
                                                 std::size_t unpacked_bytes);

}  // namespace adasplats
