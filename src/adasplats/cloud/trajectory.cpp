// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/trajectory.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "adasplats/cloud/rotation.h"

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

}  // namespace adasplats
