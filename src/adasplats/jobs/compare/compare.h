// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/child_process.h"
#include "adasplats/core/setting.h"
#include "adasplats/jobs/compare/comparison_data.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// Limits of every step.
struct CompareLimits {
  double seconds = ChildLimits().seconds;
  double memory_gib = 0;  ///< 0: 90 % of the machine's memory
  bool retry = false;     ///< run failed steps again
};

template <class Visit>
void visit_settings(CompareLimits& limits, Visit&& visit) {
  visit(Setting{.name = "time_limit",
                .help = "Time limit of every step, s",
                .value = "S",
                .min = 0,
                .max = std::numeric_limits<double>::infinity(),
                .exclusive_min = true},
        limits.seconds);
  visit(Setting{.name = "memory_limit",
                .help = "Memory limit of every step, GiB; 0: 90 % of the machine's",
                .value = "GIB",
                .min = 0,
                .max = 1e9},
        limits.memory_gib);
  visit(Setting{.name = "retry", .help = "Run failed steps again"}, limits.retry);
}

/// Every competitor on the same points with the same rays. Empty fields are filled from the data.
struct CompareJob {
  std::filesystem::path data;
  std::filesystem::path output;
  Preset preset = Preset::none;
  std::vector<std::string> methods;  ///< empty: all that the data allows
  std::vector<std::pair<std::string, std::filesystem::path>>
      meshes;  ///< name and file of existing meshes
  std::string labels, sensor = kDefaultSensor;
  ScanRange scans, held_out_scans;
  std::optional<DynamicRemoval> remove;  ///< default: paper_removal()
  std::filesystem::path trajectory, held_out, truth;
  std::optional<Vec3d> offset_m;
  std::size_t every = 0;    ///< 0: at most 20 poses
  int picture_width = 960;  ///< pixels; the height is 9/16 of it
  int poisson_depth = 13;
  std::filesystem::path network;  ///< of the method kpconv; empty: default_network()
  CompareLimits limits;
  std::filesystem::path program;  ///< adasplats, which runs the steps; empty: found on PATH
  // Passed to the steps if not the default.
  int threads = 0;
  std::uint64_t seed = 1;
  DeviceKind device = DeviceKind::automatic;
};

template <class Visit>
void visit_settings(CompareJob& job, Visit&& visit) {
  visit(Setting{.name = "every",
                .help = "Use every n-th pose; 0: at most 20 poses",
                .value = "N",
                .min = 0},
        job.every);
  visit(Setting{.name = "picture_width",
                .help = "Picture width, pixels; the height is 9/16 of it",
                .value = "N",
                .min = 64,
                .max = 8192},
        job.picture_width);
  visit(Setting{.name = "poisson_depth",
                .help = "Octree depth of Poisson reconstruction",
                .value = "N",
                .min = 1,
                .max = 16},
        job.poisson_depth);
  visit(Setting{.name = "network",
                .help = "Network file of the method kpconv (default: the included network)"},
        job.network);
}

/// Settings of methods that are not compared.
std::vector<UnusedSetting> unused_settings(const CompareJob& job);

/// What the paper removes from the data of a preset, whatever their label scheme: everything
/// movable (section "Adaptive Splatting" and both "Results"), from every input. M-City has no
/// dynamic objects. Without a preset: as for PC3D-Paris, because the methods are the paper's.
DynamicRemoval paper_removal(Preset preset);

/// The values of `methods`.
std::vector<std::string> compare_method_names();

/// Runs the steps that are not done yet, writes compare.json, report.md and report.html into the
/// output folder and returns the content of compare.json (its layout: docs/formats.md). A
/// competitor that fails is reported in its row, with "is_error" unless it met a limit or needs a
/// program that is missing. Errors: those of find_comparison_data; usage for
/// settings that no competitor could work with (limits, sensor, labels, names); no_input if the
/// program is not found; cannot_create if the folder has other content or is used by another run.
nlohmann::ordered_json run_compare(const CompareJob& job, Session& session);

}  // namespace adasplats
