// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "render_job.h"

#include <algorithm>
#include <cmath>

#include "adasplats/core/error.h"
#include "adasplats/io/png.h"
#include "inputs.h"
#include "model_scene.h"
#include "output_path.h"
#include "stopwatch.h"

namespace adasplats::app {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295;
constexpr int kMostPixels = 1 << 28;

struct Box {
  Vec3d low, high;
};

/// World box of the middle 98 % of the splats along each axis: far outliers must not decide what
/// a picture shows.
Box middle_box(const SplatModel& model) {
  Box box;
  std::vector<float> values(model.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = model.disks[i].center[axis];
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / 100;
    box.low[axis] = static_cast<double>(values[cut]) + model.origin[axis];
    box.high[axis] = static_cast<double>(values[values.size() - 1 - cut]) + model.origin[axis];
  }
  return box;
}

/// From above one corner of the box to its middle.
Camera overview(const Box& box) {
  const Vec3d middle = 0.5 * (box.low + box.high);
  const double size = std::max(length(box.high - box.low), 1.0);
  return look_at(middle + size * Vec3d{-0.45, -0.4, 0.35}, middle);
}

Camera camera_at_pose(const RenderJob& job) {
  const Trajectory trajectory = load_trajectory(job.trajectory);
  if (job.pose >= trajectory.size()) {
    throw Error(ErrorKind::usage, "--pose " + std::to_string(job.pose) + ": the trajectory has " +
                                      std::to_string(trajectory.size()) + " poses");
  }
  Camera camera;
  camera.world_from_camera = trajectory[job.pose].world_from_sensor;
  return camera;
}

Camera camera_of(const RenderJob& job, const SplatModel& model) {
  const Box box = middle_box(model);
  if (job.birds_eye) return birds_eye(box.low, box.high, job.width, job.height);
  Camera camera;
  if (!job.trajectory.empty()) {
    camera = camera_at_pose(job);
  } else if (job.eye) {
    camera = look_at(*job.eye, job.target.value_or(0.5 * (box.low + box.high)));
  } else {
    camera = overview(box);
  }
  camera.width = job.width;
  camera.height = job.height;
  camera.horizontal_fov_rad = job.horizontal_fov_deg * kRadiansPerDegree;
  return camera;
}

ImageColor color_of(const RenderJob& job, const SplatModel& model) {
  if (job.color) return *job.color;
  const bool bare = model.classes.empty() && model.groups.empty();
  return bare ? ImageColor::shading : ImageColor::semantic;
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
  const bool sizes_good =
      job.width > 0 && job.height > 0 &&
      job.width <=
          kMostPixels / job.height / static_cast<int>(std::max<std::size_t>(job.models.size(), 1));
  if (!sizes_good) throw Error(ErrorKind::usage, "--width and --height are out of range");
  if (job.samples_per_axis < 1 || job.samples_per_axis > 64) {
    throw Error(ErrorKind::usage, "--samples must be 1 to 64");
  }
  if (!(job.horizontal_fov_deg > 0 && job.horizontal_fov_deg < 180)) {
    throw Error(ErrorKind::usage, "--fov must be above 0 and below 180 degrees");
  }
  if (job.target && !job.eye) throw Error(ErrorKind::usage, "--target needs --eye");
  const int views = (job.eye ? 1 : 0) + (job.birds_eye ? 1 : 0) + (job.trajectory.empty() ? 0 : 1);
  if (views > 1) {
    throw Error(ErrorKind::usage, "give one of --eye, --birds-eye and --trajectory");
  }
}

}  // namespace

double run_render(const RenderJob& job, Session& session) {
  check(job);
  check_output_file(job.output);
  for (const auto& model : job.models) require_input(model);
  Image picture;
  picture.width = job.width * static_cast<int>(job.models.size());
  picture.height = job.height;
  picture.pixels.resize(static_cast<std::size_t>(picture.width) *
                        static_cast<std::size_t>(picture.height) * 3);
  std::optional<Camera> camera;  // the first model decides where it stands
  double seconds = 0;
  for (std::size_t k = 0; k < job.models.size(); ++k) {
    const ModelScene scene(job.models[k], session);
    if (!camera) camera = camera_of(job, scene.model());
    ImageOptions options;
    options.color = color_of(job, scene.model());
    options.samples_per_axis = job.samples_per_axis;
    session.progress.begin_step("render", 0);
    const Stopwatch watch;
    paste(picture,
          render_image(scene.tracer(), scene.image_scene(), *camera, options, session.executor),
          job.width * static_cast<int>(k));
    seconds += watch.seconds();
    session.progress.end_step();
  }
  write_png(job.output, picture.width, picture.height, picture.pixels);
  return seconds;
}

}  // namespace adasplats::app
