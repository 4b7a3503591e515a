// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/scene/view_choice.h"

#include <algorithm>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/pipeline/session/inputs.h"

namespace adasplats {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295;
constexpr int kMostPixels = 1 << 28;

/// From above one corner of the box to its middle.
Camera overview(Vec3d low, Vec3d high) {
  const Vec3d middle = 0.5 * (low + high);
  const double size = std::max(length(high - low), 1.0);
  return look_at(middle + size * Vec3d{-0.45, -0.4, 0.35}, middle);
}

Camera camera_at_pose(const ViewChoice& view) {
  const Trajectory trajectory = load_trajectory(view.trajectory);
  if (view.pose >= trajectory.size()) {
    throw Error(ErrorKind::usage, "`pose` " + std::to_string(view.pose) + ": the trajectory has " +
                                      std::to_string(trajectory.size()) + " poses");
  }
  Camera camera;
  camera.world_from_camera = trajectory[view.pose].world_from_sensor;
  return camera;
}

}  // namespace

void check(const ViewChoice& view) {
  if (!(view.width > 0 && view.height > 0 && view.width <= kMostPixels / view.height)) {
    throw Error(ErrorKind::usage, "`width` and `height` are out of range");
  }
  if (!(view.horizontal_fov_deg > 0 && view.horizontal_fov_deg < 180)) {
    throw Error(ErrorKind::usage, "`fov` must be above 0 and below 180 degrees");
  }
  if (view.target && !view.eye) throw Error(ErrorKind::usage, "`target` needs `eye`");
  const int places =
      (view.eye ? 1 : 0) + (view.birds_eye ? 1 : 0) + (view.trajectory.empty() ? 0 : 1);
  if (places > 1) {
    throw Error(ErrorKind::usage, "give one of `eye`, `birds_eye` and `trajectory`");
  }
}

Camera camera_of(const ViewChoice& view, Vec3d low, Vec3d high) {
  if (view.birds_eye) return birds_eye(low, high, view.width, view.height);
  Camera camera;
  if (!view.trajectory.empty()) {
    camera = camera_at_pose(view);
  } else if (view.eye) {
    camera = look_at(*view.eye, view.target.value_or(0.5 * (low + high)));
  } else {
    camera = overview(low, high);
  }
  camera.width = view.width;
  camera.height = view.height;
  camera.horizontal_fov_rad = view.horizontal_fov_deg * kRadiansPerDegree;
  return camera;
}

std::pair<Vec3d, Vec3d> middle_box(std::span<const Vec3f> positions, Vec3d origin) {
  std::vector<float> values(positions.size());
  std::pair<Vec3d, Vec3d> box;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = positions[i][axis];
    const auto at = [&](std::size_t rank) {
      const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
      std::nth_element(values.begin(), place, values.end());
      return static_cast<double>(*place) + origin[axis];
    };
    const std::size_t cut = positions.size() / 100;
    box.first[axis] = at(cut);
    box.second[axis] = at(positions.size() - 1 - cut);
  }
  return box;
}

}  // namespace adasplats
