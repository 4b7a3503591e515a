// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/pipeline/scene/view_choice.h"
#include "adasplats/simulate/image/image.h"
#include "cli/session.h"

namespace adasplats::app {

/// One or several models (splats or meshes) or point clouds from the same camera, side by side in
/// one picture.
struct RenderJob {
  std::vector<std::filesystem::path> models;
  std::filesystem::path output;
  std::string labels;  ///< scheme of the classes; empty: what the models say
  /// Else by class where the model has classes or groups, and points by intensity or height.
  std::optional<ImageColor> color;
  ViewChoice view;  ///< width and height are those of one model's part of the picture
  int samples_per_axis = 2;
  int repeat = 1;  ///< renders so often, for the median of the time
};

struct RenderResult {
  std::size_t images = 0;       ///< one a model
  double seconds_rendered = 0;  ///< sum over the models of the median, rendering alone
};

/// Renders and writes a PNG.
/// Whether one of the inputs is a model or a mesh; the others are points. Errors: no_input.
bool draws_a_model(const RenderJob& job);

RenderResult run_render(const RenderJob& job, Session& session);

}  // namespace adasplats::app
