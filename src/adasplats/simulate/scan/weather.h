// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "adasplats/core/setting.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/air.h"

namespace adasplats {

/// Weather: rain, fog and snow. Formulas, constants and their sources: docs/noise.md.
struct Weather {
  double rain_mm_h = 0;
  /// Meteorological visibility (2 % contrast); 0 or infinite: no fog.
  double fog_visibility_m = std::numeric_limits<double>::infinity();
  double snow_mm_h = 0;  ///< of melted water
  /// Intensity of a white wall (reflectance 1) in the unit of the scan's intensities.
  double white_intensity = 1;

  bool is_clear() const;
};

/// Above the highest rate ever measured: 38 mm in a minute (Barot, Guadeloupe, 1970; WMO).
inline constexpr double kMaxRain_mm_h = 3000;

template <class Visit>
void visit_settings(Weather& weather, Visit&& visit) {
  constexpr const char* kGroup = "Weather";
  visit(Setting{.name = "rain",
                .help = "Rain rate, mm/h",
                .value = "MM/H",
                .key = "rain_mm_h",
                .group = kGroup,
                .min = 0,
                .max = kMaxRain_mm_h},
        weather.rain_mm_h);
  visit(Setting{.name = "fog",
                .help = "Visibility in fog, m",
                .value = "M",
                .key = "fog_visibility_m",
                .group = kGroup,
                .min = 0,
                .max = std::numeric_limits<double>::infinity()},
        weather.fog_visibility_m);
  visit(Setting{.name = "snow",
                .help = "Snow rate, mm/h of water",
                .value = "MM/H",
                .key = "snow_mm_h",
                .group = kGroup,
                .min = 0,
                .max = kMaxRain_mm_h},
        weather.snow_mm_h);
  visit(Setting{.name = "white_intensity",
                .help = "Intensity of a white wall in the units of the model, for the effects of "
                        "weather (1, or 100 for intensities stored as bytes)",
                .value = "I",
                .group = kGroup,
                .min = 0,
                .exclusive_min = true},
        weather.white_intensity);
}

/// Extinction coefficient of the air, 1/m: the sum of the three.
double extinction_per_m(const Weather& weather);

/// Probability that a return reported in clear air is still reported. A sensor needs the
/// reflectance n(r) = max(0.8 (r / max_range)^2, 0.005). In clear air it receives m = reflectance /
/// n(r) times the required power, in weather exp(-2 alpha r) of that, with exponential fluctuations
/// (speckle): exp(-(exp(2 alpha r) - 1) / m). Reflectances below 0.01 count as 0.01, NaN as 0.3.
double reported_share(const Weather& weather, const LidarModel& sensor, double range_m,
                      double reflectance);

/// Probability that a drop, a flake or fog closer than `range_m` is reported.
double clutter_share(const Weather& weather, const LidarModel& sensor, double range_m);

/// Errors: usage (a setting out of range, no maximum range).
void check_weather(const Weather& weather, const LidarModel& sensor);

/// The effect of weather on a beam. Intensities decrease by exp(-2 alpha r); returns are lost
/// (reported_share); the range noise grows by exp(alpha r); particles in the air cause returns
/// closer than the farthest return of their firing (clutter_share), with class and instance 0.
/// in_air() of firing_report.h applies the rules to the returns of a firing. Their table is stored
/// in `expected`, which must outlive them. Errors: those of check_weather().
AirRules air_rules(const Weather& weather, const LidarModel& sensor, std::vector<double>& expected);

}  // namespace adasplats
