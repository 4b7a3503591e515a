// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Divides items into at most `count` groups of neighbours: splits the largest group at the middle
/// of its longer side until there are enough. `center` returns the center of an item, up to a
/// common factor, and `number` a unique number, which decides between equal centers. Reorders the
/// items.
template <class T, class Center, class Number>
std::vector<std::span<T>> spatial_groups(std::span<T> items, std::size_t count,
                                         const Center& center, const Number& number) {
  std::vector<std::span<T>> groups = {items};
  while (groups.size() < count) {
    const auto largest = std::ranges::max_element(groups, {}, &std::span<T>::size);
    const std::span<T> group = *largest;
    if (group.size() < 2) break;
    Vec3f low = center(group[0]), high = low;
    for (const T& item : group) {
      low = min(low, center(item));
      high = max(high, center(item));
    }
    const Vec3f size = high - low;
    const int axis = size.x >= size.y ? 0 : 1;
    const std::size_t half = group.size() / 2;
    std::ranges::nth_element(
        group, group.begin() + static_cast<std::ptrdiff_t>(half), {},
        [&](const T& item) { return std::pair(center(item)[axis], number(item)); });
    *largest = group.first(half);
    groups.push_back(group.subspan(half));
  }
  return groups;
}

/// A tracer for a city with some of its tiles in memory: one tree per tile, and a small tree over
/// the shown tiles. Hits equal those of a tracer over all splats if the tiles that a ray crosses
/// are shown. Primitive indices count through the entire city, tile after tile.
class TiledTracer : public Tracer {
 public:
  /// Builds the tree of a tile that has none. May run during casts, and for several tiles at once.
  /// Throws std::logic_error if the number of splats differs from that in make_tiled_tracer().
  virtual void build(std::size_t tile, std::span<const Disk> disks, const Executor& executor) = 0;
  /// Frees the memory of a tile that is not shown.
  virtual void drop(std::size_t tile) = 0;
  /// Sets the tiles that rays can hit, which must be built. Must not run during casts.
  virtual void show(std::span<const std::size_t> tiles) = 0;
};

/// Approximate memory of a tile per splat, bytes.
inline constexpr std::size_t kTiledTracerBytesPerSplat = 80;

/// `splats`: number of splats of each tile. Errors: data (more than 2^30 splats), unavailable (no
/// address space).
std::unique_ptr<TiledTracer> make_tiled_tracer(std::span<const std::size_t> splats);

}  // namespace adasplats
