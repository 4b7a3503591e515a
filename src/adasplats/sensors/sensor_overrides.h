// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "adasplats/core/setting.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// Settings that replace a sensor's own values.
struct SensorOverrides {
  std::optional<double> range_noise_m;
  std::optional<double> min_range_m;
  std::optional<double> max_range_m;
  std::optional<double> rotation_hz;

  /// At another rotation rate, spinning sensors of Velodyne and Hesai fire as often as before, so
  /// they have more or fewer columns; an Ouster has those of its mode. Errors: usage (a value out
  /// of range; a rate that such a sensor cannot have).
  void apply(LidarModel& sensor) const;
};

/// No LiDAR measures farther in an atmosphere; a larger value is a mistake, such as a wrong unit.
inline constexpr double kFarthestSensed_m = 1e6;

template <class Visit>
void visit_settings(SensorOverrides& sensor, Visit&& visit) {
  constexpr const char* kGroup = "Sensor";
  visit(Setting{.name = "range_noise",
                .help = "Standard deviation of the range noise, m (default: the sensor's)",
                .value = "M",
                .key = "range_noise_m",
                .group = kGroup,
                .min = 0,
                .max = 1000},
        sensor.range_noise_m);
  visit(Setting{.name = "min_range",
                .help = "Minimum range, m (default: the sensor's)",
                .value = "M",
                .key = "min_range_m",
                .group = kGroup,
                .min = 0,
                .max = kFarthestSensed_m},
        sensor.min_range_m);
  visit(Setting{.name = "max_range",
                .help = "Maximum range, m (default: the sensor's)",
                .value = "M",
                .key = "max_range_m",
                .group = kGroup,
                .min = 0,
                .max = kFarthestSensed_m,
                .exclusive_min = true},
        sensor.max_range_m);
  visit(Setting{.name = "rotation_rate",
                .help = "Revolutions per second (default: the sensor's)",
                .value = "HZ",
                .key = "rotation_hz",
                .group = kGroup,
                .min = 1e-3,
                .max = 1e4},
        sensor.rotation_hz);
}

}  // namespace adasplats
