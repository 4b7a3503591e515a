// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "adasplats/evaluate/echoes/echo_accuracy.h"
#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// How well intensities are predicted, over returns from surfaces with a model intensity.
struct UnitIntensityAccuracy {
  std::size_t returns = 0;
  double rank_correlation = 0;  ///< Spearman's; NaN without variation
  /// Root mean square error after the best monotonic curve from expected to measured intensities,
  /// as a share of the scale (1, or 255 if intensities exceed 1).
  double rmse_after_curve = 0;
};

/// How well lost beams are predicted: those that hit nothing within range, those blocked by the
/// vehicle, and those with a drop probability above 0.5.
struct UnitDropAccuracy {
  DropAccuracy beams;
  double right_share = 0;  ///< of all predictions, 0..1
};

struct UnitAccuracy {
  UnitIntensityAccuracy intensity;
  UnitIntensityAccuracy near;  ///< of the returns within 0.5 m of the model
  UnitDropAccuracy drop;
  UnitDropAccuracy unblocked;  ///< outside the vehicle's shadow
  /// Outside it, and with as many beams predicted as lost as the sum of probabilities: the
  /// likeliest.
  UnitDropAccuracy by_rate;
};

/// Evaluates a calibrated sensor on beams that it was not fitted to. Without fitted intensities, it
/// predicts those of the model; without a drop model, no lost beams.
UnitAccuracy unit_accuracy(std::span<const SensorBeam> beams, const LidarModel& unit);

}  // namespace adasplats
