// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/sensor_overrides.h"

#include <algorithm>
#include <cmath>

#include "adasplats/sensors/packet_layout.h"

namespace adasplats {
namespace {

/// Whether the time from one column to the next does not depend on the rotation rate: user manuals
/// of Velodyne ("firing sequence", 55.296 us for a VLP-16) and Hesai ("firing rate").
bool fires_at_fixed_times(const LidarModel& sensor) {
  return sensor.packets && !is_ouster(sensor.packets->format) && !sensor.packets->mirror &&
         sensor.free_pattern.empty();
}

}  // namespace

void SensorOverrides::apply(LidarModel& sensor) const {
  sensor.range_noise_m = range_noise_m.value_or(sensor.range_noise_m);
  if (range_noise_m) sensor.ring_noise_m.clear();
  sensor.min_range_m = min_range_m.value_or(sensor.min_range_m);
  sensor.max_range_m = max_range_m.value_or(sensor.max_range_m);
  if (!rotation_hz || *rotation_hz == sensor.rotation_hz) return;
  if (fires_at_fixed_times(sensor)) {
    const double columns = sensor.columns * (sensor.rotation_hz / *rotation_hz);
    constexpr double kMaxColumns = 1e6;
    sensor.columns = static_cast<std::uint32_t>(std::lround(std::clamp(columns, 1.0, kMaxColumns)));
  }
  sensor.rotation_hz = *rotation_hz;
}

}  // namespace adasplats
