// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// A model and measured scans in it, of one unit of a sensor.
struct UnitScansJob {
  std::filesystem::path model, scans_of;
  ScanRange scans;
  std::filesystem::path motion;      ///< of raw scans of a sequence; empty: its own poses
  std::filesystem::path trajectory;  ///< of a folder of files without a poses.csv in it
};

/// All beams of these scans, beside what the model says of them.
struct MeasuredUnit {
  std::string sensor_name;  ///< of the library, recognised by the points
  LidarModel sensor;
  LaserOffsets offsets;  ///< of the model's calibration
  double step_rad = 0;   ///< between firings of a ring
  std::size_t scans = 0;
  std::vector<UnitBeam> beams;
  double agreement = 0;  ///< share of the returns that the model has within half a metre
};

/// Errors: data (a sensor that is not recognised; scans that say nothing of the azimuths; another
/// place), usage (`motion` of scans that are compensated), those of the readers.
MeasuredUnit measure_unit(const UnitScansJob& job, Session& session);

/// `agreement`: share of the returns that the model has within half a metre. Errors: data (fewer
/// than 60 %: `scans` are of another place, or their poses are wrong).
void require_one_place(double agreement, const std::string& scans);

}  // namespace adasplats
