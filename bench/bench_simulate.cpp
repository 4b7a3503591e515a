// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Seconds that scans along a trajectory take, sensor noise and attributes included: what
// Scene.simulate of Python does, in C++. bench_python.py runs both by turns.
//
//   bench_simulate MODEL.ply TRAJECTORY SENSOR [--threads N] [--step]
//
// Prints the seconds of five runs; with --step those of one run for every line of stdin.

#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

struct Options {
  std::vector<std::string> inputs;
  int threads = 0;
  bool by_step = false;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--step") {
      options.by_step = true;
    } else if (word == "--threads" && i + 1 < argc) {
      options.threads = std::stoi(argv[++i]);
    } else {
      options.inputs.push_back(word);
    }
  }
  if (options.inputs.size() != 3)
    throw std::runtime_error(
        "usage: bench_simulate MODEL.ply TRAJECTORY SENSOR [--threads N] [--step]");
  return options;
}

/// All scans are kept, as Python keeps them.
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

void run(const Options& options) {
  const Executor executor(options.threads);
  ProgressSink progress;
  DeviceChoice cpu;
  Session session{executor, progress, 1, cpu};
  const ModelScene scene(options.inputs[0], "", session);
  const std::vector<ScanMotion> motions = still_scans(load_trajectory(options.inputs[1]));
  const LidarModel sensor = load_lidar_model(options.inputs[2]);
  const auto print = [&] {
    std::printf("%.9f\n", seconds_of(scene, sensor, motions, executor));
    std::fflush(stdout);
  };
  if (!options.by_step) {
    for (int i = 0; i < 5; ++i) print();
    return;
  }
  for (std::string line; std::getline(std::cin, line);) print();
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  try {
    adasplats::run(adasplats::parse(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_simulate: %s\n", error.what());
    return 1;
  }
}
