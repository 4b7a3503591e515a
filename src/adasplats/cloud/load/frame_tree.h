// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// Where one frame is in another over time.
struct FrameEdge {
  std::string parent, child;
  bool is_static = false;
  Trajectory parent_from_child;  ///< of a static one a single pose
  std::string fault;             ///< why it cannot be used; thrown when it is
};

/// The frames of a recording, as ROS's transforms (tf2) name them: each has one parent at most.
class FrameTree {
 public:
  /// Errors: data where a frame has another parent already.
  void add(FrameEdge edge);

  bool empty() const { return edges_.empty(); }
  bool has(const std::string& frame) const;
  /// "'map', 'base_link'", for messages.
  std::string frame_names() const;

  /// The frame that has no parent above `frame`.
  std::string root_of(const std::string& frame) const;
  /// Whether a transform between `frame` and its root changes over time.
  bool moves(const std::string& frame) const;

  /// Poses of `frame` in its root, at all times that a transform between them has and all cover:
  /// nothing is extrapolated, and a gap of one (Track) is a gap. Errors: data (no such times, a
  /// rotation that is none).
  Trajectory poses_of(const std::string& frame) const;

  /// Where `to` is in `from`, which are the same, or joined by transforms that do not change.
  /// Errors: data that names the frames.
  RigidTransform fixed_between(const std::string& from, const std::string& to) const;

 private:
  /// From `frame` to its root. Errors: data where frames are in a ring.
  std::vector<const FrameEdge*> way_up(const std::string& frame) const;

  std::map<std::string, FrameEdge> edges_;  ///< by the child
};

}  // namespace adasplats
