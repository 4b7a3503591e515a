// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Driving through a city whose tiles come and go, as figures of bench/results:
//   bench_city CITY TRAJECTORY [--sensor NAME] [--device cpu|cuda] [--threads N] [--spacing M]
//       [--passes N] [--tile-memory GB] [--scans N] [--check STEP] [--json FILE]
// A drive along TRAJECTORY, a scan every `spacing` metres, `passes` times. Each figure is of a
// scene that begins with no tile in memory, loading included: complete scans in host memory
// (`complete`), on a GPU also batches in page-locked memory (`host`) and on the device (`device`).
// `scans` bounds how many. Then every STEP-th scan again, tile by tile and in the whole city in
// memory: whether all their bytes are the same.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/memory.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/scene/city_scene.h"
#include "adasplats/jobs/scene/drive.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"

namespace {

using namespace adasplats;
using Json = nlohmann::ordered_json;

struct Arguments {
  std::string city, trajectory, json, sensor = kDefaultSensor, device = "cpu";
  int threads = 0;
  double spacing_m = 0.5, tile_memory_gb = 1;
  std::size_t passes = 1, scans = 0, check = 0;
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
    } else if (word == "--spacing") {
      arguments.spacing_m = std::stod(value());
    } else if (word == "--passes") {
      arguments.passes = std::stoul(value());
    } else if (word == "--tile-memory") {
      arguments.tile_memory_gb = std::stod(value());
    } else if (word == "--scans") {
      arguments.scans = std::stoul(value());
    } else if (word == "--check") {
      arguments.check = std::stoul(value());
    } else if (word == "--json") {
      arguments.json = value();
    } else {
      inputs.push_back(word);
    }
  }
  if (inputs.size() != 2) {
    std::fprintf(stderr,
                 "usage: bench_city CITY TRAJECTORY [--sensor NAME] [--device cpu|cuda] [--threads "
                 "N] [--spacing M] [--passes N] [--tile-memory GB] [--scans N] [--check STEP] "
                 "[--json FILE]\n");
    std::exit(64);
  }
  arguments.city = inputs[0];
  arguments.trajectory = inputs[1];
  return arguments;
}

std::vector<ScanMotion> scans_of(const Arguments& arguments, const LidarModel& sensor,
                                 ProgressSink& progress) {
  DriveOptions drive;
  drive.trajectory = arguments.trajectory;
  drive.spacing_m = arguments.spacing_m;
  const std::vector<ScanMotion> once = scans_along(drive, sensor, progress);
  std::vector<ScanMotion> scans;
  for (std::size_t pass = 0; pass < arguments.passes; ++pass) {
    scans.insert(scans.end(), once.begin(), once.end());
    if (pass % 2 == 1) std::ranges::reverse(std::span(scans).last(once.size()));  // and back
  }
  if (arguments.scans > 0 && arguments.scans < scans.size()) scans.resize(arguments.scans);
  return scans;
}

/// The whole drive in a scene of its own; gives rates and what was loaded.
template <class Run>
Json streamed(const Arguments& arguments, const ScanSettings& settings,
              std::span<const ScanMotion> scans, Session& session, Run&& run) {
  const Stopwatch watch;
  const CityScene scene(arguments.city, "", session,
                        static_cast<std::size_t>(arguments.tile_memory_gb * 1e9));
  ScanSimulator simulator(scene, settings, session.executor);
  const double opened_s = watch.seconds();
  std::size_t returns = 0;
  const ReportTimes times = run(simulator, returns);
  const double seconds = watch.seconds();
  const TileStreamCounts counts = scene.counts();
  return {{"scans_per_s", static_cast<double>(scans.size()) / seconds},
          {"seconds", seconds},
          {"opened_s", opened_s},
          {"traced_per_s", static_cast<double>(scans.size()) / times.traced_s},
          {"returns", returns},
          {"tiles_loaded", counts.loaded},
          {"tiles_most_bytes", counts.max_bytes},
          {"waited_s", counts.waited_s},
          {"peak_memory_bytes", peak_memory_bytes()}};
}

std::string digest_in(const ScanScene& scene, const ScanSettings& settings,
                      std::span<const ScanMotion> scans, const Executor& executor) {
  ScanSimulator simulator(scene, settings, executor);
  Sha256 hash;
  simulator.run(scans, 0, [&](std::size_t, const Scan& scan) {
    const auto add = [&](const auto& values) {
      hash.add(values.data(), values.size() * sizeof(values[0]));
    };
    add(scan.positions);
    add(scan.ranges_m);
    for_each_scan_attribute([&](const auto& attribute) { add(attribute.of(scan)); });
  });
  return hash.digest();
}

Json checked(const Arguments& arguments, const ScanSettings& settings,
             std::span<const ScanMotion> scans, Session& session) {
  std::vector<ScanMotion> some;
  for (std::size_t i = 0; i < scans.size(); i += arguments.check) some.push_back(scans[i]);
  const CityScene tiles(arguments.city, "", session,
                        static_cast<std::size_t>(arguments.tile_memory_gb * 1e9));
  const std::string in_tiles = digest_in(tiles, settings, some, session.executor);
  const ModelScene whole(arguments.city, "", session);
  const std::string in_whole = digest_in(whole, settings, some, session.executor);
  return {{"scans", some.size()}, {"same_bytes", in_tiles == in_whole}, {"sha256", in_whole}};
}

Json measure_all(const Arguments& arguments) {
  const Executor executor(arguments.threads);
  ProgressSink progress;
  DeviceOptions chosen;
  chosen.kind = arguments.device == "cuda" ? DeviceKind::cuda : DeviceKind::cpu;
  DeviceChoice device = choose_device(chosen);
  Session session{executor, progress, 1, device};
  ScanSettings settings;
  settings.sensor = load_lidar_model(arguments.sensor);
  const std::vector<ScanMotion> scans = scans_of(arguments, settings.sensor, progress);
  const CityManifest city = load_city_manifest(arguments.city);
  Json json;
  json["provenance"] = to_json(provenance_of(executor.threads(), device));
  json["device"] = arguments.device;
  json["threads"] = executor.threads();
  json["sensor"] = arguments.sensor;
  json["points"] = city.points();
  json["splats"] = city.splats();
  json["tiles"] = city.tiles.size();
  json["tile_m"] = city.grid.side_m;
  json["tile_memory_gb"] = arguments.tile_memory_gb;
  json["scans"] = scans.size();
  json["driven_m"] = static_cast<double>(scans.size()) * arguments.spacing_m;
  json["complete"] = streamed(
      arguments, settings, scans, session, [&](ScanSimulator& simulator, std::size_t& returns) {
        return simulator.run(scans, 0,
                             [&](std::size_t, const Scan& scan) { returns += scan.size(); });
      });
  if (device.on_gpu()) {
    for (const auto results : {BatchMemory::host, BatchMemory::device}) {
      const bool on_host = results == BatchMemory::host;
      json[on_host ? "host" : "device"] = streamed(
          arguments, settings, scans, session, [&](ScanSimulator& simulator, std::size_t& returns) {
            return simulator.run_batches(scans, 0, results,
                                         [&](ScanBatch&& batch) { returns += batch.returns(); });
          });
    }
  }
  if (arguments.check > 0) json["check"] = checked(arguments, settings, scans, session);
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = parse(argc, argv);
    const std::string text = measure_all(arguments).dump(2) + "\n";
    std::fputs(text.c_str(), stdout);
    if (!arguments.json.empty()) std::ofstream(arguments.json) << text;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_city: %s\n", error.what());
    return 1;
  }
}
