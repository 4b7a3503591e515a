// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "adasplats/io/laz/laz_item.h"

namespace adasplats {

/// Maximum points in a byte of a chunk, rounded up: each point costs at least the symbol of its
/// changes and the lengths of x, y and z or of x and y, where the models give a symbol at most all
/// but 63, 32, 32 and 32 (127, 32 and 32) parts of 2^15.
inline constexpr std::uint64_t kMaxPointsPerByte = 2048;

/// Decompresses the records of one chunk to those of LAS, a part at a time. It ends and stays
/// within the bytes for any input.
class PackedChunk {
 public:
  PackedChunk() = default;
  virtual ~PackedChunk() = default;
  PackedChunk(const PackedChunk&) = delete;
  PackedChunk& operator=(const PackedChunk&) = delete;

  /// Writes the next `count` records; returns how many of them are complete. If fewer, there are no
  /// more.
  virtual std::size_t decode(std::byte* records, std::size_t count) = 0;
  /// Bytes of the chunk; of a pointwise chunk those of the records so far.
  virtual std::size_t bytes() const = 0;
};

/// `bytes` begin with the chunk, and must outlive it.
std::unique_ptr<PackedChunk> make_packed_chunk(const LazPacking& packing,
                                               std::span<const std::byte> bytes);

// The two kinds; make_packed_chunk() picks.
std::unique_ptr<PackedChunk> make_pointwise_chunk(const LazPacking& packing,
                                                  std::span<const std::byte> bytes);
std::unique_ptr<PackedChunk> make_layered_chunk(const LazPacking& packing,
                                                std::span<const std::byte> bytes);

}  // namespace adasplats
