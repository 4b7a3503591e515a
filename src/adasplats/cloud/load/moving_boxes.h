// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Annotated boxes of moving objects over time.
class MovingBoxes {
 public:
  MovingBoxes() = default;
  /// Reads a CSV with the columns time, id, stationary (0: it moves), x, y, z (of the centre, world
  /// coordinates, m), size_x, size_y, size_z (m), yaw (rad). Other columns and stationary boxes are
  /// skipped. Errors: data with the line.
  explicit MovingBoxes(const std::filesystem::path& path);

  bool empty() const { return tracks_.empty(); }
  /// Whether the times of all boxes, moving or not, overlap a time span.
  bool overlaps(double begin_s, double end_s) const {
    return begin_s_ <= end_s_ && begin_s <= end_s_ && end_s >= begin_s_;
  }
  /// Whether a box contains a world point at a time, with a margin of 0.2 m. Boxes are interpolated
  /// between two times; before the first and after the last they are held for one step.
  bool contains(double time_s, Vec3d point) const;

 private:
  struct Box {
    double time_s = 0;
    Vec3d middle, half_size;
    double yaw_rad = 0;
  };
  using Track = std::vector<Box>;  ///< of one object, by time
  std::vector<Track> tracks_;
  double begin_s_ = 0, end_s_ = -1;  ///< of all boxes in the file
};

}  // namespace adasplats
