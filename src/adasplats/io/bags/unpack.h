// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "adasplats/core/function_ref.h"

namespace adasplats {

/// Maximum size of a decompressed chunk of a recording: more than any message of a sensor.
inline constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{1} << 30;

/// Decompresses a stream of zstd (RFC 8878), an lz4 frame (LZ4 Frame Format 1.6) or bz2, named by
/// `packing`; "" and "none" mean uncompressed. The result must have exactly `size` bytes. `where`
/// begins error messages. Memory grows with the result, not with `size`, up to kMaxChunkBytes.
/// Errors: data (damaged, another size, unknown `packing`), unavailable (built without the
/// library).
std::string unpack(std::string_view packing, std::string_view packed, std::uint64_t size,
                   const std::string& where);

/// Decompresses a frame of zstd with its size in the header, as ROS 2 writes for single messages;
/// empty for no bytes. Errors: as unpack(); data (no size in the header).
std::string unpack_sized(std::string_view packing, std::string_view packed,
                         const std::string& where);

/// Decompresses consecutive frames of zstd part by part: next(n) consumes n bytes of the last part
/// and returns the following bytes, nothing at the end; take() receives the decompressed bytes.
/// Memory: as the frames require, at most 128 MiB. Errors: data (damaged, truncated), unavailable,
/// and those of next() and take().
void unpack_zstd_stream(FunctionRef<std::string_view(std::size_t)> next,
                        FunctionRef<void(std::string_view)> take, const std::string& where);

}  // namespace adasplats
