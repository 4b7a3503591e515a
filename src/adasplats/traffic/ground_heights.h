// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {

/// The height of the ground by square metre, from the lowest points of many scans.
class GroundHeights {
 public:
  /// Adds scan number `index` of a drive.
  void add(const KittiSequence& drive, std::size_t index, const KittiScan& scan);
  /// World coordinates, m; NaN where nothing was measured within 2 m.
  double at(double x, double y) const;

 private:
  /// The lowest points of a cell, ascending: single points may be below the ground.
  static constexpr std::size_t kLowest = 5;
  struct Cell {
    std::array<float, kLowest> lowest;
    std::size_t points = 0;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, Cell> cells_;
};

}  // namespace adasplats
