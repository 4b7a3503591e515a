// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/moving_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {
namespace {

constexpr double kMargin_m = 0.2, kMarginAtRest_m = 0.1, kGround_m = 0.15;

/// Whether an object has a box at some time between two.
bool is_there(const BoxTrack& track, double begin_s, double end_s) {
  const std::vector<TimedBox>& boxes = track.boxes;
  const double step_s = boxes.size() > 1 ? boxes[1].time_s - boxes[0].time_s : 0.1;
  return track.is_at_rest ||
         (end_s >= boxes.front().time_s - step_s && begin_s <= boxes.back().time_s + step_s);
}

bool is_near(const TimedBox& box, Vec3d point) {
  const Vec3d off = point - box.middle;
  const double reach_m = box.half_size.x + box.half_size.y + box.half_size.z + kMargin_m;
  return std::fabs(off.x) <= reach_m && std::fabs(off.y) <= reach_m;
}

double turned_by(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2 * std::numbers::pi);
}

}  // namespace

Vec3d TimedBox::to_box(Vec3d point) const {
  const Vec3d off = point - middle;
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  return {c * off.x + s * off.y, -s * off.x + c * off.y, off.z};
}

bool TimedBox::contains(Vec3d point, double margin_m, double ground_m) const {
  const Vec3d in_box = to_box(point);
  return std::fabs(in_box.x) <= half_size.x + margin_m &&
         std::fabs(in_box.y) <= half_size.y + margin_m && in_box.z <= half_size.z + margin_m &&
         in_box.z >= ground_m - half_size.z - margin_m;
}

TimedBox BoxTrack::at(double time_s) const {
  const auto after = std::ranges::upper_bound(boxes, time_s, {}, &TimedBox::time_s);
  const TimedBox& b = after == boxes.end() ? boxes.back() : *after;
  const TimedBox& a = after == boxes.begin() ? b : *(after - 1);
  const double share =
      b.time_s > a.time_s ? std::clamp((time_s - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0) : 0;
  return {time_s, a.middle + share * (b.middle - a.middle), a.half_size,
          a.yaw_rad + share * turned_by(a.yaw_rad, b.yaw_rad)};
}

std::uint16_t MovingBoxes::object_at(double time_s, Vec3d point) const {
  std::uint16_t object = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < content_.moving.size(); ++k) {
    const BoxTrack& track = content_.moving[k];
    if (!is_there(track, time_s, time_s)) continue;
    if (track.is_at_rest && !is_near(track.boxes.front(), point)) continue;
    const TimedBox box = track.at(time_s);
    const bool contains = track.is_at_rest
                              ? box.contains(point, kMarginAtRest_m, kMarginAtRest_m + kGround_m)
                              : box.contains(point, kMargin_m);
    if (!contains) continue;
    const double away_m = length(point - box.middle);
    if (away_m < least_m) {
      least_m = away_m;
      object = static_cast<std::uint16_t>(k + 1);
    }
  }
  return object;
}

void MovingBoxes::correct_times(double later_s, bool are_of_scans) {
  content_.are_of_scans = are_of_scans;
  content_.begin_s -= later_s;
  content_.end_s -= later_s;
  for (BoxTrack& track : content_.moving)
    for (TimedBox& box : track.boxes) box.time_s -= later_s;
}

std::vector<std::uint16_t> MovingBoxes::objects_in(const TimedPose& pose,
                                                   const KittiScan& scan) const {
  const bool has_times = !scan.times_s.empty() && !content_.are_of_scans;
  double begin_s = pose.time_s, end_s = pose.time_s;
  for (std::size_t i = 0; has_times && i < scan.times_s.size(); ++i) {
    begin_s = std::min(begin_s, time_of_point(scan, pose, i));
    end_s = std::max(end_s, time_of_point(scan, pose, i));
  }
  // Most points are far from all boxes.
  std::vector<std::pair<Vec3d, double>> spheres;
  for (const BoxTrack& track : content_.moving) {
    if (!is_there(track, begin_s, end_s)) continue;
    const TimedBox first = track.at(begin_s), last = track.at(end_s);
    const double half_way_m = 0.5 * length(last.middle - first.middle);
    constexpr double kCurve_m = 0.5;  // boxes may leave the straight line
    spheres.emplace_back(0.5 * (first.middle + last.middle),
                         half_way_m + length(first.half_size) + 2 * kMargin_m + kCurve_m);
  }
  std::vector<std::uint16_t> objects(scan.positions.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Vec3d point = pose.world_from_sensor * vec_cast<double>(scan.positions[i]);
    const bool is_near = std::ranges::any_of(spheres, [&](const auto& sphere) {
      const Vec3d off = point - sphere.first;
      return dot(off, off) < sphere.second * sphere.second;
    });
    if (is_near)
      objects[i] = object_at(has_times ? time_of_point(scan, pose, i) : pose.time_s, point);
  }
  return objects;
}

}  // namespace adasplats
