// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Where objects that move were, as somebody annotated them.
class MovingBoxes {
 public:
  MovingBoxes() = default;
  /// Reads a CSV with the columns time, id, stationary (0: it moves), x, y, z (of the middle, world
  /// coordinates, m), size_x, size_y, size_z (m), yaw (rad); others are skipped, and so are boxes
  /// that stand still. Errors: data with the line.
  explicit MovingBoxes(const std::filesystem::path& path);

  bool empty() const { return tracks_.empty(); }
  /// Whether any box, moving or not, has a time between these.
  bool cover(double begin_s, double end_s) const {
    return begin_s_ <= end_s_ && begin_s <= end_s_ && end_s >= begin_s_;
  }
  /// Whether one holds a world point at a time, with a margin of 0.2 m. Between two times an object
  /// moves evenly; before its first and after its last one it stays for as long as they are apart.
  bool hold(double time_s, Vec3d point) const;

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
