// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/sensor_overrides.h"

#include <cmath>
#include <cstdint>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/setting.h"
#include "adasplats/sensors/packet_layout.h"

namespace adasplats {
namespace {

/// Whether the time from one column to the next does not depend on the rotation rate: user manuals
/// of Velodyne ("firing sequence", 55.296 us for a VLP-16) and Hesai ("firing rate").
bool fires_at_fixed_times(const LidarModel& sensor) {
  return sensor.packets && !is_ouster(sensor.packets->format) && !sensor.packets->mirror;
}

/// Errors: usage (no whole number of columns; listed firings).
void change_columns(double rotation_hz, LidarModel& sensor) {
  const std::string rate =
      "a rotation rate of " + std::to_string(rotation_hz) + " Hz: sensor '" + sensor.name + "' ";
  if (!sensor.free_pattern.empty())
    throw Error(ErrorKind::usage,
                rate + "has a list of firings; set rotation_hz and columns in its file instead");
  constexpr double kMaxColumns = 1e5, kTolerance = 0.01;
  const double columns = sensor.columns * (sensor.rotation_hz / rotation_hz);
  if (!(columns <= kMaxColumns && std::fabs(std::round(columns) / columns - 1) <= kTolerance))
    throw Error(ErrorKind::usage, rate + "fires at fixed times and would have " +
                                      std::to_string(columns) + " columns a revolution");
  sensor.columns = static_cast<std::uint32_t>(std::lround(columns));
}

}  // namespace

void SensorOverrides::apply(LidarModel& sensor) const {
  check_settings(*this);
  sensor.range_noise_m = range_noise_m.value_or(sensor.range_noise_m);
  if (range_noise_m) sensor.ring_noise_m.clear();
  sensor.min_range_m = min_range_m.value_or(sensor.min_range_m);
  sensor.max_range_m = max_range_m.value_or(sensor.max_range_m);
  if (!rotation_hz || *rotation_hz == sensor.rotation_hz) return;
  if (fires_at_fixed_times(sensor)) change_columns(*rotation_hz, sensor);
  sensor.rotation_hz = *rotation_hz;
}

}  // namespace adasplats
