// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adasplats/evaluate/realism/realism.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Can simulated scans be distinguished from real ones? Two sets of scans of one sensor.
struct RealismJob {
  std::filesystem::path simulated, real;
  ScanRange scans;  ///< of each set
  /// Poses for a folder of files, one per scan, without a poses.csv (DriveInput); else empty.
  std::filesystem::path trajectory;
};

struct RealismReport : RealismResult {
  std::string sensor;           ///< recognised from the points of both sides
  double azimuth_step_rad = 0;  ///< between firings of a ring, from REAL
  std::size_t simulated_scans = 0, real_scans = 0;
  StatisticPair plane_residual_m;  ///< of each scan to the next one (scan_residuals_m)
};

/// Reads both sides in the same way and compares them (compare_realism). Rings are those of the
/// sensor recognised from the points alone. Errors: usage (a file; a folder of scans without
/// poses), data (too few scans; a sensor that is not recognised; two sensors; no azimuth step),
/// those of the readers.
RealismReport evaluate_realism(const RealismJob& job, Session& session);

/// The keys of --report.
nlohmann::ordered_json to_json(const RealismReport& report);

}  // namespace adasplats
