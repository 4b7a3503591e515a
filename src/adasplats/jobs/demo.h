// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "adasplats/evaluate/resimulate.h"
#include "adasplats/jobs/evaluate/evaluate_clouds.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/scans/simulate.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/synth/street.h"

namespace adasplats {

/// The paper's experiment with every method, on a procedural street.
struct DemoJob {
  std::filesystem::path output = "adasplats-demo";
  bool overwrite = false;
  std::size_t points = 300'000;
  double driving_spacing_m = 2;  ///< distance between held-out scans
};

/// Results of one method.
struct DemoRow {
  std::string method;
  ModelResult model;
  SimulateResult simulation;
  CloudComparison comparison;
  double thin_c2c_m = 0;  ///< of fences, poles and traffic signs
  ResimulateResult held_out;
};

struct DemoResult {
  StreetReport street;
  std::vector<DemoRow> rows;
  // Relative to the output folder:
  std::vector<std::filesystem::path> pictures;  ///< two per method
  std::filesystem::path picture;                ///< all methods and their errors
  std::filesystem::path page;                   ///< HTML
};

/// Makes a street, then for each method: a model, a simulation on the shifted trajectory, C2C,
/// re-simulation of the driving sequence, pictures; then an overview picture and a page.
DemoResult run_demo(const DemoJob& job, Session& session);

/// The HTML page of a demo; pictures are read from `folder` and embedded. `name`: of the folder in
/// the commands that the page shows.
std::string demo_page(const DemoResult& result, const std::filesystem::path& folder,
                      const std::filesystem::path& name);

/// The command (for a POSIX shell) that opens the viewer on the demo's best model and its held-out
/// scans.
std::string view_command(const std::filesystem::path& name);

/// The keys of --report: those of the single jobs, by method.
nlohmann::ordered_json to_json(const DemoResult& result);

}  // namespace adasplats
