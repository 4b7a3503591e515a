// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "adasplats/io/laz/laz_item.h"

namespace adasplats {

/// The most points that a byte of a chunk can stand for, rounded up: each point costs at least
/// the symbol of what changed and the lengths of x, y and z or of x and y, whose models never
/// give a symbol more than all but 63, 32, 32 and 32 (127, 32 and 32) parts of 2^15.
inline constexpr std::uint64_t kMaxPointsPerByte = 2048;

/// Unpacks the records of one chunk as a LAS file has them, a part at a time. Whatever the bytes
/// are, it ends and stays in them.
class PackedChunk {
 public:
  PackedChunk() = default;
  virtual ~PackedChunk() = default;
  PackedChunk(const PackedChunk&) = delete;
  PackedChunk& operator=(const PackedChunk&) = delete;

  /// Writes the next `count` records; gives how many of them were whole. No more follow once it
  /// were fewer.
  virtual std::size_t decode(std::byte* records, std::size_t count) = 0;
  /// How many bytes the chunk takes: of one whose points come one by one what the records so far
  /// took.
  virtual std::size_t bytes() const = 0;
};

/// `bytes` begin with the chunk, and have to outlive it.
std::unique_ptr<PackedChunk> make_packed_chunk(const LazPacking& packing,
                                               std::span<const std::byte> bytes);

// The two kinds; make_packed_chunk() picks.
std::unique_ptr<PackedChunk> make_pointwise_chunk(const LazPacking& packing,
                                                  std::span<const std::byte> bytes);
std::unique_ptr<PackedChunk> make_layered_chunk(const LazPacking& packing,
                                                std::span<const std::byte> bytes);

}  // namespace adasplats
