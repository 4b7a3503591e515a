// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/calibrate/windows.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/jobs/calibrate/rig_mounts.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// What recordings get wrong, as files: drives in, a folder out.
struct CalibrateJob {
  std::vector<std::filesystem::path> inputs;
  LoadOptions load;
  CalibrateOptions calibrate;
  CalibrateWindowOptions windows;  ///< of drives longer than one
  std::filesystem::path output;
  bool overwrite = false;
};

struct CalibrateResult {
  LoadReport loaded;
  CalibrationReport report;
  Calibration calibration;
  Trajectory given, corrected;  ///< poses of the scans
  std::optional<Rig> rig;
  std::vector<CloudSensor> sensors;  ///< of a rig
  std::vector<RigMount> mounts;      ///< of these sensors
  std::string sensor;                ///< that measured all drives; empty: unknown
  std::vector<std::string> files;    ///< below the folder
  double seconds = 0;
};

/// Estimates and writes, for a drive (several: each in a folder drive_N of its own, from 0 on),
/// trajectory.csv, lasers.csv, report.json and report.html; for a SemanticKITTI folder with all
/// scans covered also poses.txt, which can replace its own; for a recognised sensor sensor.toml.
/// For a rig: a folder for each sensor by its name, and rig.toml with mounts and clocks. Without a
/// correction to apply only the reports. Errors: usage (nothing to estimate); data with the
/// objection (no correction to apply); those of load_cloud and OutputFolder.
CalibrateResult run_calibrate(const CalibrateJob& job, Session& session);

/// The keys of report.json; the same for the same job.
nlohmann::ordered_json to_json(const CalibrateResult& result);

/// Why the result is to be taken with care: the direction that planes hold least; empty: no reason.
std::string warning_of(const CalibrationReport& report);

}  // namespace adasplats
