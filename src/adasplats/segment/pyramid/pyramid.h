// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Neighbours of some points, as many slots for each: indices of others, the nearest first.
struct NeighborTable {
  static constexpr std::uint32_t kNone = 0xffffffffU;  ///< in slots that are left over
  std::uint32_t slots = 0;
  std::vector<std::uint32_t> indices;

  std::size_t size() const { return slots == 0 ? 0 : indices.size() / slots; }
  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(indices).subspan(point * slots, slots);
  }
};

/// One grid of a cloud: a point a cell, the mean of what lies in it.
struct PyramidLevel {
  float cell_m = 0;
  std::vector<Vec3f> points;
  NeighborTable neighbors;             ///< of its points among themselves, each with itself
  NeighborTable pooled;                ///< for the points of the next level, of this one's
  std::vector<std::uint32_t> coarser;  ///< of its points, the nearest of the next level
};

struct PyramidShape {
  float cell_m = 0.1F;  ///< of the finest level; doubled from level to level
  int levels = 5;
  float radius = 2.5F;  ///< of neighbourhoods, in cells of their level
  std::uint32_t neighbors = 32;
};

/// The means of the points in every cell, in the order of the cells (by x, then y, then z), and for
/// every point which one it went into. The grid has a corner in the origin of the coordinates.
struct CellMeans {
  std::vector<Vec3f> means;
  std::vector<std::uint32_t> cell_of;
};
CellMeans means_by_cell(std::span<const Vec3f> points, float cell_m, const Executor& executor);

/// The `slots` supports nearest to each query within the radius, those of lower index first where
/// distances are the same.
NeighborTable find_neighbors(std::span<const Vec3f> queries, std::span<const Vec3f> supports,
                             float radius_m, std::uint32_t slots, const Executor& executor);

/// Grids from fine to coarse (KPConv: Thomas et al. 2019, sections 3.1 and 3.3). `points`: means of
/// cells of the shape's finest size; finite, within a few kilometres of the origin.
std::vector<PyramidLevel> make_pyramid(std::vector<Vec3f> points, const PyramidShape& shape,
                                       const Executor& executor);

/// Height of points above the lowest ones around, m: the least of square columns of 1 m, eroded and
/// smoothed over nine of them each way.
std::vector<float> heights_above_ground(std::span<const Vec3f> points);

}  // namespace adasplats
