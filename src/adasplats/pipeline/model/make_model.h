// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/pipeline/session/session.h"
#include "adasplats/splats/build_model.h"

namespace adasplats {

/// How a model is made of points.
struct ModelOptions {
  std::string labels;  ///< as label_scheme_for takes it
  BuildOptions build;
  /// The user has asked for `build.remove`: where it can remove nothing, that is an error and not
  /// only said.
  bool removal_is_asked = false;
  /// Intensities become reflectances with the sensor's response, where points have known beams
  /// and intensities (measure_reflectances); else they stay as measured.
  bool reflectance = true;
  /// What the recording gets wrong is estimated from the points themselves and corrected, where the
  /// evidence is clear (calibrate()).
  bool calibrate = true;
};

/// Of point files.
struct ModelJob : ModelOptions {
  std::vector<std::filesystem::path> inputs;
  LoadOptions load;
};

struct ModelResult {
  LoadReport loaded;  ///< points_read alone, where nothing was loaded
  BuildReport built;
  bool reflectance_measured = false;
  std::optional<CalibrationReport> calibrated;  ///< nothing: it was not asked for
  Calibration calibration;                      ///< what was applied
  std::vector<StepTime> steps;                  ///< of loading, building and what the caller adds
  double seconds = 0;
};

/// Loads and builds on the session's device. Errors: usage (the semantic method without labels),
/// those of load_cloud and build_model.
std::pair<SplatModel, ModelResult> make_model(const ModelJob& job, Session& session);

/// Builds of points in memory. Errors: likewise.
std::pair<SplatModel, ModelResult> make_model(const PointCloud& cloud, const ModelOptions& options,
                                              Session& session);

/// Of a model's --report and of `info`.
nlohmann::ordered_json to_json(const TimedOrigins& timed);
/// The keys of a model's --report.
nlohmann::ordered_json to_json(const ModelResult& result);

}  // namespace adasplats
