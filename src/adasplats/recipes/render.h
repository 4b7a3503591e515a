// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/setting.h"
#include "adasplats/pipeline/scene/view_choice.h"
#include "adasplats/pipeline/session/session.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {

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

template <class Visit>
void visit_settings(RenderJob& job, Visit&& visit) {
  visit(
      Setting{
          .name = "samples", .help = "Rays a pixel: the square of this", .least = 1, .most = 64},
      job.samples_per_axis);
  visit(Setting{.name = "repeat",
                .help = "Render so often and report the median of the time",
                .value = "N",
                .least = 1},
        job.repeat);
}

/// Whether one of the inputs is a model or a mesh; the others are points. Errors: no_input.
bool draws_a_model(const RenderJob& job);

/// Renders and writes a PNG. Errors: usage (sizes or settings out of range), those of the inputs.
RenderResult run_render(const RenderJob& job, Session& session);

}  // namespace adasplats
