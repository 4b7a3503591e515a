// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Scans and pictures of a splat model on GPUs, as figures of bench/results:
//   bench_gpu_trace MODEL.ply TRAJECTORY [--backend cuda|optix] [--gpus 0,1] [--json FILE]
// Every figure is the median of several runs after a warm-up. Hits of the first scan are compared
// with the CPU's.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/trace/tracer.h"

namespace {

using namespace adasplats;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Median seconds of `runs` calls after one that does not count.
template <class F>
double median_seconds(int runs, const F& call) {
  call();
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const auto start = Clock::now();
    call();
    seconds.push_back(seconds_since(start));
  }
  return median(seconds);
}

struct Arguments {
  std::string model, trajectory, json;
  TracingBackend backend = TracingBackend::cuda;
  std::vector<int> gpus = {0};
  bool quick = false;  ///< scans alone
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  std::vector<std::string> inputs;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] { return i + 1 < argc ? std::string(argv[++i]) : std::string(); };
    if (word == "--backend") {
      arguments.backend = value() == "optix" ? TracingBackend::optix : TracingBackend::cuda;
    } else if (word == "--gpus") {
      arguments.gpus.clear();
      const std::string list = value();
      for (std::size_t at = 0; at < list.size(); at += 2) arguments.gpus.push_back(list[at] - '0');
    } else if (word == "--json") {
      arguments.json = value();
    } else if (word == "--quick") {
      arguments.quick = true;
    } else {
      inputs.push_back(word);
    }
  }
  if (inputs.size() != 2) {
    std::fprintf(stderr,
                 "usage: bench_gpu_trace MODEL.ply TRAJECTORY [--backend cuda|optix] "
                 "[--gpus 0,1] [--quick] [--json FILE]\n");
    std::exit(64);
  }
  arguments.model = inputs[0];
  arguments.trajectory = inputs[1];
  return arguments;
}

/// Scans spread over the trajectory, again from its start where there are fewer.
std::vector<ScanMotion> scans_for(const Trajectory& trajectory, std::size_t count) {
  std::vector<ScanMotion> poses;
  const std::size_t step = std::max<std::size_t>(1, trajectory.size() / 64);
  for (std::size_t i = 0; i < count; ++i)
    poses.push_back({trajectory[i * step % trajectory.size()], {}});
  return poses;
}

/// How many hits of one scan differ from the CPU's, and the largest difference in range of those
/// that both have.
void compare_with_cpu(const SplatModel& model, GpuScanner& scanner, const LidarModel& sensor,
                      const std::vector<Firing>& firings, const TimedPose& pose,
                      nlohmann::ordered_json& json) {
  const Executor executor;
  const auto tracer = make_cpu_tracer(model.view(), executor);
  const auto rays = scan_rays(sensor, firings, {pose, {}}, model.origin, executor);
  std::vector<Hit> expected(rays.size());
  tracer->nearest(rays, expected, executor);
  const auto hits = scanner.scan({pose, {}});
  std::size_t differ = 0, found = 0;
  double largest_m = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    found += hits[i].valid();
    if (hits[i] == expected[i]) continue;
    ++differ;
    if (hits[i].valid() && expected[i].valid())
      largest_m = std::max(largest_m, std::fabs(double(hits[i].t) - double(expected[i].t)));
  }
  json["rays"] = hits.size();
  json["rays_hit"] = found;
  json["rays_that_differ_from_cpu"] = differ;
  json["largest_range_difference_m"] = largest_m;
}

}  // namespace

