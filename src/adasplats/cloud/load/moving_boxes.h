// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// One box of an object.
struct TimedBox {
  double time_s = 0;
  Vec3d middle, half_size;  ///< world coordinates, m; half of the sides along its own axes
  double yaw_rad = 0;       ///< of its x axis, about the world's z axis
};

/// The boxes of one object by time.
struct BoxTrack {
  std::uint64_t id = 0;  ///< as the file has it
  std::string label;     ///< empty if the file has none
  std::vector<TimedBox> boxes;

  /// The box at a time, interpolated between two; before the first and after the last it is held.
  TimedBox at(double time_s) const;
};

/// Annotated boxes of moving objects over time.
class MovingBoxes {
 public:
  MovingBoxes() = default;
  /// Reads a CSV with the columns time, id, stationary (0: it moves), x, y, z (of the centre, world
  /// coordinates, m), size_x, size_y, size_z (m), yaw (rad), and optionally label. Other columns
  /// and stationary boxes are skipped. Errors: data with the line (numbers that are not finite,
  /// sides that are not positive, ids that are not whole, two boxes of an object at one time, more
  /// than 65,535 objects).
  explicit MovingBoxes(const std::filesystem::path& path);

  /// Of tracks with at least one box each.
  explicit MovingBoxes(std::vector<BoxTrack> tracks);

  bool empty() const { return tracks_.empty(); }
  /// Whether the times of all boxes, moving or not, overlap a time span.
  bool overlaps(double begin_s, double end_s) const {
    return begin_s_ <= end_s_ && begin_s <= end_s_ && end_s >= begin_s_;
  }
  /// By ascending id.
  std::span<const BoxTrack> tracks() const { return tracks_; }
  /// The number, from 1, of the object whose box contains a world point at a time, with a margin of
  /// 0.2 m; of several the one whose middle is nearest; 0: none. Boxes are held for one step before
  /// the first and after the last.
  std::uint16_t object_at(double time_s, Vec3d point) const;
  /// object_at() of all points of scan number `index` of a drive (KittiScan::in_boxes).
  std::vector<std::uint16_t> objects_in(const KittiSequence& drive, std::size_t index,
                                        const KittiScan& scan, const Executor& executor) const;

 private:
  std::vector<BoxTrack> tracks_;
  double begin_s_ = 0, end_s_ = -1;  ///< of all boxes in the file
};

}  // namespace adasplats
