// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

inline constexpr int kHilbertBits = 21;  ///< of a cell's number along one axis

/// Skilling's algorithm level by level, from the top bit down. The effect of the levels above on
/// the axes of a level is a permutation with inversions. His last step inverts all three bits of
/// the key at once; since the Gray code passes an inversion of the first axis on to all three, that
/// is one more inversion of the first axis.
struct HilbertTurn {
  std::array<std::uint8_t, 3> axis = {0, 1, 2};  ///< the coordinate on the i-th axis
  std::array<bool, 3> inverted{};

  constexpr bool operator==(const HilbertTurn&) const = default;

  /// Converts one bit of x, y and z (x is the highest of the three) to three bits of the key.
  ADASPLATS_HD constexpr std::uint32_t step(std::uint32_t bits) {
    std::array<bool, 3> set{};
    for (std::size_t i = 0; i < 3; ++i) set[i] = ((bits >> (2 - axis[i]) & 1U) != 0) != inverted[i];
    // Inverse undo of excess work: changes the levels below.
    for (std::size_t i = 0; i < 3; ++i) {
      if (set[i]) {
        inverted[0] = !inverted[0];
      } else {
        std::swap(axis[0], axis[i]);
        std::swap(inverted[0], inverted[i]);
      }
    }
    // Gray encode.
    set[1] = set[1] != set[0];
    set[2] = set[2] != set[1];
    inverted[0] = inverted[0] != set[2];
    return set[0] * 4U + set[1] * 2U + set[2] * 1U;
  }
};

/// hilbert_key() without its table, for GPUs.
ADASPLATS_HD constexpr std::uint64_t hilbert_key_by_turns(std::uint32_t x, std::uint32_t y,
                                                          std::uint32_t z) {
  HilbertTurn turn;
  std::uint64_t key = 0;
  for (int bit = kHilbertBits - 1; bit >= 0; --bit)
    key = key << 3 | turn.step((x >> bit & 1U) << 2 | (y >> bit & 1U) << 1 | (z >> bit & 1U));
  return key;
}

/// The box that a curve runs over. Parts of a cloud whose curve runs over the box of the full cloud
/// are in the same order as there. Beyond its cube the curve repeats cube by cube, so a box can be
/// kept when points are added outside.
struct CurveBox {
  Vec3f low, high;

  /// Holds nothing: low is above high.
  static CurveBox empty() {
    constexpr float kFar = std::numeric_limits<float>::max();
    return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  }
  void add(Vec3f point) {
    low = min(low, point);
    high = max(high, point);
  }
  CurveBox& operator+=(const CurveBox& other) {
    low = min(low, other.low);
    high = max(high, other.high);
    return *this;
  }
};

/// The box of position_of(0 .. count - 1); CurveBox::empty() without any.
template <class PositionOf>
CurveBox curve_box_of(std::size_t count, const PositionOf& position_of, const Executor& executor) {
  return executor.sum_chunks(count, kCoarseGrain, CurveBox::empty(),
                             [&](std::size_t begin, std::size_t end) {
                               CurveBox box = CurveBox::empty();
                               for (std::size_t i = begin; i < end; ++i) box.add(position_of(i));
                               return box;
                             });
}
CurveBox curve_box_of(std::span<const Vec3f> points, const Executor& executor);

/// The cells of the curve over a bounding box: those of the cube over its longest side.
struct HilbertGrid {
  static constexpr float kCells = static_cast<float>(1U << kHilbertBits) - 1.0F;
  Vec3f low;
  float cells_per_m = 0;

  ADASPLATS_HD HilbertGrid(Vec3f box_low, Vec3f box_high) : low(box_low) {
    const Vec3f size = box_high - box_low;
    const float xy = size.x < size.y ? size.y : size.x;
    const float side = xy < size.z ? size.z : xy;
    cells_per_m = side > 0.0F ? kCells / side : 0.0F;
  }
  ADASPLATS_HD Vec3<std::uint32_t> cell(Vec3f p) const {
    return {along(p.x, low.x), along(p.y, low.y), along(p.z, low.z)};
  }

 private:
  ADASPLATS_HD std::uint32_t along(float v, float from) const {
    float at = (v - from) * cells_per_m;
    if (at < 0.0F || at > kCells) {
      constexpr float kPeriod = kCells + 1.0F;
      at -= std::floor(at / kPeriod) * kPeriod;
    }
    return static_cast<std::uint32_t>(kCells < at ? kCells : at);
  }
};

/// Position of a cell on the Hilbert curve of 2^21 cells a side (63 bits). Skilling 2004,
/// "Programming the Hilbert curve": transpose form, then the bits of the axes interleaved.
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z);

/// The order of points along a Hilbert curve over their bounding cube: `order[i]` is the index of
/// the i-th point. Points in the same cell of the curve (2^-21 of the cube's side) are ordered by
/// x, y, z and then by index. Consecutive points are close, and runs of them fill compact boxes,
/// unlike in Morton order.
std::vector<std::uint32_t> hilbert_order(std::span<const Vec3f> points, const Executor& executor);
/// The same for a curve over another box, which need not contain the points.
std::vector<std::uint32_t> hilbert_order(std::span<const Vec3f> points, const CurveBox& box,
                                         const Executor& executor);

}  // namespace adasplats
