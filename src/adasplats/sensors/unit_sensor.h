// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "adasplats/sensors/ray_drop_model.h"
#include "adasplats/sensors/unit_fields.h"
#include "adasplats/sensors/unit_intensity.h"
#include "adasplats/sensors/vehicle_body.h"

namespace adasplats {

/// What one unit measures beside the table of its kind, ring by ring (topmost 0), to be added to
/// what it reports; rings behind the end have none.
struct UnitOffsets {
  std::span<const double> range_m;
  std::span<const double> elevation_rad;
};

/// What else is of one unit (fit_unit()).
struct UnitTraits {
  std::span<const double> ring_noise_m;  ///< topmost first; empty: not known
  std::optional<double> max_range_m;
  const UnitIntensity* intensity = nullptr;
  const UnitFields* fields = nullptr;
  const RayDropModel* drop = nullptr;
  const VehicleBody* body = nullptr;
  std::string fitted_to;  ///< for the reader of the file
};

/// The file of one unit of a sensor of the library (TOML, as load_lidar_model reads it): its keys
/// with the elevations corrected, and range_offsets_m. Elevations to 1e-5 degrees, ranges to 0.01
/// mm. Errors: usage (unknown name); std::logic_error for a sensor without beams or more offsets
/// than beams.
std::string unit_sensor_toml(const std::string& library_name, const UnitOffsets& offsets,
                             const UnitTraits& traits = {});

}  // namespace adasplats
