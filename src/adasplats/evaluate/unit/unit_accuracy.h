// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "adasplats/evaluate/echoes/echo_accuracy.h"
#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// How well a unit foretells intensities, over returns whose model has one.
struct UnitIntensityAccuracy {
  std::size_t returns = 0;
  double rank_correlation = 0;  ///< Spearman's; NaN where nothing varies
  /// Root mean square of what is left when one monotonous curve has made measured intensities of
  /// the expected ones, in shares of the scale (1, or 255 where intensities are above 1).
  double rmse_after_curve = 0;
};

/// Which beams are foretold to be lost: those that meet nothing, or nothing near enough to be
/// reported, those that the vehicle blocks, and those that the drop model gives more than half a
/// chance to be.
struct UnitDropAccuracy {
  DropAccuracy beams;
  double right_share = 0;  ///< of all decisions, 0..1
};

struct UnitAccuracy {
  UnitIntensityAccuracy intensity;
  UnitIntensityAccuracy near;  ///< of the returns within 0.5 m of the model
  UnitDropAccuracy drop;
  UnitDropAccuracy unblocked;  ///< outside of the vehicle's shadow
  /// Outside of it, but as many are foretold to be lost as the chances add up to: the likeliest.
  UnitDropAccuracy by_rate;
};

/// Of beams that the unit was not fitted to. A unit without intensities foretells the model's; one
/// without a drop model, none lost.
UnitAccuracy unit_accuracy(std::span<const UnitBeam> beams, const LidarModel& unit);

}  // namespace adasplats
