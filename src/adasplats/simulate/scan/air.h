// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "adasplats/core/maths/elementary.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {

// The effect of the air on one beam, for CPU and GPU. weather.h makes AirRules from a Weather;
// formulas, constants and their sources: docs/noise.md.

/// Minimum reflectance for a report at the sensor's maximum range (Velodyne HDL-64E manual: 120 m
/// for 0.80, 50 m for 0.10; the square of the range gives 0.14).
inline constexpr double kNeededReflectance = 0.8;
/// Minimum reflectance for a report at any range: half a step of the reflectivity of Velodynes.
inline constexpr double kNeededNear = 0.005;
inline constexpr double kMinReflectance = 0.01;   // a step of the reflectivity of Velodynes
inline constexpr double kUsualReflectance = 0.3;  // if the intensity is unknown
/// Width of a beam at the sensor: Velodyne VLP-16, geometric mean of 9.5 x 12.7 mm.
inline constexpr double kBeamExit_m = 0.011;
/// Half the length of a pulse of 5 ns: depth of the fog that contributes at a time.
inline constexpr double kHalfPulse_m = 0.75;
inline constexpr double kClutterStep_m = 0.05;

/// Particles with exponential sizes: density * slope * exp(-slope D) per m^3 and mm.
struct Particles {
  double density_per_m3 = 0;
  double slope_per_mm = 1;
  double reflectance = 0;  ///< of the disk that one is to the beam
};

/// Weather for one beam.
struct AirRules {
  double extinction_per_m = 0;  ///< 0: clear
  double white_intensity = 1;   ///< of a reflectance of 1
  double max_range_m = 0;
  Particles kinds[2];          ///< drops, flakes
  double fog_backscatter = 0;  ///< 1 / (m sr)
  double divergence_rad[2] = {0, 0};
  double begin_m = 0;  ///< minimum range of returns from the air
  /// expected[i]: expected number of returns from the air up to begin_m + i * kClutterStep_m.
  const double* expected = nullptr;
  std::uint32_t expected_count = 0;

  ADASPLATS_HD bool is_clear() const { return extinction_per_m == 0; }
};

/// A return from the air that the sensor could report.
struct Speck {
  double range_m = 0;
  double power = 0;  ///< received power relative to the power that the sensor needs: at least 1
};

/// The reflectance that a sensor needs to report a surface in clear air.
ADASPLATS_HD inline double needed_reflectance(double range_m, double max_range_m) {
  const double share = range_m / max_range_m;
  const double needed = kNeededReflectance * share * share;
  return needed > kNeededNear ? needed : kNeededNear;
}

ADASPLATS_HD inline double usable_reflectance(double reflectance) {
  if (!(reflectance == reflectance)) return kUsualReflectance;
  return reflectance > kMinReflectance ? reflectance : kMinReflectance;
}

/// Probability that a return is reported; `power`: its power in clear air relative to the required
/// one.
ADASPLATS_HD inline double reported_share(double extinction_per_m, double range_m, double power) {
  return exp_of(-expm1_of(2.0 * extinction_per_m * range_m) / power);
}

ADASPLATS_HD inline double beam_width_m(const AirRules& air, double range_m) {
  return std::sqrt((kBeamExit_m + air.divergence_rad[0] * range_m) *
                   (kBeamExit_m + air.divergence_rad[1] * range_m));
}

ADASPLATS_HD inline double attenuated_power(const AirRules& air, double reflectance,
                                            double range_m) {
  return reflectance / needed_reflectance(range_m, air.max_range_m) *
         exp_of(-2.0 * air.extinction_per_m * range_m);
}

ADASPLATS_HD inline double fog_power(const AirRules& air, double range_m) {
  constexpr double kPi = 3.141592653589793;
  return attenuated_power(air, kPi * air.fog_backscatter * kHalfPulse_m, range_m);
}

/// Minimum size of a reported particle: one that fills the share s of the beam's width returns s^2
/// of the power of a wall. Infinite if filling the beam is not enough.
ADASPLATS_HD inline double min_diameter_mm(const AirRules& air, const Particles& kind,
                                           double range_m) {
  const double share = 1.0 / std::sqrt(attenuated_power(air, kind.reflectance, range_m));
  return share <= 1.0 ? 1e3 * beam_width_m(air, range_m) * share
                      : std::numeric_limits<double>::infinity();
}

/// Expected number of returns per metre from drops, flakes and fog.
struct ClutterRates {
  double of[3] = {0, 0, 0};
  ADASPLATS_HD double sum() const { return of[0] + of[1] + of[2]; }
};

ADASPLATS_HD inline ClutterRates clutter_rates(const AirRules& air, double range_m) {
  const double width_m = beam_width_m(air, range_m);
  const double area_m2 = 0.25 * 3.141592653589793 * width_m * width_m;
  ClutterRates rates;
  for (int i = 0; i < 2; ++i) {
    const Particles& kind = air.kinds[i];
    if (kind.density_per_m3 > 0)
      rates.of[i] = area_m2 * kind.density_per_m3 *
                    exp_of(-kind.slope_per_mm * min_diameter_mm(air, kind, range_m));
  }
  if (air.fog_backscatter > 0) rates.of[2] = exp_of(-1.0 / fog_power(air, range_m)) / kHalfPulse_m;
  return rates;
}

/// Expected number of returns closer than a range.
ADASPLATS_HD inline double expected_within(const AirRules& air, double range_m) {
  if (air.expected_count == 0) return 0.0;
  const double last = static_cast<double>(air.expected_count - 1);
  double place = (range_m - air.begin_m) / kClutterStep_m;
  place = place > 0 ? place : 0.0;
  const auto step = static_cast<std::uint32_t>(place < last ? place : last);
  if (step + 1 >= air.expected_count) return air.expected[air.expected_count - 1];
  const double late = place - static_cast<double>(step);
  return air.expected[step] + late * (air.expected[step + 1] - air.expected[step]);
}

/// Draws the power of a return from the air at a range. Particle sizes and fog powers are
/// exponentially distributed, so their excess over the minimum for a report is, too.
ADASPLATS_HD inline double speck_power(const AirRules& air, double range_m, Random& random) {
  const ClutterRates rates = clutter_rates(air, range_m);
  const double place = random.uniform() * rates.sum();
  const double beyond = -log_of(1.0 - random.uniform());
  if (place >= rates.of[0] + rates.of[1]) return 1.0 + beyond * fog_power(air, range_m);
  const Particles& kind = air.kinds[place < rates.of[0] ? 0 : 1];
  const double diameter_mm = min_diameter_mm(air, kind, range_m) + beyond / kind.slope_per_mm;
  double share = 1e-3 * diameter_mm / beam_width_m(air, range_m);
  share = share < 1.0 ? share : 1.0;
  return attenuated_power(air, kind.reflectance, range_m) * share * share;
}

/// Draws the nearest return from the air of one ray; false: none is closer than `end_m`.
ADASPLATS_HD inline bool nearest_speck(const AirRules& air, double end_m, Random& random,
                                       Speck& speck) {
  const double target = -log_of(1.0 - random.uniform());
  if (!(target < expected_within(air, end_m))) return false;
  // The first entry above the target; it is not the first of all, which is 0.
  std::uint32_t low = 0, high = air.expected_count - 1;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    (air.expected[middle] > target ? high : low) = middle;
  }
  const double late = (target - air.expected[low]) / (air.expected[high] - air.expected[low]);
  speck.range_m = air.begin_m + (static_cast<double>(low) + late) * kClutterStep_m;
  speck.power = speck_power(air, speck.range_m, random);
  return true;
}

}  // namespace adasplats
