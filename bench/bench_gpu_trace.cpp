// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Scans and pictures of a splat model on GPUs:
//   bench_gpu_trace MODEL.ply TRAJECTORY [--backend cuda|optix] [--gpus 0,1] [--quick] [--json
//   FILE]
// Every figure is the median of several runs after a warm-up. The hits of one scan are compared
// with those of the CPU. --quick omits pictures.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/trace/tracer.h"
#include "common.h"

namespace {

using namespace adasplats;

/// Median seconds of `runs` calls after a warm-up call.
template <class F>
double median_seconds(int runs, const F& call) {
  call();
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const Stopwatch watch;
    call();
    seconds.push_back(watch.seconds());
  }
  return upper_median_of(seconds);
}

std::vector<int> gpus_of(const std::string& list) {
  std::vector<int> gpus;
  for (std::size_t at = 0; at < list.size(); at += 2) gpus.push_back(list[at] - '0');
  return gpus;
}

/// Scans spread over the trajectory, repeated if there are fewer poses.
std::vector<ScanMotion> scans_for(const Trajectory& trajectory, std::size_t count) {
  std::vector<ScanMotion> poses;
  const std::size_t step = std::max<std::size_t>(1, trajectory.size() / 64);
  for (std::size_t i = 0; i < count; ++i)
    poses.push_back({trajectory[i * step % trajectory.size()], {}});
  return poses;
}

/// Compares one scan with the CPU's: the number of different hits, and the largest difference in
/// range of rays that hit in both.
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

/// Scans one at a time, with the hits on the host.
void measure_single(GpuScanner& scanner, const std::vector<ScanMotion>& poses,
                    nlohmann::ordered_json& json) {
  std::vector<double> seconds;
  for (std::size_t i = 0; i < 320; ++i) {
    const Stopwatch watch;
    scanner.scan(poses[i % 64]);
    if (i >= 64) seconds.push_back(watch.seconds());
  }
  double sum = 0;
  for (const double s : seconds) sum += s;
  json["single_per_s"] = static_cast<double>(seconds.size()) / sum;
  // The same launches without waiting for each: the time of the kernel.
  const double kernel_s = median_seconds(5, [&] {
    DeviceHits last;
    for (std::size_t i = 0; i < 64; ++i) last = scanner.cast_on_device({&poses[i], 1});
    wait_for(last);
  });
  json["single_kernel_per_s"] = 64 / kernel_s;
}

/// Batches of scans, with the hits or points on the host.
void measure_batches(GpuScanner& scanner, const std::vector<ScanMotion>& poses,
                     nlohmann::ordered_json& json) {
  std::size_t hits = 0;
  const auto count = [&](std::size_t, std::span<const Hit> scan) { hits += scan[0].valid(); };
  const double seconds = median_seconds(5, [&] { scanner.cast(poses, 1, count); });
  json["batched_per_s"] = static_cast<double>(poses.size()) / seconds;
  const auto count_points = [&](std::size_t, std::span<const PointHit> scan) {
    hits += scan[0].primitive != Hit::kNone;
  };
  const double point_seconds = median_seconds(5, [&] { scanner.cast_points(poses, count_points); });
  json["batched_points_per_s"] = static_cast<double>(poses.size()) / point_seconds;
}

/// Batches of scans with hits that stay on the device, nearest and nearest 5.
void measure_on_device(GpuScanner& scanner, const std::vector<ScanMotion>& poses,
                       nlohmann::ordered_json& json) {
  const std::span<const ScanMotion> some(poses.data(), 64);
  const auto seconds_per_scan = [&](int depth) {
    std::vector<double> seconds;
    for (int run = 0; run < 7; ++run) {
      const Stopwatch watch;
      const DeviceHits kept = scanner.cast_on_device(some, depth);
      wait_for(kept);
      if (run > 0) seconds.push_back(watch.seconds());  // the first run warms up
    }
    return upper_median_of(seconds) / 64;
  };
  const double nearest_s = seconds_per_scan(1), five_s = seconds_per_scan(5);
  json["on_device_per_s"] = 1 / nearest_s;
  json["d5_on_device_per_s"] = 1 / five_s;
  json["d5_over_nearest"] = five_s / nearest_s;
}

void measure_pictures(const GpuScene& scene, const SplatModel& model,
                      const std::vector<ScanMotion>& poses, nlohmann::ordered_json& json) {
  ImageScene image_scene;
  image_scene.view = model.view();
  image_scene.attributes.classes = model.classes;
  image_scene.attributes.intensities = model.intensities;
  image_scene.groups = model.groups;
  image_scene.origin = model.origin;
  const auto renderer = scene.renderer(image_scene, ImageOptions{});
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

nlohmann::ordered_json measure_all(const bench::Arguments& arguments) {
  const bool is_optix = arguments.text("--backend") == "optix";
  const std::vector<int> gpus = gpus_of(arguments.text("--gpus", "0"));
  const SplatModel model = load_model(arguments.input(0));
  const Trajectory trajectory = read_trajectory(arguments.input(1));
  const auto scene = make_gpu_scene(model.view(), model.origin,
                                    is_optix ? TracingBackend::optix : TracingBackend::cuda, gpus);
  const LidarModel sensor = hdl_64_paper();
  const std::vector<Firing> firings = firings_of(sensor);
  const auto scanner = scene->scanner(sensor, firings);

  nlohmann::ordered_json json;
  const GpuSearch search = find_gpus();
  const DeviceOptions chosen = {.kind = is_optix ? DeviceKind::optix : DeviceKind::cuda,
                                .gpus = gpus};
  json["provenance"] = to_json(provenance_of(Executor().threads(), choose_device(chosen)));
  json["device"] = search.devices.front().name;
  json["cuda_of_driver"] = search.driver;
  json["backend"] = scene->name();
  json["gpus"] = gpus.size();
  json["splats"] = model.size();
  json["build_s"] = scene->build_seconds();
  compare_with_cpu(model, *scanner, sensor, firings, trajectory[trajectory.size() / 2], json);
  const auto poses = scans_for(trajectory, 1024 * gpus.size());
  measure_single(*scanner, poses, json);
  measure_batches(*scanner, poses, json);
  measure_on_device(*scanner, poses, json);
  if (!arguments.has("--quick")) measure_pictures(*scene, model, poses, json);
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  return bench::exit_code_of("bench_gpu_trace", [&] {
    const bench::Arguments arguments(argc, argv,
                                     "bench_gpu_trace MODEL.ply TRAJECTORY [--backend cuda|optix] "
                                     "[--gpus 0,1] [--quick] [--json FILE]",
                                     2, 2);
    bench::print_and_write(measure_all(arguments), arguments.text("--json"));
  });
}
