// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/error.h"

namespace adasplats {

RigidTransform interpolate(const Trajectory& trajectory, double time_s) {
  if (trajectory.empty()) throw std::logic_error("interpolate: no poses");
  const auto after = std::ranges::upper_bound(trajectory, time_s, {}, &TimedPose::time_s);
  if (after == trajectory.begin()) return trajectory.front().world_from_sensor;
  if (after == trajectory.end()) return trajectory.back().world_from_sensor;
  const TimedPose& a = *(after - 1);
  const TimedPose& b = *after;
  const double s = (time_s - a.time_s) / (b.time_s - a.time_s);
  if (s == 0.0) return a.world_from_sensor;
  const Vec3d from = a.world_from_sensor.translation;
  const Vec3d to = b.world_from_sensor.translation;
  return {slerp(quaternion_from_rotation(a.world_from_sensor.rotation),
                quaternion_from_rotation(b.world_from_sensor.rotation), s),
          from + s * (to - from)};
}

Trajectory shifted(Trajectory trajectory, Vec3d offset_m) {
  for (TimedPose& pose : trajectory)
    pose.world_from_sensor.translation = pose.world_from_sensor.translation + offset_m;
  return trajectory;
}

Trajectory mounted(Trajectory trajectory, const RigidTransform& vehicle_from_sensor) {
  for (TimedPose& pose : trajectory)
    pose.world_from_sensor = pose.world_from_sensor * vehicle_from_sensor;
  return trajectory;
}

namespace {

constexpr double kMaxPoses = 10e6;

/// Poses at the times that `time_of(0)`, `time_of(1)`, ... say.
template <class F>
Trajectory poses_at(const Trajectory& trajectory, std::size_t count, const F& time_of) {
  Trajectory poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = time_of(i);
    poses.push_back({time_s, interpolate(trajectory, time_s)});
  }
  return poses;
}

/// Steps of `step` that fit into `length`, and the start.
std::size_t places_along(double length, double step, const char* what) {
  if (!(step > 0)) throw Error(ErrorKind::usage, std::string(what) + " must be above 0");
  const double steps = std::floor(length / step * (1 + 1e-12));
  if (!(steps < kMaxPoses))
    throw Error(ErrorKind::usage, std::string(what) + " gives more than 10 million poses");
  return static_cast<std::size_t>(steps) + 1;
}

}  // namespace

Trajectory resampled_by_time(const Trajectory& trajectory, double rate_hz) {
  if (!(rate_hz > 0)) throw Error(ErrorKind::usage, "the rate of poses must be above 0");
  if (trajectory.empty()) return {};
  const double begin_s = trajectory.front().time_s;
  const std::size_t count =
      places_along(trajectory.back().time_s - begin_s, 1 / rate_hz, "the rate of poses");
  return poses_at(trajectory, count,
                  [&](std::size_t i) { return begin_s + static_cast<double>(i) / rate_hz; });
}

Trajectory resampled_by_distance(const Trajectory& trajectory, double spacing_m) {
  if (trajectory.empty()) {
    places_along(0, spacing_m, "the distance between poses");
    return {};
  }
  std::vector<double> way_m = {0};  // up to each pose
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    way_m.push_back(way_m.back() + length(trajectory[i].world_from_sensor.translation -
                                          trajectory[i - 1].world_from_sensor.translation));
  const std::size_t count = places_along(way_m.back(), spacing_m, "the distance between poses");
  return poses_at(trajectory, count, [&](std::size_t k) {
    const double place_m = std::min(static_cast<double>(k) * spacing_m, way_m.back());
    // The first pose at or behind the place: the way to it is longer than to the one before.
    const auto at = std::ranges::lower_bound(way_m, place_m) - way_m.begin();
    if (at == 0) return trajectory.front().time_s;
    const auto i = static_cast<std::size_t>(at);
    const double share = (place_m - way_m[i - 1]) / (way_m[i] - way_m[i - 1]);
    return trajectory[i - 1].time_s + share * (trajectory[i].time_s - trajectory[i - 1].time_s);
  });
}

Trajectory with_extrapolated_ends(Trajectory poses, double by_s) {
  if (poses.size() < 2) return poses;
  const double begin_s = poses.front().time_s, end_s = poses.back().time_s;
  const auto mirrored = [&](double at_s, double inside_s) {
    const RigidTransform at = interpolate(poses, at_s), inside = interpolate(poses, inside_s);
    return TimedPose{2 * at_s - inside_s, at * (inside.inverse() * at)};
  };
  const TimedPose first = mirrored(begin_s, std::min(begin_s + by_s, end_s));
  const TimedPose last = mirrored(end_s, std::max(end_s - by_s, begin_s));
  poses.insert(poses.begin(), first);
  poses.push_back(last);
  return poses;
}

}  // namespace adasplats
