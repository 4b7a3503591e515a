// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/view_choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/error.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295;
constexpr int kMaxPixels = 1 << 28;

constexpr double kFromAfar_deg = 45, kFromWithin_deg = 70;

TimedCamera camera_at_pose(const ViewChoice& view) {
  if (view.at) return {camera_at(view, *view.at), std::nullopt};
  const Trajectory trajectory = load_trajectory(view.trajectory);
  if (view.pose >= trajectory.size()) {
    throw Error(ErrorKind::usage, "`pose` " + std::to_string(view.pose) + ": the trajectory has " +
                                      std::to_string(trajectory.size()) + " poses");
  }
  const TimedPose& pose = trajectory[view.pose];
  return {camera_at(view, pose.world_from_sensor), pose.time_s};
}

double fov_within_rad(const ViewChoice& view) {
  return view.horizontal_fov_deg.value_or(kFromWithin_deg) * kRadiansPerDegree;
}

}  // namespace

void check(const ViewChoice& view) {
  if (!(view.width > 0 && view.height > 0 && view.width <= kMaxPixels / view.height)) {
    throw Error(ErrorKind::usage,
                "`width` and `height` must be positive, with at most 2^28 pixels");
  }
  if (const double fov_deg = view.horizontal_fov_deg.value_or(kFromWithin_deg);
      !(fov_deg > 0 && fov_deg < 180)) {
    throw Error(ErrorKind::usage, "`fov` must be above 0 and below 180 degrees");
  }
  if (view.target && !view.eye) throw Error(ErrorKind::usage, "`target` needs `eye`");
  const bool is_at_pose = view.at || !view.trajectory.empty();
  const int positions = (view.eye ? 1 : 0) + (view.birds_eye ? 1 : 0) + (is_at_pose ? 1 : 0);
  if (positions > 1) {
    throw Error(ErrorKind::usage, "give one of `eye`, `birds_eye` and `trajectory`");
  }
  if (!view.camera) return;
  if (view.horizontal_fov_deg)
    throw Error(ErrorKind::usage, "`fov` has no effect with `camera`, which has its own");
  if (!view.eye && !is_at_pose)
    throw Error(ErrorKind::usage, "`camera` needs `trajectory` or `eye`");
}

Camera camera_at(const ViewChoice& view, const RigidTransform& world_from_camera) {
  if (view.camera) return view.camera->at(world_from_camera);
  Camera camera;
  camera.world_from_camera = world_from_camera;
  camera.width = view.width;
  camera.height = view.height;
  camera.horizontal_fov_rad = fov_within_rad(view);
  return camera;
}

TimedCamera timed_camera_of(const ViewChoice& view, const ShownPart& part) {
  if (view.birds_eye)
    return {birds_eye(part.low, part.high, view.width, view.height), std::nullopt};
  if (view.trajectory.empty() && !view.at && !view.eye)
    return {overview(part, view.width, view.height,
                     view.horizontal_fov_deg.value_or(kFromAfar_deg) * kRadiansPerDegree),
            std::nullopt};
  if (!view.eye) return camera_at_pose(view);
  const Camera looking = look_at(*view.eye, view.target.value_or(part.middle()));
  Camera camera = camera_at(view, looking.world_from_camera);
  camera.world_from_camera = looking.world_from_camera;
  return {camera, std::nullopt};
}

std::vector<TimedCamera> at_each_pose(const ViewChoice& view) {
  std::vector<TimedCamera> cameras;
  for (const TimedPose& pose : load_trajectory(view.trajectory))
    cameras.push_back({camera_at(view, pose.world_from_sensor), pose.time_s});
  return cameras;
}

std::vector<TimedCamera> turntable(const ViewChoice& view, const ShownPart& part,
                                   std::size_t frames) {
  ViewChoice afar = view;
  afar.trajectory.clear();
  const Camera first = camera_of(afar, part);
  const Vec3d forward = first.world_from_camera.rotation * Vec3d{1, 0, 0};
  const double pitch = std::asin(-forward.z), azimuth = std::atan2(forward.y, forward.x);
  double farthest = 0;
  for (int k = 0; k < 24; ++k)
    farthest = std::max(
        farthest, length(overview_from(part, view.width, view.height, first.horizontal_fov_rad,
                                       pitch, azimuth + k * std::numbers::pi / 12)
                             .world_from_camera.translation -
                         part.middle()));
  std::vector<TimedCamera> cameras;
  for (std::size_t i = 0; i < frames; ++i) {
    const double turned =
        azimuth + 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(frames);
    const Vec3d direction = {std::cos(pitch) * std::cos(turned), std::cos(pitch) * std::sin(turned),
                             -std::sin(pitch)};
    Camera camera = look_at(part.middle() - farthest * direction, part.middle());
    camera.width = view.width;
    camera.height = view.height;
    camera.horizontal_fov_rad = first.horizontal_fov_rad;
    cameras.push_back({camera, std::nullopt});
  }
  return cameras;
}

std::vector<TimedCamera> along_drive(const ViewChoice& view, std::size_t frames) {
  const Trajectory trajectory = load_trajectory(view.trajectory);
  const double begin_s = trajectory.front().time_s, span_s = trajectory.back().time_s - begin_s;
  std::vector<TimedCamera> cameras;
  for (std::size_t i = 0; i < frames; ++i) {
    const double share =
        frames > 1 ? static_cast<double>(i) / static_cast<double>(frames - 1) : 0.0;
    const double time_s = begin_s + share * span_s;
    cameras.push_back({camera_at(view, interpolate(trajectory, time_s)), time_s});
  }
  return cameras;
}

}  // namespace adasplats
