// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// Finds the pose nearest in the xy-plane: a k-d tree with tight boxes, since a trajectory is
/// a curve and most of the plane is empty.
class NearestPose {
 public:
  /// `trajectory` has at least one pose.
  explicit NearestPose(const Trajectory& trajectory);

  /// Index of the pose nearest to (x, y); of equally near ones the first.
  std::size_t find(double x, double y) const;

 private:
  struct Position {
    double x, y;
    std::size_t index;
  };
  struct Node {
    double low_x, low_y, high_x, high_y;
    std::size_t begin, end;  ///< of positions_; leaves have at most kLeafSize
  };
  struct Best {
    double squared_distance = std::numeric_limits<double>::infinity();
    std::size_t index = std::numeric_limits<std::size_t>::max();
  };
  static constexpr std::size_t kLeafSize = 8;

  void build(std::size_t node, std::size_t begin, std::size_t end);
  Best nearer(std::size_t node, double x, double y, Best best) const;

  std::vector<Position> positions_;
  std::vector<Node> nodes_;  ///< as a heap: the children of k are 2k + 1 and 2k + 2
};

}  // namespace adasplats
