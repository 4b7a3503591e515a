// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Seconds for scans along a trajectory, with sensor noise and attributes: the C++ counterpart of
// Scene.simulate in Python. bench_python.py alternates between both.
//
//   bench_simulate MODEL.ply TRAJECTORY SENSOR [--threads N] [--step]
//
// Prints the seconds of five runs; with --step those of one run per line of stdin.

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/session/inputs.h"
#include "common.h"

namespace adasplats {
namespace {

/// Keeps all scans, as Python does.
double seconds_of(const ModelScene& scene, const LidarModel& sensor,
                  std::span<const ScanMotion> motions, const Executor& executor) {
  const Stopwatch watch;
  ScanSettings settings;
  settings.sensor = sensor;
  ScanSimulator simulator(scene, std::move(settings), executor);
  std::vector<Scan> scans;
  simulator.run(motions, 0, [&](std::size_t, Scan scan) { scans.push_back(std::move(scan)); });
  return watch.seconds();
}

void run(const bench::Arguments& arguments) {
  const Executor executor(arguments.number("--threads", 0));
  ProgressSink progress;
  DeviceChoice cpu;
  Session session{executor, progress, 1, cpu};
  const ModelScene scene(arguments.input(0), "", session);
  const std::vector<ScanMotion> motions = still_scans(load_trajectory(arguments.input(1)));
  const LidarModel sensor = load_lidar_model(arguments.input(2));
  const auto print = [&] {
    std::printf("%.9f\n", seconds_of(scene, sensor, motions, executor));
    std::fflush(stdout);
  };
  if (!arguments.has("--step")) {
    for (int i = 0; i < 5; ++i) print();
    return;
  }
  for (std::string line; std::getline(std::cin, line);) print();
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_simulate", [&] {
    adasplats::run(
        {argc, argv, "bench_simulate MODEL.ply TRAJECTORY SENSOR [--threads N] [--step]", 3, 3});
  });
}
