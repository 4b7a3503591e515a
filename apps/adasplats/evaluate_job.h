// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/evaluate/resimulate.h"
#include "option_types.h"
#include "session.h"
#include "view_choice.h"

namespace adasplats::app {

/// Two clouds: files, sequence folders or outputs of simulate.
struct CloudComparisonJob {
  std::filesystem::path simulated;
  std::filesystem::path original;
  bool by_class = false;
  std::string labels;
  std::filesystem::path picture;  ///< PNG of the simulated points by distance; empty: none
  ViewChoice view = {.width = 1920, .height = 1080};
};

struct CloudComparison {
  CloudDistance distance;
  std::vector<std::pair<std::string, ClassDistance>> by_class;  ///< by name
};

CloudComparison run_cloud_comparison(const CloudComparisonJob& job, Session& session);

/// A model against held-out scans.
struct ResimulateJob {
  std::filesystem::path model;
  std::filesystem::path sequence;
  ScanRange scans;                ///< of the sequence
  bool beams_from_poses = false;  ///< even where the sensor is recognised
  std::filesystem::path motion;   ///< poses that tell how the sensor of raw scans moved, or empty
  std::string labels = "semantickitti";
  ResimulateOptions options;
  std::filesystem::path picture;  ///< PNG of the middle scan's beams by error; empty: none
  int picture_width = 1920;
};

ResimulateResult run_resimulate(const ResimulateJob& job, Session& session);

/// Mean C2C over the points of several classes, by name; NaN where none has points.
double c2c_of_classes(const CloudComparison& comparison, const std::vector<std::string>& names);

/// The keys of the --reports.
nlohmann::ordered_json to_json(const CloudComparison& comparison);
nlohmann::ordered_json to_json(const ResimulateResult& result);

}  // namespace adasplats::app
