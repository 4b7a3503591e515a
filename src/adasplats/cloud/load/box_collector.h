// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// The angle of the x axis of a box about the world's z axis, rad.
inline double yaw_of_box(const Mat3d& world_from_box) {
  return std::atan2(world_from_box.rows[1].x, world_from_box.rows[0].x);
}

/// Whether an object moves, where its file does not state it: two of its boxes are more than 1 m
/// apart, and the way between them is faster than 0.5 m/s.
bool moves_by_boxes(const BoxTrack& track);

/// Collects the boxes of a file.
class BoxCollector {
 public:
  explicit BoxCollector(std::filesystem::path file) : file_(std::move(file)) {}

  /// The number, from 1, of an identifier, in order of first appearance.
  std::uint64_t number_of(const std::string& identifier);

  /// Adds a box. `moves`: as the file states it; nothing: moves_by_boxes() decides. `place` returns
  /// the beginning of messages, such as "boxes.csv:3: ". Errors: data (numbers that are not finite,
  /// sides that are not positive, a second box of the object at a time).
  void add(std::uint64_t id, const std::string& label, const TimedBox& box,
           std::optional<bool> moves, FunctionRef<std::string()> place);
  /// The objects. One object may have boxes from each LiDAR: where two are less than 2 m
  /// apart at all of their common times, and their middles in each other's boxes at half of these
  /// or more, the one with fewer boxes, or else with the larger id, is left out. Of an object at
  /// rest the box in the middle of its times is kept. Errors: data (no boxes, more than 65,535
  /// objects).
  BoxContent take(bool are_of_scans);

 private:
  struct Object {
    std::string label;
    std::optional<bool> moves;
    std::map<double, TimedBox> boxes;  ///< by time
  };

  void add_time(double time_s);
  /// Removes objects in the boxes of others; returns their number.
  std::size_t remove_twins();

  std::filesystem::path file_;
  std::unordered_map<std::string, std::uint64_t> numbers_;
  std::map<std::uint64_t, Object> objects_;
  double begin_s_ = 0, end_s_ = -1;
};

}  // namespace adasplats
