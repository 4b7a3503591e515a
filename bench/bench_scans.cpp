// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Rates of scans as users receive them, on the CPU or a GPU:
//   bench_scans MODEL.ply TRAJECTORY [--sensor NAME] [--device cpu|cuda|optix] [--threads N]
//       [--scans N] [--repeats N] [--json FILE]
// Scans per second: hits alone (traced); Scan objects with all attributes (complete); on a GPU also
// batches of some attributes in page-locked memory (host) and on the device, each including the
// wait for the GPU. All alternate in one run; medians, and medians of the ratios to `traced`.
// `plain`: the sensor without extras. `rich`: 7 sub-rays, D = 5, two returns, rain. `rich_objects`:
// the same with a moving sensor among 20 moving cars of 5,000 splats. `traffic`: complete scans of
// a moving sensor among 200 such cars along 500 m, against the same scans without cars.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/session/inputs.h"
#include "common.h"

namespace {

using namespace adasplats;

using Variants = std::vector<std::pair<std::string, std::function<void()>>>;

/// Alternates between the variants; returns their rates, and ratios to the first variant.
nlohmann::ordered_json rates_of(const Variants& variants, std::size_t scans, int repeats) {
  std::map<std::string, std::vector<double>> seconds, ratios;
  for (int repeat = -1; repeat < repeats; ++repeat) {  // the first one warms up
    double first_s = 0;
    for (const auto& [name, call] : variants) {
      const Stopwatch watch;
      call();
      const double call_s = watch.seconds();
      if (first_s == 0) first_s = call_s;
      if (repeat < 0) continue;
      seconds[name].push_back(call_s);
      ratios[name].push_back(first_s / call_s);
    }
  }
  nlohmann::ordered_json json;
  for (const auto& [name, call] : variants) {
    json[name + "_per_s"] = static_cast<double>(scans) / upper_median_of(seconds[name]);
    if (name != variants.front().first)
      json[name + "_over_" + variants.front().first] = upper_median_of(ratios[name]);
  }
  return json;
}

/// Fields for measuring batches.
ScanFields some_fields() {
  ScanFields fields;
  fields.ranges = fields.columns = fields.times = fields.instances = false;
  fields.return_indices = false;
  return fields;
}

nlohmann::ordered_json measure(const ModelScene& scene, const ScanSettings& settings,
                               std::span<const ScanMotion> scans, const Executor& executor,
                               int repeats) {
  ScanSimulator simulator(scene, settings, executor);
  ScanSettings few = settings;
  few.fields = some_fields();
  ScanSimulator some(scene, few, executor);
  const ScanRules& rules = simulator.rules();
  std::size_t returns = 0;
  Variants variants;
  variants.emplace_back("traced", [&] {
    scene.scan_caster().cast(rules.sensor(), rules.cast_firings(), scans, settings.beam.depth,
                             [](std::size_t, std::span<const Hit>) {});
  });
  variants.emplace_back("complete", [&] {
    returns = 0;
    simulator.run(scans, 0, [&](std::size_t, const Scan& scan) { returns += scan.size(); });
  });
  variants.emplace_back("complete_some",
                        [&] { some.run(scans, 0, [](std::size_t, const Scan&) {}); });
  if (scene.on_gpu()) {
    for (const auto memory : {BatchMemory::host, BatchMemory::device})
      variants.emplace_back(memory == BatchMemory::host ? "host" : "device", [&, memory] {
        some.run_batches(scans, 0, memory, [](ScanBatch&&) {});
      });
  }
  nlohmann::ordered_json json = rates_of(variants, scans.size(), repeats);
  json["rays"] = rules.firings().size();
  json["returns"] = static_cast<double>(returns) / static_cast<double>(scans.size());
  return json;
}

/// The scans with a sensor that moves between their poses.
std::vector<ScanMotion> driven_scans(std::span<const ScanMotion> scans, double duration_s) {
  Trajectory poses;
  for (const ScanMotion& scan : scans)
    if (poses.empty() || scan.reference.time_s > poses.back().time_s)
      poses.push_back(scan.reference);
  const std::vector<ScanMotion> once = moving_scans(poses, poses, duration_s);
  std::vector<ScanMotion> driven;
  for (std::size_t i = 0; i < scans.size(); ++i) driven.push_back(once[i % once.size()]);
  return driven;
}

/// 5,000 splats on the sides and the top of a box, below the sensor.
SplatModel car_of_splats() {
  constexpr std::size_t kSplats = 5000;
  constexpr Vec3f kLow = {-2.2F, -0.9F, -1.7F}, kHigh = {2.2F, 0.9F, -0.2F};
  SplatModel car;
  for (std::size_t i = 0; i < kSplats; ++i) {
    Random random(3, 0, i);
    Vec3f at, normal;
    for (int axis = 0; axis < 3; ++axis)
      at[axis] = static_cast<float>(random.uniform(kLow[axis], kHigh[axis]));
    const std::size_t side = i % 5;  // of x twice, of y twice, the top
    const int axis = static_cast<int>(side / 2);
    const bool is_high = side % 2 == 1 || axis == 2;
    at[axis] = is_high ? kHigh[axis] : kLow[axis];
    normal[axis] = is_high ? 1.0F : -1.0F;
    car.disks.push_back({at, 0.1F, normal});
  }
  return car;
}

/// Adds cars of 5,000 splats at most `reach_m` ahead of or behind the sensor, which overtake it or
/// fall behind.
void add_traffic(World& world, std::span<const ScanMotion> scans, std::size_t cars,
                 double reach_m) {
  const std::size_t geometry = world.add_geometry(car_of_splats());
  for (std::size_t k = 0; k < cars; ++k) {
    Random random(4, 0, k);
    const double from_m = random.uniform(-reach_m, reach_m);
    const double to_m = random.uniform(-reach_m, reach_m);
    const double side_m = (k % 2 == 0 ? 3.5 : -3.5) * (k % 4 < 2 ? 1 : 2);
    WorldObject object;
    object.geometry = geometry;
    object.instance = static_cast<std::uint16_t>(k + 1);
    for (const ScanMotion& scan : scans) {
      const TimedPose& at = scan.reference;
      if (!object.trajectory.empty() && at.time_s <= object.trajectory.back().time_s) break;
      const double late = (at.time_s - scans.front().reference.time_s) / 60;
      const Vec3d beside = {from_m + late * (to_m - from_m), side_m, 0};
      object.trajectory.push_back(
          {at.time_s, {at.world_from_sensor.rotation, at.world_from_sensor * beside}});
    }
    world.add_object(std::move(object));
  }
}

/// Complete scans with and without 200 cars, alternating. Adds the cars to `busy`, which is `empty`
/// loaded again.
nlohmann::ordered_json measure_traffic(const ModelScene& empty, ModelScene& busy,
                                       const ScanSettings& settings,
                                       std::span<const ScanMotion> scans, const Executor& executor,
                                       int repeats) {
  constexpr std::size_t kCars = 200;
  constexpr double kReach_m = 250;
  busy.add_objects([&](World& world) { add_traffic(world, scans, kCars, kReach_m); });
  ScanSimulator without(empty, settings, executor), with(busy, settings, executor);
  std::size_t on_cars = 0;
  const auto ignore = [](std::size_t, const Scan&) {};
  const Variants variants = {{"empty", [&] { without.run(scans, 0, ignore); }},
                             {"busy", [&] { with.run(scans, 0, ignore); }}};
  nlohmann::ordered_json json = rates_of(variants, scans.size(), repeats);
  with.run(scans, 0, [&](std::size_t, const Scan& scan) {
    on_cars += static_cast<std::size_t>(
        std::ranges::count_if(scan.instances, [](std::uint16_t id) { return id != 0; }));
  });
  json["cars"] = kCars;
  json["returns_of_cars"] = static_cast<double>(on_cars) / static_cast<double>(scans.size());
  return json;
}

nlohmann::ordered_json measure_all(const bench::Arguments& arguments) {
  const Executor executor(arguments.number("--threads", 0));
  const std::string sensor = arguments.text("--sensor", kDefaultSensor);
  const std::string backend = arguments.text("--device", "cpu");
  const auto count = arguments.number<std::size_t>("--scans", 0);
  const int repeats = arguments.number("--repeats", 5);
  ProgressSink progress;
  DeviceOptions chosen;
  chosen.kind = backend == "cuda"    ? DeviceKind::cuda
                : backend == "optix" ? DeviceKind::optix
                                     : DeviceKind::cpu;
  DeviceChoice device = choose_device(chosen);
  Session session{executor, progress, 1, device};
  ModelScene scene(arguments.input(0), "", session);
  std::vector<ScanMotion> scans = still_scans(load_trajectory(arguments.input(1)));
  for (std::size_t i = 0; scans.size() < count; ++i) scans.push_back(scans[i]);
  if (count > 0) scans.resize(count);
  ScanSettings plain;
  plain.sensor = load_lidar_model(sensor);
  ScanSettings rich = plain;
  if (!scene.has_opacities()) rich.beam.depth = 5;
  rich.beam.sub_rays = 7;
  rich.beam.returns = 2;
  rich.weather.rain_mm_h = 10;
  if (rich.sensor.divergence_rad[0] + rich.sensor.divergence_rad[1] == 0)
    rich.sensor.divergence_rad[0] = rich.sensor.divergence_rad[1] = 2e-3;
  nlohmann::ordered_json json;
  json["provenance"] = to_json(provenance_of(executor.threads(), device));
  json["splats"] = scene.view().primitive_count();
  json["sensor"] = sensor;
  json["device"] = backend;
  json["threads"] = executor.threads();
  json["scans"] = scans.size();
  json["plain"] = measure(scene, plain, scans, executor, repeats);
  const auto some = std::span(scans).first(
      std::min<std::size_t>(scans.size(), scene.on_gpu() ? scans.size() : 8));
  json["rich"] = measure(scene, rich, some, executor, repeats);
  // The objects move with time, which starts at the first scan.
  const std::vector<ScanMotion> driven = driven_scans(some, 1 / rich.sensor.rotation_hz);
  ModelScene busy(arguments.input(0), "", session);
  json["traffic"] = measure_traffic(scene, busy, plain, driven, executor, repeats);
  constexpr std::size_t kCars = 20;
  constexpr double kReach_m = 40;
  scene.add_objects([&](World& world) { add_traffic(world, driven, kCars, kReach_m); });
  json["rich_objects"] = measure(scene, rich, driven, executor, repeats);
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  return bench::exit_code_of("bench_scans", [&] {
    const bench::Arguments arguments(
        argc, argv,
        "bench_scans MODEL.ply TRAJECTORY [--sensor NAME] [--device cpu|cuda|optix] [--threads N] "
        "[--scans N] [--repeats N] [--json FILE]",
        2, 2);
    bench::print_and_write(measure_all(arguments), arguments.text("--json"));
  });
}
