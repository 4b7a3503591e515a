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

/// Private to levels/. Number of levels (halvings of the cube) that two cells of the Hilbert curve
/// share, from the top: kHilbertBits if they are equal.
inline int shared_levels(std::uint64_t a, std::uint64_t b) {
  return a == b ? kHilbertBits : (std::countl_zero(a ^ b) - 1) / 3;
}

/// Consecutive elements of a LevelOrder: an octree node, with the cube that contains them after
/// `level` halvings of the grid.
struct LevelBlock {
  std::size_t begin = 0;
  std::size_t end = 0;
  HilbertGrid grid{{}, {}};
  int level = 0;

  std::size_t size() const { return end - begin; }
  /// Side of the cubes of a level, m.
  float side_m(int of_level) const;
};

/// Splats or points along a Hilbert curve. An octree cube is a run of keys with the same leading
/// bits, and consecutive cubes touch.
class LevelOrder {
 public:
  /// One of `disks` and `positions` must be empty.
  LevelOrder(std::span<const Disk> disks, std::span<const Vec3f> positions,
             const Executor& executor);

  std::size_t size() const { return sources_.size(); }
  bool has_disks() const { return !disks_.empty(); }
  std::span<const Disk> disks() const { return disks_; }
  Vec3f position(std::size_t i) const { return disks_.empty() ? positions_[i] : disks_[i].center; }
  /// Indices of the elements in the input.
  std::span<const std::uint32_t> sources() const { return sources_; }
  /// End of the run of elements from `i` on in the same cube of `level` halvings, at most `end`.
  std::size_t run_end(std::size_t i, std::size_t end, int level) const;

  /// All elements.
  const LevelBlock& whole() const { return whole_; }
  /// Sets a block to the smallest cube around its elements. If they share one cell of the curve
  /// (since distant outliers make cells large), sorts them along a curve over their own box. After
  /// that only equal positions have the level kHilbertBits. Elements outside the block do not
  /// change.
  void tighten(LevelBlock& block, const Executor& executor);
  /// Longest side of the box of a block's positions, m.
  float box_side_m(const LevelBlock& block) const;
  /// Splits a tightened block into the octants of its cube; joins neighbours with at most
  /// `max_joined` elements together. Splits equal positions into eight parts of equal size.
  std::vector<LevelBlock> split(const LevelBlock& block, std::size_t max_joined) const;
  /// Number of cubes with elements of a tightened block, for 0, 1, ... kHilbertBits halvings.
  std::vector<std::size_t> occupied(const LevelBlock& block, const Executor& executor) const;

 private:
  LevelBlock whole_;
  std::vector<Disk> disks_;
  std::vector<Vec3f> positions_;
  std::vector<std::uint32_t> sources_;
  std::vector<std::uint64_t> keys_;
};

}  // namespace adasplats
