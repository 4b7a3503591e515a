// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace adasplats {

/// Compresses `count` records (at least one) of `record_bytes`, point format 6 (30 bytes), 7 (also
/// 6 `colour_bytes`) or 8 (8, with near infrared) with extra bytes, as one layered chunk of items
/// of version 3, with the same bytes as LASzip.
std::string pack_layered_chunk(const std::byte* records, std::size_t count,
                               std::size_t record_bytes, std::size_t colour_bytes = 0);

/// Compresses the table of chunks with a fixed number of points: the bytes of each chunk.
std::string pack_chunk_table(std::span<const std::uint32_t> chunk_bytes);

}  // namespace adasplats
