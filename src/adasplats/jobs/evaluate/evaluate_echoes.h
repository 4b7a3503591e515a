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

/// A model and measured scans whose beams are cast into it.
struct EchoInputs {
  std::filesystem::path model;
  std::filesystem::path sequence;
  ScanRange scans;               ///< of the sequence
  std::filesystem::path motion;  ///< poses that say how the sensor of raw scans moved; empty: the
                                 ///< sequence's own
  std::string sensor = "velodyne-hdl-64e-kitti";  ///< whose beams are looked for in raw scans
  bool sensor_is_asked = false;                   ///< then the scans have to be raw
};

struct EchoResult {
  IntensityAccuracy intensity;
  /// Where the scans say which beams found nothing: as they were measured, of an HDL-64E.
  std::optional<DropAccuracy> misses;     ///< without a drop model
  std::optional<DropAccuracy> drop;       ///< with it; all beams
  std::optional<DropAccuracy> unblocked;  ///< with it; without the beams that it says are blocked
};

/// `drop`: file of a drop model, or empty. Errors: usage (a drop model, but scans that are
/// motion-compensated or of another sensor).
EchoResult evaluate_echoes(const EchoInputs& inputs, const std::filesystem::path& drop,
                           Session& session);

struct FitDropResult {
  RayDropModel model;
  std::size_t scans = 0;
  DropAccuracy misses;  ///< on the scans that it was fitted to, as the next
  DropAccuracy drop;
};

/// Fits a drop model. Errors: usage (as above), those of fit_ray_drop.
FitDropResult fit_drop(const EchoInputs& inputs, Session& session);

/// The keys of the --reports.
nlohmann::ordered_json to_json(const EchoResult& result);
nlohmann::ordered_json to_json(const FitDropResult& result);

}  // namespace adasplats
