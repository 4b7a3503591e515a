// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/nearest_pose.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace adasplats {

namespace {

double squared(double v) { return v * v; }

double outside(double value, double low, double high) {
  return std::max({low - value, value - high, 0.0});
}

}  // namespace

NearestPose::NearestPose(const Trajectory& trajectory) {
  if (trajectory.empty()) throw std::logic_error("NearestPose: no poses");
  for (const TimedPose& pose : trajectory) {
    const Vec3d p = pose.world_from_sensor.translation;
    positions_.push_back({p.x, p.y, positions_.size()});
  }
  build(0, 0, positions_.size());
}

void NearestPose::build(std::size_t node, std::size_t begin, std::size_t end) {
  if (nodes_.size() <= node) nodes_.resize(node + 1);
  Node box{positions_[begin].x,
           positions_[begin].y,
           positions_[begin].x,
           positions_[begin].y,
           begin,
           end};
  for (std::size_t i = begin; i < end; ++i) {
    box.low_x = std::min(box.low_x, positions_[i].x);
    box.low_y = std::min(box.low_y, positions_[i].y);
    box.high_x = std::max(box.high_x, positions_[i].x);
    box.high_y = std::max(box.high_y, positions_[i].y);
  }
  nodes_[node] = box;
  if (end - begin <= kLeafSize) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) {
    return positions_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  const bool along_x = box.high_x - box.low_x >= box.high_y - box.low_y;
  std::nth_element(at(begin), at(middle), at(end), [along_x](const Position& a, const Position& b) {
    return along_x ? a.x < b.x : a.y < b.y;
  });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

NearestPose::Best NearestPose::nearer(std::size_t node, double x, double y, Best best) const {
  const auto box_distance = [&](std::size_t k) {
    const Node& box = nodes_[k];
    return squared(outside(x, box.low_x, box.high_x)) + squared(outside(y, box.low_y, box.high_y));
  };
  const Node& here = nodes_[node];
  if (here.end - here.begin <= kLeafSize) {
    for (std::size_t i = here.begin; i < here.end; ++i) {
      const Position& p = positions_[i];
      const double distance = squared(x - p.x) + squared(y - p.y);
      if (distance < best.squared_distance ||
          (distance == best.squared_distance && p.index < best.index))
        best = {distance, p.index};
    }
    return best;
  }
  std::size_t first = 2 * node + 1, second = 2 * node + 2;
  double first_distance = box_distance(first), second_distance = box_distance(second);
  if (second_distance < first_distance) {
    std::swap(first, second);
    std::swap(first_distance, second_distance);
  }
  // Not >=: a box just as far may hold an earlier pose just as near.
  if (!(first_distance > best.squared_distance)) best = nearer(first, x, y, best);
  if (!(second_distance > best.squared_distance)) best = nearer(second, x, y, best);
  return best;
}

std::size_t NearestPose::find(double x, double y) const { return nearer(0, x, y, {}).index; }

}  // namespace adasplats
