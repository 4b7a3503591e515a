// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/sensors/calibrated_sensor.h"
#include "adasplats/sensors/vehicle_body.h"
#include "adasplats/simulate/scan/ray_drop.h"

namespace adasplats {

/// How a sensor scans, as far as its units have it in common.
struct UnitPattern {
  std::size_t rings = 0;
  std::size_t columns = 0;  ///< azimuth steps a turn, as the beams count them
  double max_range_m = 0;
};

/// What one unit of a sensor makes of what its beams meet, as far as measured scans tell it.
struct UnitFit {
  std::vector<double> ring_noise_m;        ///< one a ring, topmost first; empty: not told
  std::optional<UnitIntensity> intensity;  ///< none: not told
  std::optional<RayDropModel> drop;        ///< likewise
  std::optional<UnitFields> fields;        ///< none: nothing of the above is told
  std::optional<VehicleBody> body;         ///< none: not told; without cells: nothing is in the way
  std::optional<double> max_range_m;       ///< where returns end though there is more to hit
  std::vector<std::string> not_told;       ///< what is missing, and why
};

/// Standard deviation of the white noise of each ring's ranges: second differences of neighbouring
/// beams on one smooth surface, those of the model taken off. Rings with fewer than 300 of them
/// have the median of the others. Empty where fewer than a quarter of the rings have as many.
std::vector<double> fit_ring_noise_m(std::span<const UnitBeam> beams, std::size_t rings);

/// Intensities of a unit, and of each beam where it lies among all of which the same is expected
/// (IntensityShares); NaN: not told.
struct IntensityFit {
  UnitIntensity unit;
  std::vector<float> shares;  ///< of those that do not report zero: that report less
  std::vector<float> zeros;   ///< that report zero before it
};

/// None where fewer than 10,000 returns with an intensity meet the model, or where all intensities
/// are one. `highest` is the highest measured one, `step` the step that all are multiples of.
std::optional<IntensityFit> fit_unit_intensity(std::span<const UnitBeam> beams, std::size_t rings);

/// Lost beams of a unit, and of each beam the share of all as likely to be lost that are lost
/// before it; NaN: not told.
struct DropFit {
  RayDropModel model;
  std::vector<float> shares;
};

/// Blocked sectors; runs of lost beams at range edges, of the returns alone; the logistic model of
/// the beams that are lost elsewhere, in runs of 20 at most. Longer ones are of the place, where
/// something did not answer at all, and not told. None where
/// fit_ray_drop() has too few of either kind.
std::optional<DropFit> fit_unit_drop(std::span<const UnitBeam> beams, double max_range_m);

/// Shares of beams (IntensityFit, DropFit); empty: none is told.
struct BeamShares {
  std::span<const float> drop, intensity, zero;
};

/// Up to two scans, evenly spread. Beams of which something is not told have what beams beside them
/// have. `ring_noise_m`: of fit_ring_noise_m(), so large is the noise.
UnitFields fit_unit_fields(std::span<const UnitBeam> beams, const UnitPattern& pattern,
                           std::span<const double> ring_noise_m, const BeamShares& shares);

/// What is in the beams' way in the sensor's own frame: half degrees of a ring in which beams
/// return from within 4 m, half a metre and more before the model or where it has nothing, from at
/// least kMinBlockedPlaces places, half of those that fired there, and from one range to 0.2 m.
/// None where the beams are from fewer places.
std::optional<VehicleBody> fit_vehicle_body(std::span<const UnitBeam> beams);

/// The standard deviation of white noise by absolute second differences of it, which are sorted:
/// by the mean of their middle half (see features.cpp). 0 of none.
double noise_of_second_differences(std::vector<float>& second);

/// The farthest return, to the next decimetre, where at least 200 beams meet the model farther away
/// by a metre and more.
std::optional<double> fit_max_range_m(std::span<const UnitBeam> beams);

/// All of these, and what could not be told.
UnitFit fit_unit(std::span<const UnitBeam> beams, const UnitPattern& pattern);

}  // namespace adasplats
