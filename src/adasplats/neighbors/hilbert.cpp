// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/neighbors/hilbert.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace adasplats {
namespace {

constexpr int kBits = kHilbertBits;

/// Spreads the low 21 bits to every third bit.
constexpr std::uint64_t spread(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

/// Entry of a turn and one bit of x, y and z: next turn << 3 | bits of the key.
constexpr std::size_t kTurns = 24;
using LevelTable = std::array<std::array<std::uint16_t, 8>, kTurns>;

constexpr LevelTable level_table() {
  LevelTable table{};
  std::array<HilbertTurn, kTurns> turns{};
  std::size_t known = 1;
  for (std::size_t from = 0; from < known; ++from) {
    for (std::uint32_t bits = 0; bits < 8; ++bits) {
      HilbertTurn turn = turns[from];
      const std::uint32_t key = turn.step(bits);
      std::size_t to = 0;
      while (to < known && !(turns[to] == turn)) ++to;
      if (to == known) turns[known++] = turn;  // past the end would not compile
      table[from][bits] = static_cast<std::uint16_t>(to << 3 | key);
    }
  }
  return table;
}

/// Three levels at once: next turn << 9 | 9 bits of the key. 24 KB stay in the first cache.
struct StepTable {
  static constexpr int kLevels = 3;
  static constexpr int kStepBits = 3 * kLevels;
  static constexpr std::size_t kEntries = 1U << kStepBits;
  std::array<std::array<std::uint16_t, kEntries>, kTurns> entries{};

  constexpr StepTable() {
    const LevelTable levels = level_table();
    for (std::size_t first = 0; first < kTurns; ++first) {
      for (std::uint32_t bits = 0; bits < kEntries; ++bits) {
        std::uint32_t turn = static_cast<std::uint32_t>(first);
        std::uint32_t key = 0;
        for (int level = kLevels - 1; level >= 0; --level) {
          const std::uint32_t entry = levels[turn][bits >> (3 * level) & 7U];
          turn = entry >> 3;
          key = key << 3 | (entry & 7U);
        }
        entries[first][bits] = static_cast<std::uint16_t>(turn << kStepBits | key);
      }
    }
  }
};
constexpr StepTable kSteps;
static_assert(kBits % StepTable::kLevels == 0);

}  // namespace

CurveBox curve_box_of(std::span<const Vec3f> points, const Executor& executor) {
  return curve_box_of(
      points.size(), [&](std::size_t i) { return points[i]; }, executor);
}

std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  constexpr int kStepBits = StepTable::kStepBits;
  constexpr std::uint64_t kMask = StepTable::kEntries - 1;
  const std::uint64_t interleaved = spread(x) << 2 | spread(y) << 1 | spread(z);
  std::uint64_t key = 0;
  std::uint32_t step = 0;
  for (int shift = 3 * kBits - kStepBits; shift >= 0; shift -= kStepBits) {
    step = kSteps.entries[step >> kStepBits][interleaved >> shift & kMask];
    key = key << kStepBits | (step & kMask);
  }
  return key;
}

std::vector<std::uint32_t> hilbert_order(std::span<const Vec3f> points, const Executor& executor) {
  return hilbert_order(points, curve_box_of(points, executor), executor);
}

std::vector<std::uint32_t> hilbert_order(std::span<const Vec3f> points, const CurveBox& box,
                                         const Executor& executor) {
  const HilbertGrid grid(box.low, box.high);
  std::vector<std::uint64_t> keys(points.size());
  executor.for_chunks(points.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3<std::uint32_t> cell = grid.cell(points[i]);
      keys[i] = hilbert_key(cell.x, cell.y, cell.z);
    }
  });
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);
  // Within a cell coordinates decide. Runs are short, or one long run of equal points (a degenerate
  // cloud), which std::sort sorts in n log n.
  const auto by_coordinates = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3f p = points[a], q = points[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  };
  for (std::size_t begin = 0; begin < keys.size();) {
    std::size_t end = begin + 1;
    while (end < keys.size() && keys[end] == keys[begin]) ++end;
    if (end - begin > 1)
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
                order.begin() + static_cast<std::ptrdiff_t>(end), by_coordinates);
    begin = end;
  }
  return order;
}

}  // namespace adasplats