int main(int argc, char** argv) try {
  const Arguments arguments = parse(argc, argv);
  const SplatModel model = load_model(arguments.model);
  const Trajectory trajectory = read_trajectory(arguments.trajectory);
  const auto scene = make_gpu_scene(model.view(), model.origin, arguments.backend, arguments.gpus);
  const LidarModel sensor = hdl_64_paper();
  const std::vector<Firing> firings = firings_of(sensor);
  const auto scanner = scene->scanner(sensor, firings);

  nlohmann::ordered_json json;
  const GpuSearch search = find_gpus();
  const DeviceOptions chosen = {
      .kind = arguments.backend == TracingBackend::optix ? DeviceKind::optix : DeviceKind::cuda,
      .gpus = arguments.gpus};
  json["provenance"] = to_json(provenance_of(Executor().threads(), choose_device(chosen)));
  json["device"] = search.devices.front().name;
  json["cuda_of_driver"] = search.driver;
  json["backend"] = scene->name();
  json["gpus"] = arguments.gpus.size();
  json["splats"] = model.size();
  json["build_s"] = scene->build_seconds();
  compare_with_cpu(model, *scanner, sensor, firings, trajectory[trajectory.size() / 2], json);

  const auto poses = scans_for(trajectory, 1024 * arguments.gpus.size());
  {
    std::vector<double> seconds;
    for (std::size_t i = 0; i < 320; ++i) {
      const auto start = Clock::now();
      scanner->scan(poses[i % 64]);
      if (i >= 64) seconds.push_back(seconds_since(start));
    }
    double sum = 0;
    for (const double s : seconds) sum += s;
    json["single_per_s"] = static_cast<double>(seconds.size()) / sum;
    // The same launches without anybody waiting for each: what the kernel alone takes.
    const double kernel_s = median_seconds(5, [&] {
      DeviceHits last;
      for (std::size_t i = 0; i < 64; ++i) last = scanner->cast_on_device({&poses[i], 1});
      wait_for(last);
    });
    json["single_kernel_per_s"] = 64 / kernel_s;
  }
  {
    std::size_t hits = 0;
    const auto count = [&](std::size_t, std::span<const Hit> scan) { hits += scan[0].valid(); };
    const double seconds = median_seconds(5, [&] { scanner->cast(poses, 1, count); });
    json["batched_per_s"] = static_cast<double>(poses.size()) / seconds;
    const auto count_points = [&](std::size_t, std::span<const PointHit> scan) {
      hits += scan[0].primitive != Hit::kNone;
    };
    const double point_seconds =
        median_seconds(5, [&] { scanner->cast_points(poses, count_points); });
    json["batched_points_per_s"] = static_cast<double>(poses.size()) / point_seconds;
  }
  const auto on_device_s = [&](int depth) {
    const std::span<const ScanMotion> some(poses.data(), 64);
    std::vector<double> seconds;
    for (int run = 0; run < 7; ++run) {
      const auto start = Clock::now();
      const DeviceHits kept = scanner->cast_on_device(some, depth);
      wait_for(kept);
      if (run > 0) seconds.push_back(seconds_since(start));
    }
    return median(seconds) / 64;
  };
  const double nearest_s = on_device_s(1), five_s = on_device_s(5);
  json["on_device_per_s"] = 1 / nearest_s;
  json["d5_on_device_per_s"] = 1 / five_s;
  json["d5_over_nearest"] = five_s / nearest_s;

  if (!arguments.quick) {
    ImageScene image_scene;
    image_scene.view = model.view();
    image_scene.attributes.classes = model.classes;
    image_scene.attributes.intensities = model.intensities;
    image_scene.groups = model.groups;
    image_scene.origin = model.origin;
    ImageOptions options;
    const auto renderer = scene->renderer(image_scene, options);
    std::vector<Camera> cameras;
    for (std::size_t i = 0; i < 200; ++i) {
      const TimedPose& pose = poses[i % 64].reference;
      const Vec3d eye = pose.world_from_sensor.translation;
      Camera camera = look_at(eye, pose.world_from_sensor * Vec3d{10, 0, -0.5});
      camera.width = 2560;
      camera.height = 1440;
      cameras.push_back(camera);
    }
    std::size_t bytes = 0;
    const double seconds = median_seconds(3, [&] {
      renderer->render_all(cameras, [&](std::size_t, std::span<const std::uint8_t> pixels) {
        bytes += pixels.size();
      });
    });
    json["render_1440p_per_s"] = static_cast<double>(cameras.size()) / seconds;
  }
  std::printf("%s\n", json.dump(2).c_str());
  if (!arguments.json.empty()) std::ofstream(arguments.json) << json.dump(2) << "\n";
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_gpu_trace: %s\n", error.what());
  return 1;
}
