// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {

/// The height of the ground by square metre: what few points of many scans are below.
class GroundHeights {
 public:
  /// Adds scan number `index` of a drive.
  void add(const KittiSequence& drive, std::size_t index, const KittiScan& scan);
  /// World coordinates, m; NaN where nothing was measured within 2 m.
  double at(double x, double y) const;

 private:
  /// The points of a cell by decimetre of height.
  struct Cell {
    std::map<std::int32_t, std::uint32_t> heights;
    std::uint32_t points = 0;
  };
  static double ground_of(const Cell& cell);
  std::map<std::pair<std::int32_t, std::int32_t>, Cell> cells_;
};

}  // namespace adasplats
