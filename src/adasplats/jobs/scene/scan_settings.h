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
  visit(Setting{.name = "points",
                .help = "With a rolling shutter: as measured, or with the motion taken out"},
        scan.frame);
  visit(Setting{.name = "noise",
                .help = "Noise of the sensor on ranges and angles",
                .opposite = "no-noise,no-range-noise"},
        scan.noise);
  visit(Setting{.name = "unit_offsets",
                .help =
                    "Report ranges with the offsets of the sensor's rings (range_offsets_m of its "
                    "file), as that very unit does"},
        scan.unit_offsets);
  visit_settings(scan.overrides, visit);
  visit_settings(scan.beam, visit);
  visit(Setting{.name = "ray_drop",
                .help = "Beams that get lost as a real sensor's: a file of 'adasplats fit-drop'; "
                        "'none': no beam, though the sensor's file says which ([drop])"},
        scan.ray_drop_file);
  visit(Setting{.name = "vehicle_body",
                .help = "Returns from what carries the sensor, where its file has them ([body])",
                .opposite = "no-vehicle-body"},
        scan.vehicle_body);
  visit_settings(scan.weather, visit);
}

}  // namespace adasplats
