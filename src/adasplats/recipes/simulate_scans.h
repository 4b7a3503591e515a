// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "adasplats/dataset/scan_writer.h"
#include "adasplats/pipeline/scene/drive.h"
#include "adasplats/pipeline/scene/scan_simulator.h"
#include "adasplats/pipeline/session/session.h"

namespace adasplats {

/// Paper section "New Trajectory Simulation": a sensor along a shifted trajectory.
struct SimulateJob {
  std::filesystem::path model;  ///< splats, a mesh, or a world file
  std::string labels;           ///< scheme of the classes; empty: what the model says
  ScanChoice scan;
  DriveOptions drive;
  std::filesystem::path output;
  ScanFormat format = ScanFormat::semantickitti;
  bool overwrite = false;
};

struct SimulateResult {
  std::size_t scans = 0;
  std::size_t rays = 0;
  std::size_t hits = 0;
  // Each one includes those before it; only several GPUs trace longer in sum than the clock runs.
  double seconds_traced = 0;     ///< in the tracer, or in the kernels of all GPUs
  double seconds_assembled = 0;  ///< until they were points with noise, classes and times
  double seconds_written = 0;    ///< until the scans were on disk
  double seconds = 0;            ///< of everything, with loading the model
};

/// Simulates and writes.
SimulateResult run_simulate(const SimulateJob& job, Session& session);

/// The keys of a simulation's --report.
nlohmann::ordered_json to_json(const SimulateResult& result);

}  // namespace adasplats
