// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "adasplats/core/function_ref.h"

namespace adasplats {

/// The most that a packed chunk of a recording may hold: more than any message of a sensor.
inline constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{1} << 30;

/// Unpacks what is one stream of zstd (RFC 8878), an lz4 frame (LZ4 Frame Format 1.6) or bz2, as
/// `packing` calls it; "" and "none" are not packed. It must give exactly `size` bytes. `where`
/// begins messages. Memory grows with what is unpacked, whatever `size` says; kMaxChunkBytes at
/// most. Errors: data (broken, another size, another word), unavailable (a packing whose library
/// was not there when the program was built).
std::string unpack(std::string_view packing, std::string_view packed, std::uint64_t size,
                   const std::string& where);

/// Unpacks a frame of zstd that says its size, as ROS 2 packs single messages; no bytes are no
/// message. Errors: as unpack(); data where the size is not said.
std::string unpack_sized(std::string_view packing, std::string_view packed,
                         const std::string& where);

/// Unpacks frames of zstd, one behind the other, piece by piece: next(n) says that n bytes of the
/// piece before were used up, and gives what follows, nothing at the end; take() gets what comes of
/// it. Memory: what the frames ask for, 128 MiB at most. Errors: data (broken, cut off),
/// unavailable, and those of the two.
void unpack_zstd_stream(FunctionRef<std::string_view(std::size_t)> next,
                        FunctionRef<void(std::string_view)> take, const std::string& where);

}  // namespace adasplats
