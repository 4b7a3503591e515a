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

/// Number of cells on either side of zero: 21 bits per axis. Points beyond share the outermost
/// cells.
inline constexpr double kMaxFusionCells = 1048575;

/// Index of the grid cell of side `cell_m` that contains a coordinate.
ADASPLATS_HD inline std::uint64_t fusion_axis_key(float value, double cell_m) {
  constexpr double kMax = kMaxFusionCells;
  const double cell = std::floor(static_cast<double>(value) / cell_m);
  return static_cast<std::uint64_t>(std::clamp(cell, -kMax, kMax) + kMax);
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

/// A view of FusedPoints in host or device memory.
struct CellsView {
  const Vec3f* positions = nullptr;
  const std::uint32_t* begins = nullptr;
  const std::uint32_t* members = nullptr;
  std::uint32_t size = 0;

  ADASPLATS_HD std::span<const std::uint32_t> points_of(std::size_t cell) const {
    return {members + begins[cell], begins[cell + 1] - begins[cell]};
  }
};

/// Points of many scans fused in the cells of a grid: noise layers become one, and surfaces near
/// the sensor get no more weight. Cells are in Hilbert order of their means.
struct FusedPoints {
  std::vector<Vec3f> positions;  ///< mean of a cell's points
  std::vector<std::uint32_t>
      begins;  ///< begins of the cells' points in `members`; one more than cells
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

/// Fuses points in cells of side `cell_m`, along a curve over `box`, which contains them. The order
/// of the points affects only the rounding of the means. Coordinates must be within 2^20 cells of
/// zero (a float has no higher resolution there); farther points share the outermost cells.
FusedPoints fuse_points(std::span<const Vec3f> points, double cell_m, const CurveBox& box,
                        const Executor& executor);
/// The same over the bounding box of the points.
FusedPoints fuse_points(std::span<const Vec3f> points, double cell_m, const Executor& executor);

/// Splits flagged cells, for surfaces smaller than a cell: their points are fused again in smaller
/// cells of side `cell_m`. `split`: one flag per cell.
FusedPoints split_cells(std::span<const Vec3f> points, const FusedPoints& fused,
                        std::span<const std::uint8_t> split, double cell_m, const CurveBox& box,
                        const Executor& executor);
FusedPoints split_cells(std::span<const Vec3f> points, const FusedPoints& fused,
                        std::span<const std::uint8_t> split, double cell_m,
                        const Executor& executor);

}  // namespace adasplats
