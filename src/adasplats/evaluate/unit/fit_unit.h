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

/// The scan pattern of a sensor model.
struct UnitPattern {
  std::size_t rings = 0;
  std::size_t columns = 0;  ///< azimuth steps per turn
  double max_range_m = 0;
};

/// The parameters of one physical sensor, as far as they can be estimated from measured scans.
struct UnitFit {
  std::vector<double> ring_noise_m;          ///< one per ring, topmost first; empty: not estimated
  std::optional<SensorIntensity> intensity;  ///< none: not estimated
  std::optional<RayDropModel> drop;          ///< none: not estimated
  std::optional<SensorFields> fields;        ///< none: none of the above is estimated
  std::optional<VehicleBody> body;           ///< none: not estimated; without cells: nothing is hit
  std::optional<double> max_range_m;         ///< if returns end before the model does
  std::vector<std::string> not_estimated;    ///< missing parameters, with the reason
};

/// Standard deviation of the white noise of each ring's ranges, from second differences of
/// neighbouring beams on one smooth surface, corrected by those of the model. Rings with fewer than
/// 300 differences get the median of the others. Empty if fewer than a quarter of the rings have
/// that many.
std::vector<double> fit_ring_noise_m(std::span<const SensorBeam> beams, std::size_t rings);

/// Intensities of a calibrated sensor, and the share (rank) of each beam among all beams with the
/// same expectation; NaN: not estimated.
struct IntensityFit {
  SensorIntensity unit;
  std::vector<float> shares;  ///< of the non-zero beams: share that report less
  std::vector<float> zeros;   ///< share of the beams that report zero before it
};

/// None if fewer than 10,000 returns with an intensity hit the model, or if all intensities are
/// equal. `highest` is the highest measured intensity, `step` the step that all are multiples of.
std::optional<IntensityFit> fit_unit_intensity(std::span<const SensorBeam> beams,
                                               std::size_t rings);

/// Lost beams of a calibrated sensor, and the share (rank) of each beam among all beams that are
/// equally likely to be lost; NaN: not estimated.
struct DropFit {
  RayDropModel model;
  std::vector<float> shares;
};

/// Blocked sectors; runs of lost beams at range edges, from the returns alone; and the logistic
/// model of beams that are lost elsewhere in runs of at most 20. Longer runs are due to the scene
/// and are ignored. None if fit_ray_drop() has too few beams of either kind.
std::optional<DropFit> fit_unit_drop(std::span<const SensorBeam> beams, double max_range_m);

/// Shares of beams (IntensityFit, DropFit); empty: not estimated.
struct BeamShares {
  std::span<const float> drop, intensity, zero;
};

/// Up to two scans, evenly spread. Beams without an estimate get the values of their neighbours.
/// `ring_noise_m`: of fit_ring_noise_m(), which the noise is scaled to.
SensorFields fit_unit_fields(std::span<const SensorBeam> beams, const UnitPattern& pattern,
                             std::span<const double> ring_noise_m, const BeamShares& shares);

/// What blocks beams in the sensor's frame: half degrees of a ring in which beams return from
/// within 4 m, at least half a metre before the model or where it is not hit, at one range within
/// 0.2 m, from at least kMinBlockedPlaces standpoints and half of those with beams there. None if
/// the beams are from fewer standpoints.
std::optional<VehicleBody> fit_vehicle_body(std::span<const SensorBeam> beams);

/// The standard deviation of white noise from its absolute second differences, which are sorted:
/// from the mean of their middle half (see features.cpp). 0 without any.
double noise_of_second_differences(std::vector<float>& second);

/// The farthest return, rounded up to a decimetre, if at least 200 beams hit the model more than a
/// metre farther away.
std::optional<double> fit_max_range_m(std::span<const SensorBeam> beams);

/// All of these, with the reasons for missing ones.
UnitFit fit_unit(std::span<const SensorBeam> beams, const UnitPattern& pattern);

}  // namespace adasplats
