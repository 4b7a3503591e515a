// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Neighbours of points, with the same number of slots for each: indices, nearest first.
struct NeighborTable {
  static constexpr std::uint32_t kNone = 0xffffffffU;  ///< in unused slots
  std::uint32_t slots = 0;
  std::vector<std::uint32_t> indices;

  std::size_t size() const { return slots == 0 ? 0 : indices.size() / slots; }
  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(indices).subspan(point * slots, slots);
  }
};

/// One grid of a cloud, with one point per cell: the mean of the points in it.
struct PyramidLevel {
  float cell_m = 0;
  std::vector<Vec3f> points;
  NeighborTable neighbors;             ///< of its points among themselves, including the point
  NeighborTable pooled;                ///< neighbours in this level of the points of the next
  std::vector<std::uint32_t> coarser;  ///< for each point, the nearest one of the next level
};

struct PyramidShape {
  float cell_m = 0.1F;  ///< of the finest level; doubled from level to level
  int levels = 5;
  float radius = 2.5F;  ///< of neighbourhoods, in cells of their level
  std::uint32_t neighbors = 32;
};

/// The means of the points in every cell, sorted by cell (x, then y, then z), and the cell of every
/// point. The origin of the coordinates is a corner of the grid.
struct CellMeans {
  std::vector<Vec3f> means;
  std::vector<std::uint32_t> cell_of;
};
CellMeans means_by_cell(std::span<const Vec3f> points, float cell_m, const Executor& executor);

/// Finds the `slots` nearest supports within the radius of each query; ties by index.
NeighborTable find_neighbors(std::span<const Vec3f> queries, std::span<const Vec3f> supports,
                             float radius_m, std::uint32_t slots, const Executor& executor);

/// Grids from fine to coarse (KPConv: Thomas et al. 2019, sections 3.1 and 3.3). `points`: means of
/// cells of the shape's finest size; finite, within a few kilometres of the origin.
std::vector<PyramidLevel> make_pyramid(std::vector<Vec3f> points, const PyramidShape& shape,
                                       const Executor& executor);

/// Height of points above the ground, m. The ground is the lowest point of square columns of 1 m,
/// eroded and smoothed over nine columns each way.
std::vector<float> heights_above_ground(std::span<const Vec3f> points);

}  // namespace adasplats
