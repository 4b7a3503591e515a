// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/sensors/unit_intensity.h"
#include "adasplats/simulate/scan/ray_drop.h"

namespace adasplats {

/// What one unit of a sensor makes of what its beams meet, as far as measured scans tell it.
struct UnitFit {
  std::vector<double> ring_noise_m;        ///< one a ring, topmost first; empty: not told
  std::optional<UnitIntensity> intensity;  ///< none: not told
  std::optional<RayDropModel> drop;        ///< likewise; with its field
  std::optional<double> max_range_m;       ///< where returns end though there is more to hit
  std::vector<std::string> not_told;       ///< what is missing, and why
};

/// Standard deviation of the white noise of each ring's ranges: second differences of neighbouring
/// beams on one smooth surface, those of the model taken off. Rings with fewer than 300 of them
/// have the median of the others. Empty where fewer than a quarter of the rings have as many.
std::vector<double> fit_ring_noise_m(std::span<const UnitBeam> beams, std::size_t rings);

/// None where fewer than 10,000 returns with an intensity meet the model, or where all intensities
/// are one. `highest` is the highest measured one, `step` the step that all are multiples of.
std::optional<UnitIntensity> fit_unit_intensity(std::span<const UnitBeam> beams, std::size_t rings);

/// Blocked sectors, the logistic model, and the field that says where echoes are lost. None where
/// fit_ray_drop() has too few of either kind.
std::optional<RayDropModel> fit_unit_drop(std::span<const UnitBeam> beams, double max_range_m);

/// The farthest return, to the next decimetre, where at least 200 beams meet the model farther away
/// by a metre and more.
std::optional<double> fit_max_range_m(std::span<const UnitBeam> beams);

/// All of these, and what could not be told.
UnitFit fit_unit(std::span<const UnitBeam> beams, std::size_t rings, double max_range_m);

}  // namespace adasplats
