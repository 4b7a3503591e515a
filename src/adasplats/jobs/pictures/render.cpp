// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/pictures/difference.h"
#include "adasplats/jobs/pictures/film_writer.h"
#include "adasplats/jobs/pictures/layer_files.h"
#include "adasplats/jobs/pictures/panel.h"
#include "adasplats/jobs/scene/view_choice.h"
#include "adasplats/jobs/scene/world_clock.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/settings_json.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxRenderPixels = 1 << 28;
constexpr const char* kRenderCommand = "render";

/// The panels of a picture side by side.
class Panels {
 public:
  Panels(const RenderJob& job, std::vector<Panel> panels, Session& session)
      : job_(job), session_(session), panels_(std::move(panels)) {
    if (job.difference)
      require_overlap(*panels_[0].model(), job.models[0], *panels_[1].model(), job.models[1]);
    SharedRange range;
    for (Panel& panel : panels_) {
      if (job.view.trajectory.empty()) panel.show_at(job.time_s, session);
      if (!job.errors.empty()) panel.show_errors(job.errors);
      panel.prepare(job.look, range);
    }
    part_ = panels_.front().shown_part();  // the first determines the camera
    if (job.view.trajectory.empty()) middle_ = part_.middle();
  }

  const ShownPart& part() const { return part_; }
  /// Shows the objects of worlds at this time.
  void show_at(const std::optional<double>& time_s) {
    for (Panel& panel : panels_) {
      const World* const world = panel.model() != nullptr ? panel.model()->world() : nullptr;
      if (world != nullptr && time_s && !job_.time_s && !has_warned_)
        has_warned_ = warn_of_world_clock(*world, *time_s, *time_s, session_.progress);
      panel.show_at(time_s, session_);
    }
  }
  /// The model of the only panel; null if it is of points.
  const ModelScene* only_model() const { return panels_.front().model(); }
  int columns() const { return job_.difference ? 1 : static_cast<int>(panels_.size()); }

  /// One picture of all, with captions.
  Image draw(const Camera& camera) {
    Image picture = blank_image(job_.view.width * columns(), job_.view.height);
    seconds_ = 0;
    for (int k = 0; k < columns(); ++k) {
      Image image = timed(camera, panels_[static_cast<std::size_t>(k)]);
      if (job_.look.captions && !job_.view.camera)
        write_captions(image, camera, static_cast<std::size_t>(k));
      paste(picture, image, job_.view.width * k, 0);
    }
    return picture;
  }

  /// Of the last picture without captions: the sum over the panels.
  double seconds() const { return seconds_; }

 private:
  Image draw_once(const Camera& camera, const Panel& panel) const {
    if (!job_.difference) return panel.draw(camera, job_.look, session_.executor);
    return draw_difference(*panels_[0].model(), *panels_[1].model(), camera, session_.executor);
  }

  /// Draws a panel as often as is asked for, and takes the median of the time.
  Image timed(const Camera& camera, const Panel& panel) {
    std::vector<double> seconds;
    Image image;
    for (int i = 0; i < job_.repeat; ++i) {
      const Stopwatch watch;
      image = draw_once(camera, panel);
      seconds.push_back(watch.seconds());
    }
    std::sort(seconds.begin(), seconds.end());
    const std::size_t half = seconds.size() / 2;
    seconds_ += seconds.size() % 2 == 1 ? seconds[half] : 0.5 * (seconds[half - 1] + seconds[half]);
    return image;
  }

  void write_captions(Image& image, const Camera& camera, std::size_t k) const {
    const auto name = [&](std::size_t i) { return job_.models[i].stem().string(); };
    if (job_.difference) {
      panels_[0].write_place(image, camera, name(1) + " against " + name(0), middle_);
      write_difference_legend(image, name(0), name(1));
    } else {
      panels_[k].write_captions(image, camera, panels_.size() > 1 ? name(k) : "", middle_);
    }
  }

  const RenderJob& job_;
  Session& session_;
  std::vector<Panel> panels_;
  ShownPart part_;
  std::optional<Vec3d> middle_;
  double seconds_ = 0;
  bool has_warned_ = false;  ///< of another clock
};

void check(const RenderJob& job) {
  check(job.view);
  const auto parts = static_cast<int>(std::max<std::size_t>(job.models.size(), 1));
  if (job.view.width > kMaxRenderPixels / job.view.height / parts) {
    throw Error(ErrorKind::usage, "`width` and `height` are out of range");
  }
  check_settings(job);
  if (job.time_s && std::ranges::none_of(job.models, [](const fs::path& model) {
        return model.extension() == ".toml";
      }))
    throw Error(ErrorKind::usage, "`time` is of the objects of world files");
  if (!job.errors.empty() && job.models.size() != 1)
    throw Error(ErrorKind::usage, "`errors` are of one model");
  if (job.difference && !job.errors.empty())
    throw Error(ErrorKind::usage, "give one of `errors` and `difference`");
  if (!layers_of(job.layers).empty() && (job.models.size() != 1 || !is_model_file(job.models[0])))
    throw Error(ErrorKind::usage, "`layers` are of one model or mesh");
  if (job.each_pose && job.view.trajectory.empty())
    throw Error(ErrorKind::usage, "`each_pose` needs `trajectory`");
  if (job.film != Film::none && (job.each_pose || !job.layers.empty()))
    throw Error(ErrorKind::usage, "a film has no `layers` and is not of `each_pose`");
  if (job.time_s && (job.each_pose || job.film == Film::drive))
    throw Error(ErrorKind::usage, "`time` is of one picture; others have those of the trajectory");
  if (job.each_pose) {
    if (lower_case(job.output.extension().string()) == ".png")
      throw Error(ErrorKind::usage, job.output.string() + ": `each_pose` writes a folder");
    return;
  }
  if (job.film == Film::none) {
    if (lower_case(job.output.extension().string()) != ".png")
      throw Error(
          ErrorKind::usage,
          job.output.string() + ": a picture is a .png; `turntable` and `drive` make films");
    return;
  }
  check_film(job.output);
  if (job.film == Film::drive && job.view.trajectory.empty())
    throw Error(ErrorKind::usage, "`drive` needs `trajectory`");
  if (job.film == Film::turntable &&
      (job.view.birds_eye || job.view.eye || !job.view.trajectory.empty()))
    throw Error(ErrorKind::usage, "a `turntable` chooses its own place of the camera");
}

