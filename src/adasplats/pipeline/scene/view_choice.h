// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include "adasplats/sensors/camera.h"

namespace adasplats {

/// Where a picture is seen from: one of the places below, or from above a corner of what it shows.
struct ViewChoice {
  int width = 2560;
  int height = 1440;
  double horizontal_fov_deg = 70;
  std::optional<Vec3d> eye;
  std::optional<Vec3d> target;  ///< with `eye`; else the middle of what the picture shows
  bool birds_eye = false;
  std::filesystem::path trajectory;  ///< ahead from a pose of it
  std::size_t pose = 0;
};

/// Errors: usage (sizes and angles out of range, several places).
void check(const ViewChoice& view);

/// The camera for what lies in the world box [low, high]. Errors: those of the trajectory's file;
/// usage (a pose that it does not have).
Camera camera_of(const ViewChoice& view, Vec3d low, Vec3d high);

/// World box of the middle 98 % of points along each axis: far outliers must not decide what a
/// picture shows. `positions` (one or more) are relative to `origin`.
std::pair<Vec3d, Vec3d> middle_box(std::span<const Vec3f> positions, Vec3d origin);

}  // namespace adasplats
