// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/neighbors/hilbert.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

/// Private to levels/: how many halvings of the cube two cells of the Hilbert curve share, from the
/// top: kHilbertBits where they are the same.
inline int shared_levels(std::uint64_t a, std::uint64_t b) {
  return a == b ? kHilbertBits : (std::countl_zero(a ^ b) - 1) / 3;
}

/// Consecutive elements of a LevelOrder: one node of an octree, its cube the one of `level`
/// halvings of the grid that holds them all.
struct LevelBlock {
  std::size_t begin = 0;
  std::size_t end = 0;
  HilbertGrid grid{{}, {}};
  int level = 0;

  std::size_t size() const { return end - begin; }
  /// Side of the cubes of a level, m.
  float side_m(int of_level) const;
};

/// Splats or points along a Hilbert curve. A cube of an octree is a run of keys with the same
/// leading bits, and cubes that follow each other touch.
class LevelOrder {
 public:
  /// One of the two is empty.
  LevelOrder(std::span<const Disk> disks, std::span<const Vec3f> positions,
             const Executor& executor);

  std::size_t size() const { return sources_.size(); }
  bool has_disks() const { return !disks_.empty(); }
  std::span<const Disk> disks() const { return disks_; }
  Vec3f position(std::size_t i) const { return disks_.empty() ? positions_[i] : disks_[i].center; }
  /// Numbers of the elements in the input.
  std::span<const std::uint32_t> sources() const { return sources_; }
  /// End of the run from `i` of elements in the same cube of `level` halvings, at most `end`.
  std::size_t run_end(std::size_t i, std::size_t end, int level) const;

  /// All elements.
  const LevelBlock& whole() const { return whole_; }
  /// Takes the smallest cube around a block. Where the curve does not keep its elements apart (far
  /// outliers made its cells too large), puts them in the order of a curve over their own box. Only
  /// equal positions leave a block of kHilbertBits. Changes no element outside the block.
  void tighten(LevelBlock& block, const Executor& executor);
  /// Longest side of the box of a block's positions, m.
  float box_side_m(const LevelBlock& block) const;
  /// The parts of a tightened block: its cube's octants, neighbours joined while they have at most
  /// `most` elements together; equal positions in eight parts of equal size.
  std::vector<LevelBlock> split(const LevelBlock& block, std::size_t most) const;
  /// How many cubes of 0, 1, ... kHilbertBits halvings a tightened block has elements in.
  std::vector<std::size_t> occupied(const LevelBlock& block, const Executor& executor) const;

 private:
  LevelBlock whole_;
  std::vector<Disk> disks_;
  std::vector<Vec3f> positions_;
  std::vector<std::uint32_t> sources_;
  std::vector<std::uint64_t> keys_;
};

}  // namespace adasplats
