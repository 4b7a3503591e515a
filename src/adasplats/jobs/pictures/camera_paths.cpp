// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/camera_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {

std::vector<Camera> turntable(const ViewChoice& view, const ShownPart& part, std::size_t frames) {
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
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < frames; ++i) {
    const double turned =
        azimuth + 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(frames);
    const Vec3d direction = {std::cos(pitch) * std::cos(turned), std::cos(pitch) * std::sin(turned),
                             -std::sin(pitch)};
    Camera camera = look_at(part.middle() - farthest * direction, part.middle());
    camera.width = view.width;
    camera.height = view.height;
    camera.horizontal_fov_rad = first.horizontal_fov_rad;
    cameras.push_back(camera);
  }
  return cameras;
}

std::vector<Camera> along_drive(const ViewChoice& view, std::size_t frames) {
  Trajectory trajectory = load_trajectory(view.trajectory);
  // Poses without times are taken as equally far apart in time.
  const bool timed = trajectory.back().time_s > trajectory.front().time_s;
  for (std::size_t i = 0; !timed && i < trajectory.size(); ++i)
    trajectory[i].time_s = static_cast<double>(i);
  const double begin = trajectory.front().time_s, span = trajectory.back().time_s - begin;
  ViewChoice ahead = view;
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < frames; ++i) {
    const double share =
        frames > 1 ? static_cast<double>(i) / static_cast<double>(frames - 1) : 0.0;
    Camera camera = camera_at(ahead, interpolate(trajectory, begin + share * span));
    cameras.push_back(camera);
  }
  return cameras;
}

}  // namespace adasplats
