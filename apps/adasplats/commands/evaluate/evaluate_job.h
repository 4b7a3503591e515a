// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/jobs/evaluate/evaluate_clouds.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/scene/view_choice.h"
#include "cli/session.h"

namespace adasplats::app {

struct CloudComparisonJob : CloudFiles {
  ByClass by_class = ByClass::no;
  std::filesystem::path picture;  ///< PNG of the simulated points by distance; empty: none
  std::filesystem::path errors;   ///< PLY of the simulated points with their distance; empty: none
  ViewChoice view = {.width = 1920, .height = 1080};
};

/// Compares and draws.
CloudComparison run_cloud_comparison(const CloudComparisonJob& job, Session& session);

/// A model against held-out scans.
struct ResimulateJob : HeldOutScans {
  std::filesystem::path model;
  std::string labels = "semantickitti";
  ResimulateOptions options;
  HeldOutExtras extras;
  std::filesystem::path picture;  ///< PNG of the middle scan's beams by error; empty: none
  int picture_width = 1920;
  std::filesystem::path errors;  ///< PLY of the measured points with their range error; empty: none
};

/// Casts and draws.
HeldOutResult run_resimulate(const ResimulateJob& job, Session& session);

}  // namespace adasplats::app
