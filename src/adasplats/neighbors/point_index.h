// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/vec3.h"

namespace adasplats {

/// A point near a query. `index` is the index of the point in the order it was given in.
struct Neighbor {
  float squared_distance;
  std::uint32_t index;
};

/// The order of points along a Hilbert curve over their bounding cube: `order[i]` is the index of
/// the i-th point. Points in the same cell of the curve (2^-21 of the cube's side) are ordered by
/// x, y, z and then by index.
std::vector<std::uint32_t> hilbert_order(std::span<const Vec3f> points, const Executor& executor);

/// Points in Hilbert order under an implicit 8-ary tree of bounding boxes. Immutable; searches may
/// run on several threads. Needs 20 bytes a point. Points are finite (the caller's business).
class PointIndex {
 public:
  PointIndex(std::span<const Vec3f> points, const Executor& executor);

  std::size_t size() const { return order_.size(); }

  /// Nearest indexed point of every query: result[i] belongs to queries[i]. Equal distances go to
  /// the point that is first in Hilbert order. An empty index gives infinite distances and index
  /// 0xffffffff.
  std::vector<Neighbor> nearest(std::span<const Vec3f> queries, const Executor& executor) const;

 private:
  std::vector<std::uint32_t> order_;
};

}  // namespace adasplats
