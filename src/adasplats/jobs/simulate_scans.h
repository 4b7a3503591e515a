// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/city/tile_stream.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/jobs/scene/drive.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Paper section "New Trajectory Simulation": a sensor along a shifted trajectory.
struct SimulateJob {
  std::filesystem::path model;  ///< splats, a mesh, or a world file
  std::string labels;           ///< scheme of the classes; empty: what the model says
  ScanChoice scan;
  DriveOptions drive;
  std::filesystem::path output;
  ScanFormat format = ScanFormat::semantickitti;
  PointOrder point_order = PointOrder::kitti;  ///< in KITTI's files
  bool overwrite = false;
  double tile_memory_gb = 0;  ///< of a city's tiles, 10^9 bytes; 0: 1 on the CPU, 6 on a GPU
};

struct SimulateResult {
  std::size_t scans = 0;
  std::size_t scans_resumed = 0;  ///< of them an interrupted run had written
  std::size_t rays = 0;           ///< of the scans that this run made, as all below
  std::size_t hits = 0;
  // Each one includes those before it; only several GPUs trace longer in sum than the clock runs.
  // Files are written beside the casting.
  double seconds_traced = 0;     ///< in the tracer, or in the kernels of all GPUs
  double seconds_assembled = 0;  ///< until they were points with noise, classes and times
  double seconds_written = 0;    ///< until the last scan was on disk and the folder had its name
  double seconds = 0;            ///< of everything, with loading the model
  std::optional<TileStreamCounts> tiles;  ///< where those of a city came and went
};

/// Simulates and writes. Interrupted at any moment, the same job goes on after the last whole scan
/// and gives the same bytes, and so do cities whose tiles come and go (CityScene), which they do
/// along trajectories; formats of one file for all scans (mcap, pcap) begin anew.
/// Errors: cannot_create (also where what was left unfinished is of another job, other inputs or
/// another version), io (also where the disk has no room for the scans), data (no ray met
/// anything).
SimulateResult run_simulate(const SimulateJob& job, Session& session);
/// The same in a model that is loaded already, from the file that `job` names; loading is not in
/// the seconds.
SimulateResult run_simulate(const SimulateJob& job, const ModelScene& scene, Session& session);

/// Some of the scans of a drive, one behind another.
struct ScanTask {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Begins the folder of a simulation that is made in spans of `count` scans, and gives those that
/// are not there yet. Each is a task of its own then (simulate_span), on as many machines as see
/// the folder; run_simulate finishes it. Errors: usage (a format of one file for all scans), those
/// of run_simulate.
std::vector<ScanTask> plan_simulation(const SimulateJob& job, std::size_t count, Session& session);

struct SpanResult {
  std::size_t rays = 0;
  std::size_t hits = 0;
  bool was_done = false;  ///< an earlier task or run had written all of it
};

/// Simulates one span of a drive that was planned: the bytes that its scans have in one run. Any
/// number of tasks may run at a time, also of the same span. Errors: usage (no such scans), those
/// of FolderTask and of run_simulate.
SpanResult simulate_span(const SimulateJob& job, ScanTask span, Session& session);

/// The keys of a simulation's --report.
nlohmann::ordered_json to_json(const SimulateResult& result);

}  // namespace adasplats
