// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/scan_settings.h"

#include <utility>

#include "adasplats/core/error.h"

namespace adasplats {

bool is_ray_drop_file(const std::filesystem::path& choice) {
  return !choice.empty() && choice != "none";
}

std::optional<RayDropModel> load_ray_drop_choice(const std::filesystem::path& choice,
                                                 const LidarModel& sensor) {
  if (is_ray_drop_file(choice)) return load_ray_drop(choice);
  return choice.empty() ? sensor.drop : std::nullopt;
}

void check(const ScanSettings& settings) {
  const LidarModel& sensor = settings.sensor;
  check_settings(SensorOverrides{sensor.range_noise_m, sensor.min_range_m, {}, sensor.rotation_hz});
  if (!(sensor.min_range_m < sensor.max_range_m))
    throw Error(ErrorKind::usage, "min_range must be less than max_range");
  if (settings.sensor_offsets && sensor.range_offsets_m.empty())
    throw Error(ErrorKind::usage, "`sensor_offsets` has no effect: the sensor '" + sensor.name +
                                      "' has no range_offsets_m");
  check_beam(settings.beam, settings.sensor);
  check_weather(settings.weather, settings.sensor);
}

ScanSettings ScanChoice::settings(std::uint64_t with_seed) const {
  return settings_of(load_lidar_model(sensor), with_seed);
}

ScanSettings ScanChoice::settings_of(LidarModel model, std::uint64_t with_seed) const {
  ScanSettings settings{*this, std::move(model)};
  settings.seed = with_seed;
  overrides.apply(settings.sensor);
  check(settings);
  settings.ray_drop = load_ray_drop_choice(ray_drop_file, settings.sensor);
  return settings;
}

}  // namespace adasplats
