// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/error.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/sensors/sensor_overrides.h"

namespace adasplats {

void check(const ScanSettings& settings) {
  const LidarModel& sensor = settings.sensor;
  check_settings(SensorOverrides{sensor.range_noise_m, sensor.min_range_m, {}, sensor.rotation_hz});
  if (!(sensor.min_range_m < sensor.max_range_m))
    throw Error(ErrorKind::usage, "min_range must be less than max_range");
  if (settings.unit_offsets && sensor.range_offsets_m.empty())
    throw Error(ErrorKind::usage, "`unit_offsets` has no effect: the sensor '" + sensor.name +
                                      "' has no range_offsets_m");
  check_beam(settings.beam, settings.sensor);
  check_weather(settings.weather, settings.sensor);
}

}  // namespace adasplats
