// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/neighbors/hilbert.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace adasplats {
namespace {

constexpr int kBits = 21;
constexpr std::size_t kGrain = 1 << 16;

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

struct Extent {
  Vec3f low{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
            std::numeric_limits<float>::max()};
  Vec3f high{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(),
             std::numeric_limits<float>::lowest()};
  Extent& operator+=(const Extent& other) {
    low = min(low, other.low);
    high = max(high, other.high);
    return *this;
  }
};

Extent extent_of(std::span<const Vec3f> points, const Executor& executor) {
  return executor.sum_chunks(points.size(), kGrain, Extent{},
                             [&](std::size_t begin, std::size_t end) {
                               Extent extent;
                               for (std::size_t i = begin; i < end; ++i) {
                                 extent.low = min(extent.low, points[i]);
                                 extent.high = max(extent.high, points[i]);
                               }
                               return extent;
                             });
}

}  // namespace

std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t axes[3] = {x, y, z};
  // Inverse undo of excess work, from the highest bit down.
  for (std::uint32_t bit = 1U << (kBits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& axis : axes) {
      // Without branches: `set` is all ones where the axis has the bit.
      const std::uint32_t set = (axis & bit) != 0 ? 0xffffffffU : 0U;
      const std::uint32_t swapped = (axes[0] ^ axis) & below;
      axes[0] ^= (set & below) | (~set & swapped);
      axis ^= ~set & swapped;
    }
  }
  // Gray encode.
  axes[1] ^= axes[0];
  axes[2] ^= axes[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = 1U << (kBits - 1); bit > 1; bit >>= 1)
    if ((axes[2] & bit) != 0) flip ^= bit - 1;
  for (std::uint32_t& axis : axes) axis ^= flip;
  return spread(axes[0]) << 2 | spread(axes[1]) << 1 | spread(axes[2]);
}

std::vector<std::uint32_t> hilbert_order(std::span<const Vec3f> points, const Executor& executor) {
  const Extent extent = extent_of(points, executor);
  const Vec3f size = extent.high - extent.low;
  const float side = std::max({size.x, size.y, size.z});
  constexpr float kCells = static_cast<float>(1U << kBits) - 1.0F;
  const float cells_per_m = side > 0.0F ? kCells / side : 0.0F;
  const auto cell = [&](float v, float low) {
    return static_cast<std::uint32_t>(std::min((v - low) * cells_per_m, kCells));
  };
  std::vector<std::uint64_t> keys(points.size());
  executor.for_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f p = points[i];
      keys[i] =
          hilbert_key(cell(p.x, extent.low.x), cell(p.y, extent.low.y), cell(p.z, extent.low.z));
    }
  });
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);
  // Within a cell the curve says nothing: coordinates decide. Runs are short, or one long run of
  // equal points (a degenerate cloud), which std::sort takes in n log n.
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
