// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/fused_points.h"

#include <algorithm>

namespace adasplats {
namespace {

/// Points sorted by cell.
struct Cells {
  std::vector<std::uint32_t> begins;  ///< one more than cells
  std::vector<std::uint32_t> members;

  std::size_t size() const { return begins.size() - 1; }
  std::span<const std::uint32_t> points_of(std::size_t cell) const {
    return std::span(members).subspan(begins[cell], begins[cell + 1] - begins[cell]);
  }
};

Cells sort_into_cells(std::span<const Vec3f> points, double cell_m, const Executor& executor) {
  std::vector<std::uint64_t> keys(points.size());
  executor.for_chunks(points.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      keys[i] = fusion_key(points[i], cell_m);
    }
  });
  Cells cells;
  executor.sort_keys(keys, cells.members);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i] != keys[i - 1]) cells.begins.push_back(static_cast<std::uint32_t>(i));
  }
  cells.begins.push_back(static_cast<std::uint32_t>(keys.size()));
  return cells;
}

std::vector<Vec3f> means_of(std::span<const Vec3f> points, const Cells& cells,
                            const Executor& executor) {
  std::vector<Vec3f> means(cells.size());
  executor.for_chunks(means.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      means[cell] = mean_position(points.data(), cells.points_of(cell));
    }
  });
  return means;
}

/// Sorts cells along the curve.
template <class PointsOf>
FusedPoints in_curve_order(const std::vector<Vec3f>& means, std::size_t points,
                           const PointsOf& points_of, const CurveBox& box,
                           const Executor& executor) {
  FusedPoints fused;
  fused.positions.reserve(means.size());
  fused.members.reserve(points);
  fused.begins.reserve(means.size() + 1);
  for (const std::uint32_t cell : hilbert_order(means, box, executor)) {
    fused.positions.push_back(means[cell]);
    fused.begins.push_back(static_cast<std::uint32_t>(fused.members.size()));
    const auto members = points_of(cell);
    fused.members.insert(fused.members.end(), members.begin(), members.end());
  }
  fused.begins.push_back(static_cast<std::uint32_t>(fused.members.size()));
  return fused;
}

}  // namespace

FusedPoints fuse_points(std::span<const Vec3f> points, double cell_m, const CurveBox& box,
                        const Executor& executor) {
  const Cells cells = sort_into_cells(points, cell_m, executor);
  const auto points_of = [&](std::size_t cell) { return cells.points_of(cell); };
  return in_curve_order(means_of(points, cells, executor), points.size(), points_of, box, executor);
}

FusedPoints fuse_points(std::span<const Vec3f> points, double cell_m, const Executor& executor) {
  return fuse_points(points, cell_m, curve_box_of(points, executor), executor);
}

FusedPoints split_cells(std::span<const Vec3f> points, const FusedPoints& fused,
                        std::span<const std::uint8_t> split, double cell_m,
                        const Executor& executor) {
  return split_cells(points, fused, split, cell_m, curve_box_of(points, executor), executor);
}

FusedPoints split_cells(std::span<const Vec3f> points, const FusedPoints& fused,
                        std::span<const std::uint8_t> split, double cell_m, const CurveBox& box,
                        const Executor& executor) {
  // The points of split cells, sorted, so that the members of small cells are ascending, too.
  std::vector<std::uint32_t> loose;
  std::vector<std::uint32_t> kept;  // cells that are not split
  for (std::size_t cell = 0; cell < fused.size(); ++cell) {
    const auto members = fused.points_of(cell);
    if (split[cell] != 0) {
      loose.insert(loose.end(), members.begin(), members.end());
    } else {
      kept.push_back(static_cast<std::uint32_t>(cell));
    }
  }
  std::sort(loose.begin(), loose.end());
  std::vector<Vec3f> loose_points;
  loose_points.reserve(loose.size());
  for (const std::uint32_t i : loose) loose_points.push_back(points[i]);
  Cells small = sort_into_cells(loose_points, cell_m, executor);

  std::vector<Vec3f> means = means_of(loose_points, small, executor);
  const std::size_t small_count = means.size();
  for (const std::uint32_t cell : kept) means.push_back(fused.positions[cell]);
  for (std::uint32_t& member : small.members) member = loose[member];
  const auto points_of = [&](std::size_t cell) {
    return cell < small_count ? small.points_of(cell) : fused.points_of(kept[cell - small_count]);
  };
  return in_curve_order(means, points.size(), points_of, box, executor);
}

}  // namespace adasplats
