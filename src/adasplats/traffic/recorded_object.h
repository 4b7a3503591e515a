// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// A beam that passed through the box of an object, in the object's frame.
struct PassingBeam {
  Vec3d origin;     ///< m
  Vec3d direction;  ///< unit
};

/// The points of an object in one scan, in the object's frame.
struct ObjectScan {
  std::size_t scan = 0;  ///< its number in the drive
  double time_s = 0;     ///< mean of its points
  /// The pose of the object at that time; of boxes of scans that at the time of the scan.
  RigidTransform world_from_object;
  std::vector<Vec3d> points;         ///< m
  std::vector<Vec3d> origins;        ///< where their beams began, m
  std::vector<float> intensities;    ///< as measured; empty: unknown
  std::vector<PassingBeam> passing;  ///< that show where the object is not
};

/// An object that moved through a recording. Its frame: origin in the middle of its box, x ahead, y
/// left, z up.
struct RecordedObject {
  std::uint64_t id = 0;
  std::string label;  ///< of the boxes; may be empty
  Vec3d size_m;       ///< length, width, height
  Trajectory world_from_object;
  std::vector<ObjectScan> scans;

  std::size_t points() const;
};

/// The object of a box track, without points. Its x axis is the axis of the boxes along which it
/// moves; if it moves less than 1 m, the longer one.
RecordedObject object_of(const BoxTrack& track);

/// Collects the points of objects (KittiScan::in_boxes) scan by scan, and the beams that passed
/// through their boxes. A point is placed by the pose of its object at its time; without times, at
/// the time of the scan. Points lower than 5 cm above the bottom of the box are ground and are
/// skipped.
class ObjectCollector {
 public:
  explicit ObjectCollector(const MovingBoxes& boxes);
  /// What one scan shows of an object, which has a number from 0.
  struct Part {
    std::size_t number;
    ObjectScan scan;
  };
  /// What scan number `index` of a drive shows, by ascending number; `scan` has KittiScan::in_boxes
  /// of these boxes. For any thread.
  std::vector<Part> parts_of(const KittiSequence& drive, std::size_t index,
                             const KittiScan& scan) const;
  /// Adds what one scan shows, scan by scan.
  void add(std::vector<Part> parts);
  /// One object per track, in their order; some have no points.
  std::vector<RecordedObject> take() { return std::move(objects_); }

 private:
  void add_passing(const TimedPose& pose, const KittiScan& scan,
                   std::span<const MeasuredBeam> beams, Part& part) const;

  std::vector<RecordedObject> objects_;
  bool are_of_scans_;
};

}  // namespace adasplats
