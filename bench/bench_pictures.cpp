// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// Seconds for a picture of 2560 x 1440 pixels from poses of a drive, with and without relief
// (without: each sample has its own colour), alternating in one run.
//   bench_pictures MODEL TRAJECTORY [--device cpu|cuda|optix] [--json FILE]

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/session/device_choice.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/splats/model/splat_model.h"
#include "common.h"

namespace adasplats {
namespace {

constexpr int kRounds = 7;
constexpr std::size_t kCpuPictures = 2, kGpuPictures = 200;

/// Renders the pictures of all cameras; a GPU renders them in batches.
class Drawer {
 public:
  Drawer(const SplatModel& model, const std::string& device, const Executor& executor) {
    scene_.view = model.view();
    scene_.attributes.classes = model.classes;
    scene_.attributes.intensities = model.intensities;
    scene_.groups = model.groups;
    scene_.origin = model.origin;
    if (device == "cpu") {
      engine_ = make_cpu_scene_engine(scene_.view, scene_.origin, executor);
    } else {
      engine_ =
          make_gpu_scene(scene_.view, scene_.origin,
                         device == "optix" ? TracingBackend::optix : TracingBackend::cuda, {0});
    }
  }

  /// Seconds per picture.
  double measure(const std::vector<Camera>& cameras, const ImageOptions& options) {
    const auto renderer = engine_->renderer(scene_, options);
    const Stopwatch watch;
    renderer->render_all(cameras, [&](std::size_t, std::span<const std::uint8_t> pixels) {
      bytes_ += pixels.size();
    });
    return watch.seconds() / static_cast<double>(cameras.size());
  }

 private:
  ImageScene scene_;
  std::unique_ptr<SceneEngine> engine_;
  std::size_t bytes_ = 0;
};

std::vector<Camera> cameras_along(const Trajectory& poses, std::size_t count) {
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < count; ++i) {
    const RigidTransform& pose = poses[i * poses.size() / count].world_from_sensor;
    Camera camera = look_at(pose.translation, pose * Vec3d{10, 0, -0.5});
    camera.width = 2560;
    camera.height = 1440;
    cameras.push_back(camera);
  }
  return cameras;
}

nlohmann::ordered_json measure(Drawer& drawer, const std::vector<Camera>& cameras, int samples) {
  ImageOptions with, bare;
  with.color = bare.color = ImageColor::intensity;
  with.samples_per_axis = bare.samples_per_axis = samples;
  bare.relief = false;
  std::vector<double> seconds[2];
  for (int round = 0; round < kRounds; ++round) {
    seconds[0].push_back(drawer.measure(cameras, bare));
    seconds[1].push_back(drawer.measure(cameras, with));
  }
  const double bare_s = upper_median_of(seconds[0]), with_s = upper_median_of(seconds[1]);
  std::printf(
      "%d x %d samples per pixel: %.4f s per picture without relief, %.4f s with: %.2f times\n",
      samples, samples, bare_s, with_s, with_s / bare_s);
  return {{"samples_per_axis", samples},
          {"bare_s", bare_s},
          {"relief_s", with_s},
          {"relief_over_bare", with_s / bare_s},
          {"relief_per_s", 1 / with_s}};
}

void run(const bench::Arguments& arguments) {
  const std::string backend = arguments.text("--device", "cpu");
  const Executor executor;
  const SplatModel model = load_model(arguments.input(0));
  const Trajectory poses = load_trajectory(arguments.input(1));
  Drawer drawer(model, backend, executor);
  const bool on_cpu = backend == "cpu";
  const auto cameras = cameras_along(poses, on_cpu ? kCpuPictures : kGpuPictures);
  DeviceOptions chosen;
  if (!on_cpu)
    chosen = {.kind = backend == "optix" ? DeviceKind::optix : DeviceKind::cuda, .gpus = {0}};
  nlohmann::ordered_json result = {
      {"provenance", to_json(provenance_of(executor.threads(), choose_device(chosen)))},
      {"device", backend},
      {"splats", model.size()},
      {"width", 2560},
      {"height", 1440}};
  for (const int samples : {1, 2})
    result["samples_" + std::to_string(samples)] = measure(drawer, cameras, samples);
  if (arguments.has("--json")) write_file(arguments.text("--json"), result.dump(2) + "\n");
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_pictures", [&] {
    adasplats::run({argc, argv,
                    "bench_pictures MODEL TRAJECTORY [--device cpu|cuda|optix] [--json FILE]", 2,
                    2});
  });
}
