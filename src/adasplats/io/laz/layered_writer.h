// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace adasplats {

/// Packs `count` records (at least one) of point format 6 with extra bytes behind its 30, each of
/// `record_bytes`, as one layered chunk of items of version 3: what make_layered_chunk() unpacks,
/// with the bytes that LASzip gives them.
std::string pack_layered_chunk(const std::byte* records, std::size_t count,
                               std::size_t record_bytes);

/// Packs the table of chunks that have a fixed number of points, as ChunkTable unpacks it: how many
/// bytes each takes.
std::string pack_chunk_table(std::span<const std::uint32_t> chunk_bytes);

}  // namespace adasplats
