// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Cells of a grid with a corner at the origin, as keys that sort by x, then y, then z; counted
/// from the cell `first`, which is below all points.
struct CellGrid {
  static constexpr int kAxisBits = 21;

  Vec3<std::int64_t> first;
  float cell_m = 1;

  /// `low`: the lower corner of all points.
  static CellGrid from(Vec3f low, float cell_m) {
    CellGrid grid{{}, cell_m};
    for (int axis = 0; axis < 3; ++axis) grid.first[axis] = grid.number(low[axis]);
    return grid;
  }

  ADASPLATS_HD std::int64_t number(float coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / cell_m));
  }
  ADASPLATS_HD std::int64_t cell(Vec3f p, int axis) const { return number(p[axis]) - first[axis]; }
  ADASPLATS_HD std::uint64_t key(Vec3f p) const {
    return key_of_cell(cell(p, 0), cell(p, 1), cell(p, 2));
  }
  ADASPLATS_HD static std::uint64_t key_of_cell(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>((x << kAxisBits | y) << kAxisBits | z);
  }
};

}  // namespace adasplats
