// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// What a user gets of the scans that are traced, on the CPU or a GPU, as figures of bench/results:
//   bench_scans MODEL.ply TRAJECTORY [--sensor NAME] [--device cpu|cuda|optix] [--threads N]
//       [--scans N] [--repeats N] [--plain] [--unit FILE] [--json FILE]
// Rates of scans a second: hits alone (traced); Scan objects with all their attributes (complete);
// on a GPU also batches of some attributes in page-locked memory (host) and on the device, waited
// for. By turns in one run; medians, and medians of the ratios to `traced`. `plain`: the sensor as
// it is. `rich`: 7 sub-rays, D = 5, two returns, rain. `rich_objects`: the same from a sensor that
// moves among 20 moving cars of 5,000 splats. `unit`: scans with all that a file of fit-sensor says
// of a unit, and without it (`with_over_without`), complete and, on a GPU, batches on the device.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/session/inputs.h"

namespace {

using namespace adasplats;

struct Arguments {
  std::string model, trajectory, json, unit, sensor = kDefaultSensor, device = "cpu";
  int threads = 0;
  std::size_t scans = 0;
  int repeats = 5;
  bool plain = false;  ///< that alone
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  std::vector<std::string> inputs;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] { return i + 1 < argc ? std::string(argv[++i]) : std::string(); };
    if (word == "--sensor") {
      arguments.sensor = value();
    } else if (word == "--device") {
      arguments.device = value();
    } else if (word == "--threads") {
      arguments.threads = std::stoi(value());
    } else if (word == "--scans") {
      arguments.scans = std::stoul(value());
    } else if (word == "--repeats") {
      arguments.repeats = std::stoi(value());
    } else if (word == "--unit") {
      arguments.unit = value();
    } else if (word == "--plain") {
      arguments.plain = true;
    } else if (word == "--json") {
      arguments.json = value();
    } else {
      inputs.push_back(word);
    }
  }
  if (inputs.size() != 2) {
    std::fprintf(stderr,
                 "usage: bench_scans MODEL.ply TRAJECTORY [--sensor NAME] [--device "
                 "cpu|cuda|optix] [--threads N] [--scans N] [--repeats N] [--plain] "
                 "[--unit FILE] [--json FILE]\n");
    std::exit(64);
  }
  arguments.model = inputs[0];
  arguments.trajectory = inputs[1];
  return arguments;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

using Ways = std::vector<std::pair<std::string, std::function<void()>>>;

/// Calls every way by turns; rates of `scans`, and ratios to the first way's.
nlohmann::ordered_json rates_of(const Ways& ways, std::size_t scans, int repeats) {
  std::map<std::string, std::vector<double>> seconds, ratios;
  for (int repeat = -1; repeat < repeats; ++repeat) {  // the first one warms up
    double first_s = 0;
    for (const auto& [name, call] : ways) {
      const Stopwatch watch;
      call();
      const double took_s = watch.seconds();
      if (first_s == 0) first_s = took_s;
      if (repeat < 0) continue;
      seconds[name].push_back(took_s);
      ratios[name].push_back(first_s / took_s);
    }
  }
  nlohmann::ordered_json json;
  for (const auto& [name, call] : ways) {
    json[name + "_per_s"] = static_cast<double>(scans) / median(seconds[name]);
    if (name != ways.front().first)
      json[name + "_over_" + ways.front().first] = median(ratios[name]);
  }
  return json;
}

/// What the speed of batches is measured with.
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
  Ways ways;
  ways.emplace_back("traced", [&] {
    scene.scan_caster().cast(rules.sensor(), rules.cast_firings(), scans, settings.beam.depth,
                             [](std::size_t, std::span<const Hit>) {});
  });
  ways.emplace_back("complete", [&] {
    returns = 0;
    simulator.run(scans, 0, [&](std::size_t, const Scan& scan) { returns += scan.size(); });
  });
  ways.emplace_back("complete_some", [&] { some.run(scans, 0, [](std::size_t, const Scan&) {}); });
  if (scene.on_gpu()) {
    for (const auto memory : {BatchMemory::host, BatchMemory::device})
      ways.emplace_back(memory == BatchMemory::host ? "host" : "device",
                        [&, memory] { some.run_batches(scans, 0, memory, [](ScanBatch&&) {}); });
  }
  nlohmann::ordered_json json = rates_of(ways, scans.size(), repeats);
  json["rays"] = rules.firings().size();
  json["returns"] = static_cast<double>(returns) / static_cast<double>(scans.size());
  return json;
}

