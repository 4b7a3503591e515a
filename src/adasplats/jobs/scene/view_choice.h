// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "adasplats/jobs/scene/shown_part.h"
#include "adasplats/sensors/camera.h"

namespace adasplats {

/// Where a picture is seen from: one of the places below, or from above, from the side from which
/// what it shows appears largest (overview()).
struct ViewChoice {
  int width = 2560;
  int height = 1440;
  /// Else 45 from afar, 70 from `eye` and from a pose.
  std::optional<double> horizontal_fov_deg;
  std::optional<Vec3d> eye;
  std::optional<Vec3d> target;  ///< with `eye`; else the middle of what the picture shows
  bool birds_eye = false;
  std::filesystem::path trajectory;  ///< ahead from a pose of it
  std::size_t pose = 0;
};

/// Errors: usage (sizes and angles out of range, several places).
void check(const ViewChoice& view);

/// The camera at a pose, looking ahead.
Camera camera_at(const ViewChoice& view, const RigidTransform& world_from_camera);

/// The camera for a part of a place. Errors: those of the trajectory's file; usage (a pose that it
/// does not have).
Camera camera_of(const ViewChoice& view, const ShownPart& part);

}  // namespace adasplats
