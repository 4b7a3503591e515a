// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "adasplats/evaluate/echoes/echo_accuracy.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// A model, and measured scans whose beams are cast into it.
struct EchoInputs {
  std::filesystem::path model;
  std::filesystem::path sequence;
  ScanRange scans;               ///< of the sequence
  std::filesystem::path motion;  ///< poses of the sensor during raw scans; empty: the sequence's
  std::string sensor = "velodyne-hdl-64e-kitti";  ///< its beams are searched for in raw scans
  bool sensor_is_asked = false;                   ///< requires raw scans
};

struct EchoResult {
  IntensityAccuracy intensity;
  /// Only for raw scans of an HDL-64E, in which missing returns can be identified.
  std::optional<DropAccuracy> misses;     ///< without a drop model
  std::optional<DropAccuracy> drop;       ///< with it; all beams
  std::optional<DropAccuracy> unblocked;  ///< with it; without the beams in blocked sectors
};

/// How well the model predicts intensities, and which beams return no echo. `drop`: file of a drop
/// model, or empty. Errors: usage (a drop model, but the scans are motion-compensated or of another
/// sensor).
EchoResult evaluate_echoes(const EchoInputs& inputs, const std::filesystem::path& drop,
                           Session& session);

struct FitDropResult {
  RayDropModel model;
  std::size_t scans = 0;
  DropAccuracy misses;  ///< on the scans that it was fitted to, like `drop`
  DropAccuracy drop;
};

/// Fits a drop model. Errors: usage (as above), those of fit_ray_drop.
FitDropResult fit_drop(const EchoInputs& inputs, Session& session);

/// The keys of the --reports.
nlohmann::ordered_json to_json(const EchoResult& result);
nlohmann::ordered_json to_json(const FitDropResult& result);

}  // namespace adasplats
