// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/cloud/load_cloud.h"
#include "adasplats/splats/build_model.h"
#include "session.h"

namespace adasplats::app {

/// Point files in, model file out.
struct ModelJob {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::string labels;  ///< as label_scheme_for takes it
  LoadOptions load;
  BuildOptions build;
  /// Intensities become reflectances with the sensor's response, where points have sensor positions
  /// and intensities (measure_reflectances); else they stay as measured.
  bool reflectance = true;
};

struct ModelResult {
  LoadReport loaded;
  BuildReport built;
  bool reflectance_measured = false;
  std::vector<StepTime> steps;  ///< of loading, building and saving
  double seconds = 0;
};

/// Loads, builds on the session's device and saves.
ModelResult run_model(const ModelJob& job, Session& session);

/// The keys of a model's --report.
nlohmann::ordered_json to_json(const ModelResult& result);

}  // namespace adasplats::app