void check_inputs(const RenderJob& job) {
  for (const auto& model : job.models) require_input(model);
  if (!job.errors.empty()) require_input(job.errors);
  if (job.difference &&
      (job.models.size() != 2 || !is_model_file(job.models[0]) || !is_model_file(job.models[1])))
    throw Error(ErrorKind::usage, "a `difference` is of two models or meshes");
}

/// As many cameras as the film has pictures.
std::vector<TimedCamera> cameras_of(const RenderJob& job, const ShownPart& part) {
  const auto frames =
      static_cast<std::size_t>(std::max(1.0, std::round(job.seconds * job.frames_per_s)));
  if (job.film == Film::turntable) return turntable(job.view, part, frames);
  return along_drive(job.view, frames);
}

RenderResult draw_film(const RenderJob& job, Panels& panels, Session& session) {
  const std::vector<TimedCamera> cameras = cameras_of(job, panels.part());
  const std::unique_ptr<FilmWriter> film = make_film_writer(job.output, job.frames_per_s);
  RenderResult result;
  session.progress.begin_step("draw the film", cameras.size());
  for (const TimedCamera& at : cameras) {
    panels.show_at(job.time_s ? job.time_s : at.time_s);
    film->add(panels.draw(at.camera));
    result.seconds_rendered += panels.seconds();
    session.progress.advance(++result.images);
  }
  session.progress.end_step();
  session.progress.begin_step("write the film", 0);
  film->finish(session.progress);
  session.progress.end_step();
  return result;
}

/// Draws and writes one picture and its layers, and adds its figures.
void draw_picture(const RenderJob& job, const TimedCamera& at, const fs::path& file, Panels& panels,
                  Session& session, RenderResult& result) {
  const Camera& camera = at.camera;
  panels.show_at(job.time_s ? job.time_s : at.time_s);
  const Image picture = panels.draw(camera);
  write_png(file, picture.width, picture.height, picture.pixels);
  result.images += static_cast<std::size_t>(panels.columns());
  result.seconds_rendered += panels.seconds();
  const std::vector<ImageLayer> wanted = layers_of(job.layers);
  if (wanted.empty()) return;
  const ModelScene& model = *panels.only_model();
  const Stopwatch watch;
  const LayerImages layers =
      cast_layers(model.picture_tracer(), model.image_scene(), camera, wanted, session.executor);
  result.seconds_of_layers += watch.seconds();
  result.unlit_pixels += layers.unlit_pixels;
  result.clipped_values += write_layers(file, layers);
}

/// The settings that made a folder of pictures.
nlohmann::ordered_json content_of(const RenderJob& job) {
  nlohmann::ordered_json content;
  content["model"] = job.models.front().filename().string();
  content["trajectory"] = job.view.trajectory.filename().string();
  put_settings(job, content);
  return content;
}

RenderResult draw_each_pose(const RenderJob& job, Panels& panels, Session& session) {
  const std::vector<TimedCamera> cameras = at_each_pose(job.view);
  OutputFolder folder(job.output, job.overwrite, kRenderCommand, content_of(job));
  RenderResult result;
  session.progress.begin_step("render", cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%06zu.png", i);
    draw_picture(job, cameras[i], folder.path() / name.data(), panels, session, result);
    session.progress.advance(i + 1);
  }
  session.progress.end_step();
  folder.commit();
  return result;
}

RenderResult draw(const RenderJob& job, std::vector<Panel> parts, Session& session) {
  Panels panels(job, std::move(parts), session);
  if (job.film != Film::none) return draw_film(job, panels, session);
  if (job.each_pose) return draw_each_pose(job, panels, session);
  RenderResult result;
  session.progress.begin_step("render", 0);
  draw_picture(job, timed_camera_of(job.view, panels.part()), job.output, panels, session, result);
  session.progress.end_step();
  return result;
}

/// The job with its camera, checked before anything else is loaded.
RenderJob checked(RenderJob job) {
  if (!job.camera.empty()) job.view.use(load_camera(job.camera));
  check_inputs(job);
  check(job);
  if (job.each_pose) {
    require_folder_apart(job.output, job.models);
    checked_output_folder(job.output, job.overwrite, kRenderCommand);
    return job;
  }
  check_output_file(job.output);
  for (const fs::path& file : layer_files(job.output, layers_of(job.layers)))
    check_output_file(file);
  return job;
}

}  // namespace

bool draws_a_model(const RenderJob& job) {
  for (const auto& model : job.models) require_input(model);
  return std::any_of(job.models.begin(), job.models.end(), is_model_file);
}

RenderResult run_render(const RenderJob& given, Session& session) {
  const RenderJob job = checked(given);
  std::vector<Panel> panels;
  for (const auto& input : job.models) panels.emplace_back(input, job.labels, session);
  return draw(job, std::move(panels), session);
}

RenderResult run_render(const RenderJob& given, std::shared_ptr<const ModelScene> model,
                        Session& session) {
  const RenderJob job = checked(given);
  std::vector<Panel> panels;
  panels.emplace_back(std::move(model));
  return draw(job, std::move(panels), session);
}

}  // namespace adasplats
