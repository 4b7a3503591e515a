// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// A drive through a city with streamed tiles:
//   bench_city CITY TRAJECTORY [--sensor NAME] [--device cpu|cuda] [--threads N] [--spacing M]
//       [--passes N] [--tile-memory GB] [--scans N] [--check STEP] [--json FILE]
// Drives along TRAJECTORY `passes` times with a scan every `spacing` metres, at most `scans` in
// all. Each figure includes loading and starts with no tile in memory: complete scans in host
// memory
// (`complete`); on a GPU also batches in page-locked memory (`host`) and on the device (`device`).
// Then compares the bytes of every STEP-th scan with streamed tiles and with the entire city in
// memory.
#include <algorithm>
#include <cstdio>
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
#include "common.h"

namespace {

using namespace adasplats;
using Json = nlohmann::ordered_json;

constexpr double kDefaultSpacing_m = 0.5, kDefaultTileMemory_gb = 1;

std::size_t tile_memory_bytes(const bench::Arguments& arguments) {
  return static_cast<std::size_t>(arguments.number("--tile-memory", kDefaultTileMemory_gb) * 1e9);
}

std::vector<ScanMotion> scans_of(const bench::Arguments& arguments, const LidarModel& sensor,
                                 ProgressSink& progress) {
  DriveOptions drive;
  drive.trajectory = arguments.input(1);
  drive.spacing_m = arguments.number("--spacing", kDefaultSpacing_m);
  const std::vector<ScanMotion> once = scans_along(drive, sensor, progress);
  std::vector<ScanMotion> scans;
  const auto passes = arguments.number<std::size_t>("--passes", 1);
  for (std::size_t pass = 0; pass < passes; ++pass) {
    scans.insert(scans.end(), once.begin(), once.end());
    if (pass % 2 == 1) std::ranges::reverse(std::span(scans).last(once.size()));
  }
  const auto max_scans = arguments.number<std::size_t>("--scans", 0);
  if (max_scans > 0 && max_scans < scans.size()) scans.resize(max_scans);
  return scans;
}

/// Runs the entire drive in a new scene; returns its rates and tile counts.
template <class Run>
Json streamed(const bench::Arguments& arguments, const ScanSettings& settings,
              std::span<const ScanMotion> scans, Session& session, Run&& run) {
  const Stopwatch watch;
  const CityScene scene(arguments.input(0), "", session, tile_memory_bytes(arguments));
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

Json check_bytes(const bench::Arguments& arguments, const ScanSettings& settings,
                 std::span<const ScanMotion> scans, std::size_t step, Session& session) {
  std::vector<ScanMotion> some;
  for (std::size_t i = 0; i < scans.size(); i += step) some.push_back(scans[i]);
  const CityScene tiles(arguments.input(0), "", session, tile_memory_bytes(arguments));
  const std::string streamed_digest = digest_in(tiles, settings, some, session.executor);
  const ModelScene in_memory(arguments.input(0), "", session);
  const std::string memory_digest = digest_in(in_memory, settings, some, session.executor);
  return {{"scans", some.size()},
          {"same_bytes", streamed_digest == memory_digest},
          {"sha256", memory_digest}};
}

Json measure_all(const bench::Arguments& arguments) {
  const Executor executor(arguments.number("--threads", 0));
  const std::string sensor = arguments.text("--sensor", kDefaultSensor);
  const std::string backend = arguments.text("--device", "cpu");
  ProgressSink progress;
  DeviceOptions chosen;
  chosen.kind = backend == "cuda" ? DeviceKind::cuda : DeviceKind::cpu;
  DeviceChoice device = choose_device(chosen);
  Session session{executor, progress, 1, device};
  ScanSettings settings;
  settings.sensor = load_lidar_model(sensor);
  const std::vector<ScanMotion> scans = scans_of(arguments, settings.sensor, progress);
  const CityManifest city = load_city_manifest(arguments.input(0));
  Json json;
  json["provenance"] = to_json(provenance_of(executor.threads(), device));
  json["device"] = backend;
  json["threads"] = executor.threads();
  json["sensor"] = sensor;
  json["points"] = city.points();
  json["splats"] = city.splats();
  json["tiles"] = city.tiles.size();
  json["tile_m"] = city.grid.side_m;
  json["tile_memory_gb"] = arguments.number("--tile-memory", kDefaultTileMemory_gb);
  json["scans"] = scans.size();
  json["driven_m"] =
      static_cast<double>(scans.size()) * arguments.number("--spacing", kDefaultSpacing_m);
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
  const auto step = arguments.number<std::size_t>("--check", 0);
  if (step > 0) json["check"] = check_bytes(arguments, settings, scans, step, session);
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  return bench::exit_code_of("bench_city", [&] {
    const bench::Arguments arguments(
        argc, argv,
        "bench_city CITY TRAJECTORY [--sensor NAME] [--device cpu|cuda] [--threads N] "
        "[--spacing M] [--passes N] [--tile-memory GB] [--scans N] [--check STEP] [--json FILE]",
        2, 2);
    bench::print_and_write(measure_all(arguments), arguments.text("--json"));
  });
}
