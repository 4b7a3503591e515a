// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "adasplats/core/setting.h"
#include "adasplats/jobs/pictures/panel.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/view_choice.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// A picture, or a film of many.
enum class Film : std::uint8_t {
  none,
  turntable,  ///< once around what is shown
  drive,      ///< along the trajectory, looking ahead
};

/// One or several models (splats, meshes, world files) or point clouds from the same camera, side
/// by side in one picture.
struct RenderJob {
  std::vector<std::filesystem::path> models;
  std::filesystem::path output;
  std::string labels;  ///< scheme of the classes; empty: what the models say
  /// Errors of held-out beams (evaluate resimulate --errors) to colour the splats of one model by.
  std::filesystem::path errors;
  ViewChoice view;     ///< width and height are those of one model's part of the picture
  std::string camera;  ///< of load_camera(), chosen for `view`; "": none
  std::string layers;  ///< of layers_of(); of one model
  /// Of the objects of world files. Default: that of the pose, else when the first begins to move.
  std::optional<double> time_s;
  /// One picture a pose of the trajectory: `output` is a folder of 000000.png, 000001.png...
  bool each_pose = false;
  bool overwrite = false;  ///< that folder
  PanelLook look;
  /// Instead of two models side by side: how much farther the second is along the view.
  bool difference = false;
  Film film = Film::none;
  double seconds = 12;  ///< of a film
  double frames_per_s = 24;
  int repeat = 1;  ///< renders so often, for the median of the time
};

struct RenderResult {
  std::size_t images = 0;            ///< one a model
  double seconds_rendered = 0;       ///< sum over the models of the median, rendering alone
  double seconds_of_layers = 0;      ///< casting alone
  std::uint64_t clipped_values = 0;  ///< depths and ranges that their PNG do not hold
  std::uint64_t unlit_pixels = 0;    ///< of all pictures with layers: without a ray of the lens
};

template <class Visit>
void visit_settings(RenderJob& job, Visit&& visit) {
  visit(Setting{.name = "samples",
                .help = "Samples per pixel along each axis: N x N rays",
                .min = 1,
                .max = 64},
        job.look.samples_per_axis);
  visit(Setting{.name = "relief",
                .help = "Darken corners and gaps, and blend neighbouring splats of a surface"},
        job.look.relief);
  visit(Setting{.name = "captions", .help = "Draw title, legend, scale and north arrow"},
        job.look.captions);
  visit(
      Setting{
          .name = "difference",
          .help = "Colour by how much farther away the second of two models is along the view rays",
          .basic = true},
      job.difference);
  visit(Setting{.name = "camera",
                .help = "Camera file: lens and mount",
                .value = "FILE[:NAME]",
                .basic = true},
        job.camera);
  visit(Setting{.name = "layers",
                .help = "Also write these as arrays: depth, range, class, normal, splat",
                .value = "LAYER,...",
                .group = "Camera"},
        job.layers);
  visit(Setting{.name = "each_pose",
                .help = "Write a folder with one picture for each pose of --trajectory",
                .group = "Camera"},
        job.each_pose);
  visit(Setting{.name = "seconds",
                .help = "Length of a film, s",
                .value = "S",
                .group = "Film",
                .min = 0,
                .max = 3600,
                .exclusive_min = true},
        job.seconds);
  visit(Setting{.name = "frames_per_s",
                .help = "Frame rate of a film, 1/s",
                .value = "N",
                .group = "Film",
                .min = 1,
                .max = 120},
        job.frames_per_s);
  visit(Setting{.name = "repeat",
                .help = "Render this many times and report the median time",
                .value = "N",
                .min = 1},
        job.repeat);
}

/// Whether one of the inputs is a model or a mesh; the others are points. Errors: no_input.
bool draws_a_model(const RenderJob& job);

/// Renders and writes a PNG, or a film (film_writer.h). Errors: usage (sizes or settings out of
/// range; what cannot be drawn together), those of the inputs and of check_film().
RenderResult run_render(const RenderJob& job, Session& session);
/// The same of one model that is loaded already: the file that `job` names.
RenderResult run_render(const RenderJob& job, std::shared_ptr<const ModelScene> model,
                        Session& session);

}  // namespace adasplats
