// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/render.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/pipeline/output/output_folder.h"
#include "adasplats/pipeline/scene/model_scene.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/simulate/image/class_colors.h"
#include "adasplats/simulate/image/point_colors.h"

namespace adasplats {
namespace {

constexpr int kMostPixels = 1 << 28;

/// What one part of the picture shows: a model, or else a cloud.
struct Subject {
  std::unique_ptr<ModelScene> model;
  PointCloud cloud;
  std::optional<LabelScheme> labels;  ///< of the cloud
};

bool is_model(const std::filesystem::path& input) {
  return std::filesystem::is_regular_file(input) && (is_mesh_file(input) || is_splat_model(input));
}

Subject load_subject(const RenderJob& job, const std::filesystem::path& input, Session& session) {
  Subject subject;
  if (is_model(input)) {
    subject.model = std::make_unique<ModelScene>(input, job.labels, session);
    return subject;
  }
  const std::filesystem::path resolved = resolve_cloud_input(input);
  const std::span inputs(&resolved, 1);
  subject.labels = label_scheme_for(job.labels, inputs);
  subject.cloud = load_cloud(inputs, {}, session.executor, session.progress).first;
  if (subject.cloud.empty()) throw Error(ErrorKind::data, input.string() + ": no points");
  return subject;
}

ShownPart shown_part_of(const Subject& subject) {
  return subject.model ? subject.model->shown_part()
                       : shown_part(subject.cloud.positions, subject.cloud.origin);
}

/// Copies `part` into `picture` at column `left`.
void paste(Image& picture, const Image& part, int left) {
  const std::size_t row_bytes = static_cast<std::size_t>(part.width) * 3;
  for (int row = 0; row < part.height; ++row) {
    const auto from = part.pixels.begin() +
                      static_cast<std::ptrdiff_t>(row_bytes * static_cast<std::size_t>(row));
    const std::size_t to =
        (static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
         static_cast<std::size_t>(left)) *
        3;
    std::copy(from, from + static_cast<std::ptrdiff_t>(row_bytes),
              picture.pixels.begin() + static_cast<std::ptrdiff_t>(to));
  }
}

void check(const RenderJob& job) {
  check(job.view);
  const auto parts = static_cast<int>(std::max<std::size_t>(job.models.size(), 1));
  if (job.view.width > kMostPixels / job.view.height / parts) {
    throw Error(ErrorKind::usage, "`width` and `height` are out of range");
  }
  check_settings(job);
}

Image image_of(const ModelScene& model, const Camera& camera, const RenderJob& job) {
  ImageOptions options;
  options.color = job.color.value_or(model.default_color());
  options.samples_per_axis = job.samples_per_axis;
  return model.render(camera, options);
}

Image image_of(const Subject& subject, const Camera& camera, const RenderJob& job,
               Session& session) {
  if (subject.model) return image_of(*subject.model, camera, job);
  const PointCloud& cloud = subject.cloud;
  const LabelScheme* labels = subject.labels ? &*subject.labels : nullptr;
  const ImageColor color = job.color.value_or(default_color(cloud, labels));
  std::vector<Rgb> colors =
      point_colors(cloud, labels, color, camera.world_from_camera.translation);
  if (color == ImageColor::semantic)
    std::transform(colors.begin(), colors.end(), colors.begin(), muted);
  return draw_points(cloud.positions, cloud.origin, colors, camera, {}, session.executor);
}

/// One part of the picture and the median of the seconds that it took.
std::pair<Image, double> timed_image(const Subject& subject, const Camera& camera,
                                     const RenderJob& job, Session& session) {
  std::vector<double> seconds;
  Image image;
  session.progress.begin_step("render", static_cast<std::uint64_t>(job.repeat) * kPassUnits);
  for (int i = 0; i < job.repeat; ++i) {
    const Stopwatch watch;
    image = image_of(subject, camera, job, session);
    seconds.push_back(watch.seconds());
    session.progress.advance((static_cast<std::uint64_t>(i) + 1) * kPassUnits);
  }
  session.progress.end_step();
  std::sort(seconds.begin(), seconds.end());
  const std::size_t half = seconds.size() / 2;
  const double median =
      seconds.size() % 2 == 1 ? seconds[half] : 0.5 * (seconds[half - 1] + seconds[half]);
  return {std::move(image), median};
}

}  // namespace

bool draws_a_model(const RenderJob& job) {
  for (const auto& model : job.models) require_input(model);
  return std::any_of(job.models.begin(), job.models.end(), is_model);
}

RenderResult run_render(const RenderJob& job, Session& session) {
  check(job);
  check_output_file(job.output);
  for (const auto& model : job.models) require_input(model);
  Image picture;
  picture.width = job.view.width * static_cast<int>(job.models.size());
  picture.height = job.view.height;
  picture.pixels.resize(static_cast<std::size_t>(picture.width) *
                        static_cast<std::size_t>(picture.height) * 3);
  std::optional<Camera> camera;  // the first model decides where it stands
  RenderResult result;
  for (std::size_t k = 0; k < job.models.size(); ++k) {
    const Subject subject = load_subject(job, job.models[k], session);
    if (!camera) camera = camera_of(job.view, shown_part_of(subject));
    const auto [image, seconds] = timed_image(subject, *camera, job, session);
    paste(picture, image, job.view.width * static_cast<int>(k));
    result.seconds_rendered += seconds;
    ++result.images;
  }
  write_png(job.output, picture.width, picture.height, picture.pixels);
  return result;
}

}  // namespace adasplats
