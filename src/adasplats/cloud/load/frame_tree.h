// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// The pose of one frame in another over time.
struct FrameEdge {
  std::string parent, child;
  bool is_static = false;
  Trajectory parent_from_child;              ///< of a static one a single pose
  std::vector<std::int64_t> stamps_ns = {};  ///< of the poses while they are read
  std::string fault;                         ///< why it cannot be used; thrown on use
  std::vector<std::int64_t> logged_ns = {};  ///< when the poses were recorded, while they are read
  bool is_timed_by_log = false;              ///< the headers have no times
  std::size_t repeated = 0;                  ///< other poses of the same times, left out
};

/// The frames of a recording, named as in ROS transforms (tf2): each has at most one parent.
class FrameTree {
 public:
  /// Errors: data if the frame already has another parent.
  void add(FrameEdge edge);

  bool empty() const { return edges_.empty(); }
  bool has(const std::string& frame) const;
  /// "'map', 'base_link'", for messages.
  std::string frame_names() const;

  /// The topmost ancestor of `frame`.
  std::string root_of(const std::string& frame) const;
  /// Whether a transform between `frame` and its root changes over time.
  bool moves(const std::string& frame) const;

  /// Poses of `frame` in its root, at all times of any transform between them that all of them
  /// cover, without extrapolation and outside gaps (Track). Errors: data (no such times, an invalid
  /// rotation).
  Trajectory poses_of(const std::string& frame) const;

  /// The pose of `to` in `from`, which are the same or connected by static transforms. Errors: data
  /// with the frames.
  RigidTransform fixed_between(const std::string& from, const std::string& to) const;

 private:
  /// From `frame` to its root. Errors: data if the frames form a cycle.
  std::vector<const FrameEdge*> way_up(const std::string& frame) const;

  std::map<std::string, FrameEdge> edges_;  ///< by the child
};

}  // namespace adasplats
