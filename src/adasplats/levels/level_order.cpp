// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/levels/level_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace adasplats {
namespace {

/// Minimum side of a box with cells: below it, cells per metre overflow.
constexpr float kMinSide_m = 1e-25F;
constexpr std::size_t kMaxChildren = 8;

/// Grid over the box of position_of(0 .. count - 1); without cells if the box is a point or not
/// finite.
template <class PositionOf>
HilbertGrid grid_over(std::size_t count, const PositionOf& position_of, const Executor& executor) {
  const CurveBox box = curve_box_of(count, position_of, executor);
  const Vec3f size = box.high - box.low;
  const bool has_cells = is_finite(size) && std::max({size.x, size.y, size.z}) > kMinSide_m;
  return has_cells ? HilbertGrid(box.low, box.high) : HilbertGrid({}, {});
}

struct CurveOrder {
  std::vector<std::uint64_t> keys;   ///< ascending
  std::vector<std::uint32_t> order;  ///< order[k]: index of the element with keys[k]
};

template <class PositionOf>
CurveOrder order_along_curve(std::size_t count, const HilbertGrid& grid,
                             const PositionOf& position_of, const Executor& executor) {
  CurveOrder curve;
  curve.keys.resize(count);
  const bool has_cells = grid.cells_per_m > 0;
  executor.for_chunks(count, kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && has_cells; ++i) {
      const Vec3<std::uint32_t> cell = grid.cell(position_of(i));
      curve.keys[i] = hilbert_key(cell.x, cell.y, cell.z);
    }
  });
  executor.sort_keys(curve.keys, curve.order);
  return curve;
}

template <class T>
std::vector<T> gathered(std::span<const T> values, const std::vector<std::uint32_t>& order,
                        const Executor& executor) {
  if (values.empty()) return {};
  std::vector<T> result(order.size());
  executor.for_chunks(order.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) result[k] = values[order[k]];
  });
  return result;
}

/// Moves values[begin + order[k]] to values[begin + k].
template <class T>
void permute(std::vector<T>& values, std::size_t begin, const std::vector<std::uint32_t>& order,
             const Executor& executor) {
  if (values.empty()) return;
  const std::vector<T> result =
      gathered(std::span<const T>(values).subspan(begin, order.size()), order, executor);
  std::ranges::copy(result, values.begin() + static_cast<std::ptrdiff_t>(begin));
}

}  // namespace

float LevelBlock::side_m(int of_level) const {
  if (!(grid.cells_per_m > 0)) return 0;
  return std::ldexp(1.0F, kHilbertBits - of_level) / grid.cells_per_m;
}

LevelOrder::LevelOrder(std::span<const Disk> disks, std::span<const Vec3f> positions,
                       const Executor& executor)
    : whole_{0, disks.size() + positions.size()} {
  const auto position_of = [&](std::size_t i) {
    return disks.empty() ? positions[i] : disks[i].center;
  };
  whole_.grid = grid_over(whole_.size(), position_of, executor);
  CurveOrder curve = order_along_curve(whole_.size(), whole_.grid, position_of, executor);
  keys_ = std::move(curve.keys);
  sources_ = std::move(curve.order);
  disks_ = gathered(disks, sources_, executor);
  positions_ = gathered(positions, sources_, executor);
}

std::size_t LevelOrder::run_end(std::size_t i, std::size_t end, int level) const {
  const int shift = 3 * (kHilbertBits - level);
  const std::uint64_t cube = keys_[i] >> shift;
  // Runs are short, or as long as the block: doubling steps suit both.
  std::size_t step = 1;
  while (i + step < end && keys_[i + step] >> shift == cube) step *= 2;
  const auto first = keys_.begin() + static_cast<std::ptrdiff_t>(i + step / 2);
  const auto last = keys_.begin() + static_cast<std::ptrdiff_t>(std::min(i + step, end));
  return static_cast<std::size_t>(
      std::partition_point(first, last, [&](std::uint64_t key) { return key >> shift == cube; }) -
      keys_.begin());
}

float LevelOrder::box_side_m(const LevelBlock& block) const {
  CurveBox box = CurveBox::empty();
  for (std::size_t i = block.begin; i < block.end; ++i) box.add(position(i));
  const Vec3f size = box.high - box.low;
  return std::max({size.x, size.y, size.z, 0.0F});
}

void LevelOrder::tighten(LevelBlock& block, const Executor& executor) {
  if (block.size() == 0) return;
  block.level = shared_levels(keys_[block.begin], keys_[block.end - 1]);
  if (block.level < kHilbertBits) return;
  const auto position_of = [&](std::size_t k) { return position(block.begin + k); };
  const HilbertGrid own = grid_over(block.size(), position_of, executor);
  if (!(own.cells_per_m > 0)) return;
  block.grid = own;
  const CurveOrder curve = order_along_curve(block.size(), own, position_of, executor);
  std::ranges::copy(curve.keys, keys_.begin() + static_cast<std::ptrdiff_t>(block.begin));
  permute(disks_, block.begin, curve.order, executor);
  permute(positions_, block.begin, curve.order, executor);
  permute(sources_, block.begin, curve.order, executor);
  block.level = shared_levels(keys_[block.begin], keys_[block.end - 1]);
}

std::vector<LevelBlock> LevelOrder::split(const LevelBlock& block, std::size_t max_joined) const {
  std::vector<LevelBlock> parts;
  const auto add = [&](std::size_t begin, std::size_t end) {
    parts.push_back({begin, end, block.grid, block.level});
  };
  if (block.level >= kHilbertBits) {
    for (std::size_t k = 0; k < kMaxChildren; ++k) {
      const std::size_t begin = block.begin + block.size() * k / kMaxChildren;
      const std::size_t end = block.begin + block.size() * (k + 1) / kMaxChildren;
      if (begin < end) add(begin, end);
    }
    return parts;
  }
  for (std::size_t begin = block.begin; begin < block.end;) {
    const std::size_t end = run_end(begin, block.end, block.level + 1);
    if (!parts.empty() && end - parts.back().begin <= max_joined)
      parts.back().end = end;
    else
      add(begin, end);
    begin = end;
  }
  return parts;
}

std::vector<std::size_t> LevelOrder::occupied(const LevelBlock& block,
                                              const Executor& executor) const {
  // Number of elements that begin a new cube at each level, but not above it.
  struct Counts {
    std::array<std::size_t, kHilbertBits + 1> first{};
    Counts& operator+=(const Counts& other) {
      for (std::size_t k = 0; k < first.size(); ++k) first[k] += other.first[k];
      return *this;
    }
  };
  const Counts counts = executor.sum_chunks(
      block.size(), kCoarseGrain, Counts{}, [&](std::size_t begin, std::size_t end) {
        Counts part;
        for (std::size_t i = block.begin + begin; i < block.begin + end; ++i) {
          if (i == block.begin) continue;
          const int shared = shared_levels(keys_[i - 1], keys_[i]);
          if (shared < kHilbertBits) ++part.first[static_cast<std::size_t>(shared) + 1];
        }
        return part;
      });
  std::vector<std::size_t> cubes(kHilbertBits + 1, block.size() == 0 ? 0 : 1);
  for (std::size_t k = 1; k < cubes.size(); ++k) cubes[k] = cubes[k - 1] + counts.first[k];
  return cubes;
}

}  // namespace adasplats
