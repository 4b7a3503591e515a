// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/simulate/scan/drop_chance.h"

namespace adasplats {

/// What decides whether an echo is strong enough to be reported.
struct EchoConditions {
  float range_m = 0;
  float cos_incidence = 1;  ///< 1: the beam meets the surface head on
  float reflectance = 0;    ///< of the splat, in the unit of the measured intensities; NaN: unknown
  Vec3f direction = {};     ///< of the beam in the sensor's frame; zero: unknown
};

/// Directions in which the sensor's own carrier is in the way: nothing comes back, or from too
/// near to be reported. No model of a place knows it.
struct BlockedSector {
  float elevation_rad = 0;      ///< of the beam that was measured
  float azimuth_begin_rad = 0;  ///< counter-clockwise from +x; -pi <= begin < end <= pi
  float azimuth_end_rad = 0;
};

/// How likely a real sensor reports nothing though its beam met something: directions that its
/// carrier blocks, and a logistic model of the others, both fitted to where real beams found
/// nothing (evaluate/beam_grid.h).
struct RayDropModel {
  /// Of 1, r, r^2, log(r), 1 - cos, (1 - cos)^2, log(reflectance), r * log(reflectance), with r in
  /// units of 10 m; see features().
  static constexpr std::size_t kFeatures = kDropFeatures;
  std::array<double, kFeatures> weights = {};
  /// Stands for the reflectance where it is not known.
  double usual_reflectance = 0.3;
  /// Of range edges (edge_runs.h), the share at which k + 1 beams one after the other are lost;
  /// `weights` are of the other beams then. Empty: edges are as other places.
  std::vector<double> edge_runs;
  std::string fitted_to;  ///< sensor, recording: for the reader of the file
  /// By elevation, then azimuth.
  std::vector<BlockedSector> blocked;

  std::array<double, kFeatures> features(const EchoConditions& echo) const;
  /// Without the blocked directions.
  DropRules rules() const;
  /// 0..1; 1 in a blocked direction.
  double probability(const EchoConditions& echo) const;
  /// Whether the sector of the nearest blocked elevation, within 0.3 degrees, holds the direction.
  bool blocks(Vec3f direction) const;
};

/// Fits weights by penalised maximum likelihood (Newton's method): dropped[i] of echoes[i].
/// Errors: data (fewer than 100 of either kind), std::logic_error (sizes differ).
RayDropModel fit_ray_drop(std::span<const EchoConditions> echoes,
                          std::span<const std::uint8_t> dropped);

/// Fewer places tell no blocked sectors.
inline constexpr std::size_t kLeastBlockedPlaces = 3;

/// Sectors of one degree of azimuth at each elevation (beams within 0.01 degrees are one) in which
/// most echoes that a model foretells were dropped, from at least three quarters of the places and
/// from kLeastBlockedPlaces of them: what stands still in the sensor's frame while the world goes
/// by. places[i]: the number of the place that echo i was fired from. Neighbours are joined. Error:
/// std::logic_error (sizes differ).
std::vector<BlockedSector> find_blocked_sectors(std::span<const EchoConditions> echoes,
                                                std::span<const std::uint8_t> dropped,
                                                std::span<const std::uint32_t> places);

/// A TOML file: usual_reflectance, weights, fitted_to, and [[blocked]] with elevation_deg and
/// azimuths_deg, a list of [begin, end]. Errors of reading: no_input, config with the line.
void save_ray_drop(const std::filesystem::path& path, const RayDropModel& model);
RayDropModel load_ray_drop(const std::filesystem::path& path);

}  // namespace adasplats
