// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/sensor_overrides.h"

namespace adasplats {

void SensorOverrides::apply(LidarModel& sensor) const {
  sensor.range_noise_m = range_noise_m.value_or(sensor.range_noise_m);
  if (range_noise_m) sensor.ring_noise_m.clear();
  sensor.min_range_m = min_range_m.value_or(sensor.min_range_m);
  sensor.max_range_m = max_range_m.value_or(sensor.max_range_m);
  sensor.rotation_hz = rotation_hz.value_or(sensor.rotation_hz);
}

}  // namespace adasplats
