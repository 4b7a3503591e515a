// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/view_choice.h"

#include <string>

#include "adasplats/core/error.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295;
constexpr int kMaxPixels = 1 << 28;

constexpr double kFromAfar_deg = 45, kFromWithin_deg = 70;

RigidTransform pose_of(const ViewChoice& view) {
  const Trajectory trajectory = load_trajectory(view.trajectory);
  if (view.pose >= trajectory.size()) {
    throw Error(ErrorKind::usage, "`pose` " + std::to_string(view.pose) + ": the trajectory has " +
                                      std::to_string(trajectory.size()) + " poses");
  }
  return trajectory[view.pose].world_from_sensor;
}

double fov_within_rad(const ViewChoice& view) {
  return view.horizontal_fov_deg.value_or(kFromWithin_deg) * kRadiansPerDegree;
}

}  // namespace

void check(const ViewChoice& view) {
  if (!(view.width > 0 && view.height > 0 && view.width <= kMaxPixels / view.height)) {
    throw Error(ErrorKind::usage, "`width` and `height` are out of range");
  }
  if (const double fov_deg = view.horizontal_fov_deg.value_or(kFromWithin_deg);
      !(fov_deg > 0 && fov_deg < 180)) {
    throw Error(ErrorKind::usage, "`fov` must be above 0 and below 180 degrees");
  }
  if (view.target && !view.eye) throw Error(ErrorKind::usage, "`target` needs `eye`");
  const int places =
      (view.eye ? 1 : 0) + (view.birds_eye ? 1 : 0) + (view.trajectory.empty() ? 0 : 1);
  if (places > 1) {
    throw Error(ErrorKind::usage, "give one of `eye`, `birds_eye` and `trajectory`");
  }
}

Camera camera_at(const ViewChoice& view, const RigidTransform& world_from_camera) {
  Camera camera;
  camera.world_from_camera = world_from_camera;
  camera.width = view.width;
  camera.height = view.height;
  camera.horizontal_fov_rad = fov_within_rad(view);
  return camera;
}

Camera camera_of(const ViewChoice& view, const ShownPart& part) {
  if (view.birds_eye) return birds_eye(part.low, part.high, view.width, view.height);
  if (view.trajectory.empty() && !view.eye)
    return overview(part, view.width, view.height,
                    view.horizontal_fov_deg.value_or(kFromAfar_deg) * kRadiansPerDegree);
  return camera_at(
      view, view.eye ? look_at(*view.eye, view.target.value_or(part.middle())).world_from_camera
                     : pose_of(view));
}

}  // namespace adasplats
