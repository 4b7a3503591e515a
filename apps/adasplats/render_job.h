// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "adasplats/core/vec3.h"
#include "adasplats/simulate/image.h"
#include "session.h"

namespace adasplats::app {

/// One or several models from the same camera, side by side in one picture.
struct RenderJob {
  std::vector<std::filesystem::path> models;
  std::filesystem::path output;
  std::optional<ImageColor> color;  ///< else semantic where the model has classes or groups
  int width = 2560;                 ///< of one model's part of the picture
  int height = 1440;
  int samples_per_axis = 2;
  double horizontal_fov_deg = 70;
  std::optional<Vec3d> eye;  ///< with `target`
  std::optional<Vec3d> target;
  bool birds_eye = false;
  std::filesystem::path trajectory;  ///< looks ahead from one of its poses
  std::size_t pose = 0;
};

/// Renders and writes a PNG; gives back the seconds of rendering alone.
double run_render(const RenderJob& job, Session& session);

}  // namespace adasplats::app
