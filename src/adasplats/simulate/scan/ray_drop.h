// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/sensors/ray_drop_model.h"
#include "adasplats/simulate/scan/drop_chance.h"

namespace adasplats {

/// Conditions that determine whether an echo is strong enough to be reported.
struct EchoConditions {
  float range_m = 0;
  float cos_incidence = 1;  ///< 1: the beam meets the surface head on
  float reflectance = 0;    ///< of the splat, in the unit of the measured intensities; NaN: unknown
  Vec3f direction = {};     ///< of the beam in the sensor's frame; zero: unknown
  float drop_log_odds = 0;  ///< of the splat (SplatModel)
};

/// Rules for CPU and GPU, without the blocked directions.
DropRules drop_rules(const RayDropModel& model);
/// Probability that an echo is dropped, 0..1; 1 in a blocked direction.
double drop_probability(const RayDropModel& model, const EchoConditions& echo);

/// Fits weights by penalised maximum likelihood (Newton's method): dropped[i] of echoes[i]. They
/// are what the sensor adds to the log odds of the splats. Errors: data (fewer than 100 of either
/// kind), std::logic_error (sizes differ).
RayDropModel fit_ray_drop(std::span<const EchoConditions> echoes,
                          std::span<const std::uint8_t> dropped);

/// Minimum number of sensor positions for the detection of blocked sectors.
inline constexpr std::size_t kMinBlockedPlaces = 3;

/// Finds sectors, one degree of azimuth wide, of each ring (without `rings`: of each elevation,
/// where beams within 0.01 degrees count as one) in which most echoes that a model predicts were
/// dropped, from at least three quarters of the sensor positions and at least kMinBlockedPlaces of
/// them. Such sectors are blocked by objects fixed in the sensor's frame. places[i]: number of the
/// sensor position of echo i. Neighbouring sectors are joined. Error: std::logic_error (sizes
/// differ).
std::vector<BlockedSector> find_blocked_sectors(std::span<const EchoConditions> echoes,
                                                std::span<const std::uint8_t> dropped,
                                                std::span<const std::uint32_t> places,
                                                std::span<const std::uint16_t> rings = {});

}  // namespace adasplats
