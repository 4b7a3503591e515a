// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// What a picture of 2560 x 1440 pixels costs from poses of a drive, with relief and bare (each
// sample its own colour, as pictures were before), by turns in one run.
//   bench_pictures MODEL TRAJECTORY [--device cpu|cuda|optix] [--json FILE]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/maths/median.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/session/device_choice.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {
namespace {

constexpr int kRounds = 7;
constexpr std::size_t kCpuPictures = 2, kGpuPictures = 200;

struct Options {
  std::string model, trajectory, device = "cpu", json;
};

/// Draws all cameras' pictures, by a GPU as many at once as it likes.
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

  /// Seconds a picture.
  double measure(const std::vector<Camera>& cameras, const ImageOptions& options) {
    const auto renderer = engine_->renderer(scene_, options);
    const auto start = std::chrono::steady_clock::now();
    renderer->render_all(cameras, [&](std::size_t, std::span<const std::uint8_t> pixels) {
      bytes_ += pixels.size();
    });
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return seconds.count() / static_cast<double>(cameras.size());
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
  std::printf("%d x %d samples a pixel: %.4f s a picture bare, %.4f s with relief: %.2f times\n",
              samples, samples, bare_s, with_s, with_s / bare_s);
  return {{"samples_per_axis", samples},
          {"bare_s", bare_s},
          {"relief_s", with_s},
          {"relief_over_bare", with_s / bare_s},
          {"relief_per_s", 1 / with_s}};
}

void run(const Options& options) {
  const Executor executor;
  const SplatModel model = load_model(options.model);
  const Trajectory poses = load_trajectory(options.trajectory);
  Drawer drawer(model, options.device, executor);
  const bool on_cpu = options.device == "cpu";
  const auto cameras = cameras_along(poses, on_cpu ? kCpuPictures : kGpuPictures);
  DeviceOptions chosen;
  if (!on_cpu)
    chosen = {.kind = options.device == "optix" ? DeviceKind::optix : DeviceKind::cuda,
              .gpus = {0}};
  nlohmann::ordered_json result = {
      {"provenance", to_json(provenance_of(executor.threads(), choose_device(chosen)))},
      {"device", options.device},
      {"splats", model.size()},
      {"width", 2560},
      {"height", 1440}};
  for (const int samples : {1, 2})
    result["samples_" + std::to_string(samples)] = measure(drawer, cameras, samples);
  if (!options.json.empty()) write_file(options.json, result.dump(2) + "\n");
}

Options parse(int argc, char** argv) {
  Options options;
  std::vector<std::string> inputs;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      inputs.push_back(word);
      continue;
    }
    if (i + 1 >= argc) throw std::runtime_error(word + " needs a value");
    if (word == "--json") {
      options.json = argv[++i];
    } else if (word == "--device") {
      options.device = argv[++i];
    } else {
      throw std::runtime_error(word + " is unknown");
    }
  }
  if (inputs.size() != 2) throw std::runtime_error("usage: bench_pictures MODEL TRAJECTORY");
  options.model = inputs[0];
  options.trajectory = inputs[1];
  return options;
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) try {
  adasplats::run(adasplats::parse(argc, argv));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_pictures: %s\n", error.what());
  return 1;
}
