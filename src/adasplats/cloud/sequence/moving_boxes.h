// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

struct KittiScan;

/// One box of an object.
struct TimedBox {
  double time_s = 0;
  Vec3d middle, half_size;  ///< world coordinates, m; half of the sides along its own axes
  double yaw_rad = 0;       ///< of its x axis, about the world's z axis

  /// A world point along the axes of the box, from its middle.
  Vec3d to_box(Vec3d point) const;
  /// Whether a world point is in the box, grown by `margin_m` on all sides; its lower side is
  /// raised by `ground_m`, to leave out the ground.
  bool contains(Vec3d point, double margin_m, double ground_m = 0) const;
};

/// The boxes of one object by time.
struct BoxTrack {
  std::uint64_t id = 0;  ///< as the file has it, or the number of its first appearance, from 1
  std::string label;     ///< empty if the file has none
  std::vector<TimedBox> boxes;
  /// One box at all times. What is lower than 15 cm above its lower side is not of the object.
  bool is_at_rest = false;

  /// The box at a time, interpolated between two; before the first and after the last it is held.
  TimedBox at(double time_s) const;
};

/// What a box file contains, in world coordinates.
struct BoxContent {
  std::vector<BoxTrack> moving;    ///< by ascending id, their boxes by ascending time
  double begin_s = 0, end_s = -1;  ///< times of all boxes, of stationary objects too
  /// Boxes enclose the points of the scan at their time, which the sensor measured a little earlier
  /// or later.
  bool are_of_scans = false;
  std::vector<BoxTrack> at_rest = {};  ///< the other objects, by ascending id
  std::size_t twins = 0;  ///< left out: boxes of an object in the boxes of another, BoxCollector
};

/// Annotated or found boxes of objects that are taken out of scans: of moving ones over time, and,
/// if they are put among BoxContent::moving, of parked ones.
class MovingBoxes {
 public:
  MovingBoxes() = default;
  explicit MovingBoxes(BoxContent content) : content_(std::move(content)) {}

  bool empty() const { return content_.moving.empty(); }
  /// Whether the times of all boxes, moving or not, overlap a time span.
  bool overlaps(double begin_s, double end_s) const {
    return content_.begin_s <= content_.end_s && begin_s <= content_.end_s &&
           end_s >= content_.begin_s;
  }
  /// By ascending id.
  std::span<const BoxTrack> tracks() const { return content_.moving; }
  bool are_of_scans() const { return content_.are_of_scans; }
  const BoxContent& content() const { return content_; }
  /// Boxes `later_s` later than the given ones are at the given times.
  void correct_times(double later_s, bool are_of_scans);
  /// The number, from 1, of the object whose box contains a world point at a time, with a margin of
  /// 0.2 m, at rest 0.1 m; of several the one whose middle is nearest; 0: none. Boxes of moving
  /// objects are held for one step before the first and after the last.
  std::uint16_t object_at(double time_s, Vec3d point) const;
  /// object_at() of all points of a scan (KittiScan::in_boxes) at their times, or at that of the
  /// scan's pose if they have none or `are_of_scans`.
  std::vector<std::uint16_t> objects_in(const TimedPose& pose, const KittiScan& scan) const;

 private:
  BoxContent content_;
};

}  // namespace adasplats
