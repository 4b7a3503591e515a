// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {

/// The points of one scan by square metre and decimetre of height.
class ScanHeights {
 public:
  ScanHeights() = default;
  /// Of scan number `index` of a drive.
  ScanHeights(const KittiSequence& drive, std::size_t index, const KittiScan& scan);

 private:
  friend class GroundHeights;
  struct Step {
    std::uint64_t cell;
    std::int32_t height;  ///< dm
    std::uint32_t points;
  };
  std::vector<Step> steps_;  ///< by cell and height
};

/// The height of the ground by square metre: what few points of many scans are below.
class GroundHeights {
 public:
  void add(const ScanHeights& scan);
  /// World coordinates, m; NaN where nothing was measured within 2 m.
  double at(double x, double y) const;

 private:
  /// The points of a cell by decimetre of height, ascending.
  struct Cell {
    std::vector<std::pair<std::int32_t, std::uint32_t>> heights;
    std::uint32_t points = 0;
  };
  static double ground_of(const Cell& cell);
  std::unordered_map<std::uint64_t, Cell> cells_;
};

}  // namespace adasplats
