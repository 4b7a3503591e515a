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

/// Paper section "New Trajectory Simulation": a sensor, or those of a rig, along a shifted
/// trajectory.
struct SimulateJob {
  std::filesystem::path model;  ///< splats, a mesh, or a world file
  std::string labels;           ///< scheme of the classes; empty: the model's
  ScanChoice scan;
  DriveOptions drive;
  /// The sensors of a vehicle that drives (read by parse_rig()), instead of `scan.sensor` and
  /// `drive.mount`; its `trajectory` is the default of the drive. Empty: one sensor.
  std::filesystem::path rig;
  std::filesystem::path output;
  ScanFormat format = ScanFormat::semantickitti;
  PointOrder point_order = PointOrder::kitti;   ///< in files of data sets
  CloudDriver driver = CloudDriver::adasplats;  ///< mcap: whose clouds to write
  bool velocities = false;  ///< of the surface at every point; format: has_velocities()
  bool overwrite = false;
  double tile_memory_gb = 0;  ///< for a city's tiles, 10^9 bytes; 0: 1 on the CPU, 6 on a GPU
};

struct SimulateResult {
  std::size_t scans = 0;
  std::size_t scans_resumed = 0;  ///< written by an interrupted run
  std::size_t rays = 0;           ///< this and all below: of the scans that this run simulated
  std::size_t hits = 0;
  // Each one includes those before it. With several GPUs the times of their kernels are added, so
  // seconds_traced may exceed the elapsed time. Files are written during the casting.
  double seconds_traced = 0;     ///< in the tracer, or in the kernels of all GPUs
  double seconds_assembled = 0;  ///< until scans had points with noise, classes and times
  double seconds_written = 0;    ///< until the last scan was on disk and the folder was renamed
  double seconds = 0;            ///< total, with loading the model
  std::optional<TileStreamCounts> tiles;  ///< of a city whose tiles were loaded on demand
};

/// Simulates and writes. After an interruption at any moment the same job resumes after the last
/// complete scan, with the same bytes; formats with one file for all scans (mcap, pcap) start
/// again. Along trajectories, tiles of a city are loaded on demand (CityScene), with the same
/// bytes. A rig is written as make_rig_writer() does, with a rig.toml of the result. Errors:
/// cannot_create (also if the unfinished folder is of another job, other inputs or
/// another version), io (also if the disk has too little space for the scans), data (no ray hit
/// anything).
SimulateResult run_simulate(const SimulateJob& job, Session& session);
/// In a model that was loaded from the file that `job` names; the seconds exclude the loading.
SimulateResult run_simulate(const SimulateJob& job, const ModelScene& scene, Session& session);

/// Consecutive scans of a drive.
struct ScanTask {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Begins the folder of a simulation that is made in spans of `count` scans, and returns the
/// missing spans. Each is a task (simulate_span), on any number of machines that share the folder;
/// run_simulate finishes it. Errors: usage (a format with one file for all scans), those of
/// run_simulate.
std::vector<ScanTask> plan_simulation(const SimulateJob& job, std::size_t count, Session& session);

struct SpanResult {
  std::size_t rays = 0;
  std::size_t hits = 0;
  bool was_done = false;  ///< by an earlier task or run
};

/// Simulates one span of a planned drive, with the bytes that its scans have in one run. Any number
/// of tasks may run at a time, also of the same span. Errors: usage (no such scans), those of
/// FolderTask and of run_simulate.
SpanResult simulate_span(const SimulateJob& job, ScanTask span, Session& session);

/// The keys of a simulation's --report.
nlohmann::ordered_json to_json(const SimulateResult& result);

}  // namespace adasplats
