// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/weather.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {

namespace {

/// Full divergence if that of the sensor is unknown: Velodyne VLP-16, geometric mean of 1.5 x 3.0
/// mrad.
constexpr double kUsualDivergence_rad = 2.1e-3;
/// The fields of emitter and receiver do not overlap closer than this (Rasshofer et al. 2011).
constexpr double kMinAirRange_m = 1.0;
/// Fog scatters back 0.046 / (V at 5 % contrast) per sr (Rasshofer et al. 2011), and alpha is ln 20
/// / V.
const double kFogBackscatter = 0.046 / std::log(20.0);

/// A particle that is large compared to the wavelength has twice its cross-section as extinction:
/// integral of 2 pi / 4 D^2.
double extinction_of(const Particles& kind) {
  return 1e-6 * std::numbers::pi * kind.density_per_m3 / (kind.slope_per_mm * kind.slope_per_mm);
}

/// Reflectance of a disk equivalent to a particle with twice its cross-section as extinction and
/// the lidar ratio S: pi * 2 / S.
double reflectance_of(double lidar_ratio_sr) { return 2.0 * std::numbers::pi / lidar_ratio_sr; }

/// Marshall and Palmer 1948: 8000 exp(-4.1 R^-0.21 D) per m^3 and mm. Lidar ratio of drops: 18.8 sr
/// (O'Connor et al. 2004).
Particles rain_drops(double rate_mm_h) {
  if (!(rate_mm_h > 0)) return {};
  const double slope = 4.1 * std::pow(rate_mm_h, -0.21);
  return {8000.0 / slope, slope, reflectance_of(18.8)};
}

/// Gunn and Marshall 1958: 3800 R^-0.87 exp(-2.55 R^-0.48 D) with D of the melted drop. As a flake
/// of a tenth of the density of water it is 10^(1/3) times as wide. Lidar ratio of ice: 25 sr.
Particles snow_flakes(double rate_mm_h) {
  if (!(rate_mm_h > 0)) return {};
  const double melted_slope = 2.55 * std::pow(rate_mm_h, -0.48);
  const double density = 3800.0 * std::pow(rate_mm_h, -0.87) / melted_slope;
  return {density, melted_slope / std::cbrt(10.0), reflectance_of(25.0)};
}

/// Koschmieder: contrast falls to 2 % within the visibility, exp(-alpha V) = 0.02.
double fog_extinction_per_m(const Weather& weather) {
  const double visibility_m = weather.fog_visibility_m;
  return visibility_m > 0 && std::isfinite(visibility_m) ? 3.912 / visibility_m : 0.0;
}

}  // namespace

void check_weather(const Weather& weather, const LidarModel& sensor) {
  check_settings(weather);
  if (!(sensor.max_range_m > 0 && std::isfinite(sensor.max_range_m)))
    throw Error(ErrorKind::usage, "the sensor '" + sensor.name + "' has no maximum range");
}

bool Weather::is_clear() const { return extinction_per_m(*this) == 0; }

double extinction_per_m(const Weather& weather) {
  return extinction_of(rain_drops(weather.rain_mm_h)) + fog_extinction_per_m(weather) +
         extinction_of(snow_flakes(weather.snow_mm_h));
}

double reported_share(const Weather& weather, const LidarModel& sensor, double range_m,
                      double reflectance) {
  check_weather(weather, sensor);
  const double power =
      usable_reflectance(reflectance) / needed_reflectance(range_m, sensor.max_range_m);
  return reported_share(extinction_per_m(weather), range_m, power);
}

AirRules air_rules(const Weather& weather, const LidarModel& sensor,
                   std::vector<double>& expected) {
  check_weather(weather, sensor);
  AirRules air;
  expected.clear();
  air.extinction_per_m = extinction_per_m(weather);
  if (air.is_clear()) return air;
  air.white_intensity = weather.white_intensity;
  air.max_range_m = sensor.max_range_m;
  air.kinds[0] = rain_drops(weather.rain_mm_h);
  air.kinds[1] = snow_flakes(weather.snow_mm_h);
  air.fog_backscatter = kFogBackscatter * fog_extinction_per_m(weather);
  for (const int axis : {0, 1})
    air.divergence_rad[axis] =
        sensor.divergence_rad[axis] > 0 ? sensor.divergence_rad[axis] : kUsualDivergence_rad;
  air.begin_m = std::max(sensor.min_range_m, kMinAirRange_m);
  const double length_m = std::max(0.0, sensor.max_range_m - air.begin_m);
  const auto steps = static_cast<std::size_t>(std::ceil(length_m / kClutterStep_m));
  expected.push_back(0);
  for (std::size_t i = 0; i < steps; ++i) {
    const double range_m = air.begin_m + (static_cast<double>(i) + 0.5) * kClutterStep_m;
    expected.push_back(expected.back() + kClutterStep_m * clutter_rates(air, range_m).sum());
  }
  air.expected = expected.data();
  air.expected_count = static_cast<std::uint32_t>(expected.size());
  return air;
}

double clutter_share(const Weather& weather, const LidarModel& sensor, double range_m) {
  std::vector<double> expected;
  const AirRules air = air_rules(weather, sensor, expected);
  return air.is_clear() ? 0.0 : -std::expm1(-expected_within(air, range_m));
}

}  // namespace adasplats