/// What a unit costs: scans of it, and of the same sensor without what is the unit's.
nlohmann::ordered_json measure_unit_cost(const ModelScene& scene, const std::string& file,
                                         std::span<const ScanMotion> scans,
                                         const Executor& executor, int repeats) {
  ScanChoice choice;
  choice.sensor = file;
  ScanSettings with = choice.settings(1);
  ScanSettings without = with;
  without.ray_drop.reset();
  without.sensor.drop.reset();
  without.sensor.body.reset();
  without.sensor.fields.reset();
  without.sensor.intensity.reset();
  without.sensor.ring_noise_m.clear();
  ScanSimulator plain(scene, without, executor), unit(scene, with, executor);
  const auto complete = [&](ScanSimulator& simulator) {
    return [&] { simulator.run(scans, 0, [](std::size_t, const Scan&) {}); };
  };
  nlohmann::ordered_json json;
  json["complete"] =
      rates_of({{"without", complete(plain)}, {"with", complete(unit)}}, scans.size(), repeats);
  if (!scene.on_gpu()) return json;
  const auto device = [&](ScanSimulator& simulator) {
    return [&] { simulator.run_batches(scans, 0, BatchMemory::device, [](ScanBatch&&) {}); };
  };
  json["device"] =
      rates_of({{"without", device(plain)}, {"with", device(unit)}}, scans.size(), repeats);
  return json;
}

constexpr std::size_t kCars = 20;

/// The scans with the motion of the sensor between their poses.
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

/// Cars of 5,000 splats that keep within 40 m of the sensor and overtake it or fall behind.
void add_traffic(World& world, std::span<const ScanMotion> scans) {
  constexpr std::size_t kSplats = 5000;
  SplatModel car;
  for (std::size_t i = 0; i < kSplats; ++i) {
    Random random(3, 0, i);
    const Vec3f at = {static_cast<float>(random.uniform(-2.2, 2.2)),
                      static_cast<float>(random.uniform(-0.9, 0.9)),
                      static_cast<float>(random.uniform(-1.7, -0.2))};
    car.disks.push_back({at, 0.14F, normalized(at)});
  }
  const std::size_t geometry = world.add_geometry(std::move(car));
  for (std::size_t k = 0; k < kCars; ++k) {
    Random random(4, 0, k);
    const double from_m = random.uniform(-40, 40), to_m = random.uniform(-40, 40);
    const double side_m = k % 2 == 0 ? 3.5 : -3.5;
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

nlohmann::ordered_json measure_all(const Arguments& arguments) {
  const Executor executor(arguments.threads);
  ProgressSink progress;
  DeviceOptions chosen;
  chosen.kind = arguments.device == "cuda"    ? DeviceKind::cuda
                : arguments.device == "optix" ? DeviceKind::optix
                                              : DeviceKind::cpu;
  DeviceChoice device = choose_device(chosen);
  Session session{executor, progress, 1, device};
  ModelScene scene(arguments.model, "", session);
  std::vector<ScanMotion> scans = still_scans(load_trajectory(arguments.trajectory));
  for (std::size_t i = 0; scans.size() < arguments.scans; ++i) scans.push_back(scans[i]);
  if (arguments.scans > 0) scans.resize(arguments.scans);
  ScanSettings plain;
  plain.sensor = load_lidar_model(arguments.sensor);
  ScanSettings rich = plain;
  rich.beam.depth = 5;
  rich.beam.sub_rays = 7;
  rich.beam.returns = 2;
  rich.weather.rain_mm_h = 10;
  if (rich.sensor.divergence_rad[0] + rich.sensor.divergence_rad[1] == 0)
    rich.sensor.divergence_rad[0] = rich.sensor.divergence_rad[1] = 2e-3;
  nlohmann::ordered_json json;
  json["provenance"] = to_json(provenance_of(executor.threads(), device));
  json["splats"] = scene.view().primitive_count();
  json["sensor"] = arguments.sensor;
  json["device"] = arguments.device;
  json["threads"] = executor.threads();
  json["scans"] = scans.size();
  if (!arguments.unit.empty())
    json["unit"] = measure_unit_cost(scene, arguments.unit, scans, executor, arguments.repeats);
  json["plain"] = measure(scene, plain, scans, executor, arguments.repeats);
  if (arguments.plain) return json;
  const auto some = std::span(scans).first(
      std::min<std::size_t>(scans.size(), scene.on_gpu() ? scans.size() : 8));
  json["rich"] = measure(scene, rich, some, executor, arguments.repeats);
  // Where sensors move, so do objects; their first scan names the time.
  const std::vector<ScanMotion> driven = driven_scans(some, 1 / rich.sensor.rotation_hz);
  scene.add_objects([&](World& world) { add_traffic(world, driven); });
  json["rich_objects"] = measure(scene, rich, driven, executor, arguments.repeats);
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = parse(argc, argv);
    const std::string text = measure_all(arguments).dump(2);
    std::printf("%s\n", text.c_str());
    if (!arguments.json.empty()) std::ofstream(arguments.json) << text << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_scans: %s\n", error.what());
    return 1;
  }
}
