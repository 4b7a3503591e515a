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

/// The paper's experiment on the procedural street, with every method.
struct DemoJob {
  std::filesystem::path output = "adasplats-demo";
  bool overwrite = false;
  std::size_t points = 300'000;
  double driving_spacing_m = 2;  ///< between the held-out scans
};

/// What one method came to.
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
  std::vector<std::filesystem::path> pictures;  ///< two of each method
  std::filesystem::path picture;                ///< of all methods and their errors
  std::filesystem::path page;                   ///< HTML
};

/// Street, then for each method: model, simulation on the shifted trajectory, C2C,
/// re-simulation of the driving sequence, pictures; then a picture of all and a page.
DemoResult run_demo(const DemoJob& job, Session& session);

/// The keys of a demo's --report: those of the single jobs by method.
nlohmann::ordered_json to_json(const DemoResult& result);

}  // namespace adasplats
