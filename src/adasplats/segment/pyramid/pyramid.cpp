// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/pyramid/pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "adasplats/segment/pyramid/cell_grid.h"

namespace adasplats {
namespace {

constexpr std::size_t kQueryGrain = 1024;

struct Bounds {
  Vec3f low, high;
};

Bounds bounds_of(std::span<const Vec3f> points) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Bounds bounds{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const Vec3f p : points) {
    bounds.low = min(bounds.low, p);
    bounds.high = max(bounds.high, p);
  }
  return bounds;
}

std::vector<std::uint64_t> keys_of(std::span<const Vec3f> points, const CellGrid& grid,
                                   const Executor& executor) {
  std::vector<std::uint64_t> keys(points.size());
  executor.for_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) keys[i] = grid.key(points[i]);
  });
  return keys;
}

/// Points sorted into cells as wide as the radius: all neighbours are in nine runs.
class CellSearch {
 public:
  CellSearch(std::span<const Vec3f> supports, Vec3f low, float radius_m, const Executor& executor)
      : supports_(supports), grid_(CellGrid::from(low, radius_m)), radius_m_(radius_m) {
    keys_ = keys_of(supports, grid_, executor);
    executor.sort_keys(keys_, order_);
  }

  struct Candidate {
    float squared_m;
    std::uint32_t index;
    bool operator<(const Candidate& other) const {
      return squared_m != other.squared_m ? squared_m < other.squared_m : index < other.index;
    }
  };

  /// Collects all points within the radius, unordered.
  void collect(Vec3f query, std::vector<Candidate>& found) const {
    found.clear();
    const std::int64_t x = grid_.cell(query, 0), y = grid_.cell(query, 1), z = grid_.cell(query, 2);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        if (x + dx < 0 || y + dy < 0) continue;
        const std::uint64_t first =
            CellGrid::key_of_cell(x + dx, y + dy, std::max<std::int64_t>(0, z - 1));
        const std::uint64_t last = CellGrid::key_of_cell(x + dx, y + dy, z + 1);
        auto at = std::lower_bound(keys_.begin(), keys_.end(), first);
        for (; at != keys_.end() && *at <= last; ++at) add(at - keys_.begin(), query, found);
      }
    }
  }

 private:
  void add(std::ptrdiff_t position, Vec3f query, std::vector<Candidate>& found) const {
    const std::uint32_t index = order_[static_cast<std::size_t>(position)];
    const Vec3f way = supports_[index] - query;
    const float squared_m = dot(way, way);
    if (squared_m < radius_m_ * radius_m_) found.push_back({squared_m, index});
  }

  std::span<const Vec3f> supports_;
  CellGrid grid_;
  float radius_m_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

CellMeans means_by_cell(std::span<const Vec3f> points, float cell_m, const Executor& executor) {
  CellMeans result;
  if (points.empty()) return result;
  const CellGrid grid = CellGrid::from(bounds_of(points).low, cell_m);
  std::vector<std::uint64_t> keys = keys_of(points, grid, executor);
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);
  result.cell_of.resize(points.size());
  for (std::size_t begin = 0; begin < keys.size();) {
    std::size_t end = begin;
    // Relative to one of the points: sums of large coordinates lose precision.
    const Vec3f first = points[order[begin]];
    Vec3f sum;
    for (; end < keys.size() && keys[end] == keys[begin]; ++end) {
      sum = sum + (points[order[end]] - first);
      result.cell_of[order[end]] = static_cast<std::uint32_t>(result.means.size());
    }
    result.means.push_back(first + sum / static_cast<float>(end - begin));
    begin = end;
  }
  return result;
}

NeighborTable find_neighbors(std::span<const Vec3f> queries, std::span<const Vec3f> supports,
                             float radius_m, std::uint32_t slots, const Executor& executor) {
  NeighborTable table{slots, {}};
  table.indices.assign(queries.size() * slots, NeighborTable::kNone);
  if (queries.empty() || supports.empty()) return table;
  const Vec3f low = min(bounds_of(queries).low, bounds_of(supports).low);
  const CellSearch search(supports, low, radius_m, executor);
  executor.for_chunks(queries.size(), kQueryGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<CellSearch::Candidate> found;
    for (std::size_t i = begin; i < end; ++i) {
      search.collect(queries[i], found);
      const std::size_t kept = std::min<std::size_t>(slots, found.size());
      std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept),
                        found.end());
      for (std::size_t k = 0; k < kept; ++k) table.indices[i * slots + k] = found[k].index;
    }
  });
  return table;
}

std::vector<PyramidLevel> make_pyramid(std::vector<Vec3f> points, const PyramidShape& shape,
                                       const Executor& executor) {
  std::vector<PyramidLevel> levels;
  float cell_m = shape.cell_m;
  for (int k = 0; k < shape.levels; ++k, cell_m *= 2) {
    PyramidLevel& level = levels.emplace_back();
    level.cell_m = cell_m;
    level.points = std::move(points);
    const float radius_m = shape.radius * cell_m;
    level.neighbors =
        find_neighbors(level.points, level.points, radius_m, shape.neighbors, executor);
    if (k + 1 == shape.levels) break;
    points = means_by_cell(level.points, 2 * cell_m, executor).means;
    level.pooled = find_neighbors(points, level.points, radius_m, shape.neighbors, executor);
    // The mean of a point's own cell is within the cell's diagonal, 3.5 * cell_m.
    level.coarser = find_neighbors(level.points, points, 4 * cell_m, 1, executor).indices;
  }
  return levels;
}

}  // namespace adasplats
