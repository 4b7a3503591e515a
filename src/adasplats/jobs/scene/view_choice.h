// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "adasplats/jobs/scene/shown_part.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/sensors/camera_file.h"

namespace adasplats {

/// The camera of a picture: one of the positions below, or from above, from the side from which the
/// scene appears largest (overview()).
struct ViewChoice {
  int width = 2560;
  int height = 1440;
  /// Default 45 from afar, 70 from `eye` and from a pose.
  std::optional<double> horizontal_fov_deg;
  std::optional<Vec3d> eye;
  std::optional<Vec3d> target;  ///< with `eye`; default: the middle of the shown part
  bool birds_eye = false;
  std::filesystem::path trajectory;  ///< look ahead from a pose of it
  std::size_t pose = 0;
  std::optional<RigidTransform> at;  ///< look ahead from this pose
  /// A camera with a lens, mounted on what the trajectory or `at` is of; at `eye`, the camera
  /// itself is.
  std::optional<MountedCamera> camera;

  /// Chooses a camera, with its width and height.
  void use(MountedCamera mounted) {
    width = mounted.lens.width;
    height = mounted.lens.height;
    camera = std::move(mounted);
  }
};

/// Errors: usage (sizes and angles out of range, several positions).
void check(const ViewChoice& view);

/// The camera at a pose of the trajectory, looking ahead, or as it is mounted there.
Camera camera_at(const ViewChoice& view, const RigidTransform& world_from_camera);

/// A camera and, on a trajectory, the time of its pose.
struct TimedCamera {
  Camera camera;
  std::optional<double> time_s;
};

/// The camera for a part of a scene. Errors: those of the trajectory's file; usage (a pose that it
/// does not have).
TimedCamera timed_camera_of(const ViewChoice& view, const ShownPart& part);
inline Camera camera_of(const ViewChoice& view, const ShownPart& part) {
  return timed_camera_of(view, part).camera;
}

/// Cameras at all poses of the view's trajectory. Errors: those of the trajectory's file.
std::vector<TimedCamera> at_each_pose(const ViewChoice& view);

/// Cameras of a film, one a picture.

/// Once around the part, from the height of overview() and far enough away that all of it is always
/// in the picture. All at one time.
std::vector<TimedCamera> turntable(const ViewChoice& view, const ShownPart& part,
                                   std::size_t frames);

/// Along the view's trajectory from its first pose to its last, at the driven speed. Errors: those
/// of the trajectory's file.
std::vector<TimedCamera> along_drive(const ViewChoice& view, std::size_t frames);

}  // namespace adasplats
