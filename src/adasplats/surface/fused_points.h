// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats {

/// Cells of a grid on either side of zero: 21 bits an axis. Points beyond share the last ones.
inline constexpr double kMaxFusionCells = 1048575;

/// Which cell of a grid of side `cell_m` a coordinate lies in.
ADASPLATS_HD inline std::uint64_t fusion_axis_key(float value, double cell_m) {
  constexpr double kMost = kMaxFusionCells;
  const double cell = std::floor(static_cast<double>(value) / cell_m);
  return static_cast<std::uint64_t>(std::clamp(cell, -kMost, kMost) + kMost);
}

ADASPLATS_HD inline std::uint64_t fusion_key(Vec3f point, double cell_m) {
  return fusion_axis_key(point.x, cell_m) << 42 | fusion_axis_key(point.y, cell_m) << 21 |
         fusion_axis_key(point.z, cell_m);
}

/// Mean of points[i] for i of `members`, added in their order.
ADASPLATS_HD inline Vec3f mean_position(const Vec3f* points,
                                        std::span<const std::uint32_t> members) {
  Vec3d sum;
  for (const std::uint32_t i : members) sum = sum + vec_cast<double>(points[i]);
  return vec_cast<float>(sum / static_cast<double>(members.size()));
}

/// What the steps of one cell read of FusedPoints, wherever these are.
struct CellsView {
  const Vec3f* positions = nullptr;
  const std::uint32_t* begins = nullptr;
  const std::uint32_t* members = nullptr;
  std::uint32_t size = 0;

  ADASPLATS_HD std::span<const std::uint32_t> points_of(std::size_t cell) const {
    return {members + begins[cell], begins[cell + 1] - begins[cell]};
  }
};

/// Points of many scans fused in the cells of a grid: noise layers become one, and no place weighs
/// more because the sensor stood near it. Cells stand in Hilbert order of their means.
struct FusedPoints {
  std::vector<Vec3f> positions;        ///< mean of a cell's points
  std::vector<std::uint32_t> begins;   ///< of a cell's points in `members`; one more than cells
  std::vector<std::uint32_t> members;  ///< point indices, cell by cell, ascending within one

  std::size_t size() const { return positions.size(); }
  CellsView view() const {
    return {positions.data(), begins.data(), members.data(), static_cast<std::uint32_t>(size())};
  }
  std::span<const std::uint32_t> points_of(std::size_t cell) const {
    return view().points_of(cell);
  }
  float count(std::size_t cell) const {
    return static_cast<float>(begins[cell + 1] - begins[cell]);
  }
};

/// Fuses points in cells of side `cell_m`; their curve runs over `box`, which holds them. The
/// result depends on the order of the points only in the rounding of the means. Coordinates must be
/// within 2^20 cells of zero (a float holds no finer ones there anyway); farther points share the
/// outermost cells.
FusedPoints fuse_points(std::span<const Vec3f> points, double cell_m, const CurveBox& box,
                        const Executor& executor);
/// Over the box of the points.
FusedPoints fuse_points(std::span<const Vec3f> points, double cell_m, const Executor& executor);

/// The same with some cells split: their points are fused again in cells of side `cell_m`, finer
/// than before, for surfaces that are no larger than a cell. One flag a cell.
FusedPoints split_cells(std::span<const Vec3f> points, const FusedPoints& fused,
                        std::span<const std::uint8_t> split, double cell_m, const CurveBox& box,
                        const Executor& executor);
FusedPoints split_cells(std::span<const Vec3f> points, const FusedPoints& fused,
                        std::span<const std::uint8_t> split, double cell_m,
                        const Executor& executor);

}  // namespace adasplats
