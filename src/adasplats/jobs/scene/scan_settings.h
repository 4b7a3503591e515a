// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/sensor_overrides.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

/// How scans are simulated: everything but the scene and the poses.
struct ScanSettings : SimulateOptions {
  LidarModel sensor;
};

/// Errors: usage (those of check_beam and check_weather).
void check(const ScanSettings& settings);

/// The ray drop that a user chose: a file; "none"; empty: the one of the sensor's file. Errors:
/// those of load_ray_drop.
std::optional<RayDropModel> load_ray_drop_choice(const std::filesystem::path& choice,
                                                 const LidarModel& sensor);
/// Whether the choice is a file.
bool is_ray_drop_file(const std::filesystem::path& choice);

/// Settings as users give them: with names of files instead of their content, and with differences
/// from the sensor's own values. `ray_drop` and `seed` of the base are set by settings().
struct ScanChoice : SimulateOptions {
  std::string sensor = kDefaultSensor;  ///< as for load_lidar_model
  SensorOverrides overrides;
  std::filesystem::path ray_drop_file;  ///< as for load_ray_drop_choice

  /// Errors: those of load_lidar_model, load_ray_drop and check().
  ScanSettings settings(std::uint64_t with_seed) const;
  /// With another sensor than `sensor`.
  ScanSettings settings_of(LidarModel model, std::uint64_t with_seed) const;
};

/// Everything but the sensor.
template <class Visit>
void visit_settings(ScanChoice& scan, Visit&& visit) {
  constexpr const char* kGroup = "Sensor";
  visit(Setting{.name = "points",
                .help = "Coordinates of the points with --rolling-shutter: as measured, or "
                        "motion-compensated",
                .group = kGroup},
        scan.frame);
  visit(Setting{.name = "noise",
                .help = "Simulate the sensor's noise of ranges and angles",
                .opposite = "no-noise",
                .group = kGroup,
                .basic = true},
        scan.noise);
  visit(Setting{.name = "sensor_offsets",
                .help = "Apply the calibrated range offsets of the sensor's rings (range_offsets_m "
                        "of its file)",
                .group = kGroup},
        scan.sensor_offsets);
  visit_settings(scan.overrides, visit);
  visit_settings(scan.beam, visit);
  visit(Setting{.name = "ray_drop",
                .help = "Model of lost beams: a file of 'adasplats fit-drop', or 'none' to ignore "
                        "[drop] in the sensor's file",
                .group = kGroup},
        scan.ray_drop_file);
  visit(Setting{.name = "vehicle_body",
                .help = "Simulate returns from the recording vehicle if the sensor's file "
                        "describes it ([body])",
                .opposite = "no-vehicle-body",
                .group = kGroup},
        scan.vehicle_body);
  visit_settings(scan.weather, visit);
}

}  // namespace adasplats
