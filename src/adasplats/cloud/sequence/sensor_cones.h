// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// The cones that the beams of a turning sensor sweep about its axis, z of the sensor's frame.
struct SensorCones {
  struct Cone {
    double elevation_rad;
    double height_m;       ///< of its tip on the axis
    double outward_m = 0;  ///< where the beam begins, from the axis along its own azimuth
    double aside_m = 0;    ///< and to the left of it
  };

  std::string sensor;       ///< name of the model
  std::vector<Cone> cones;  ///< topmost first

  /// The laser whose cone is nearest in elevation, topmost 0, and how far above it `point` (in the
  /// sensor's frame) is seen from the cone's tip, rad. For points 3 m away or farther. Needs a
  /// cone.
  std::pair<std::uint16_t, double> nearest(Vec3d point) const;

  /// Where the beam of a laser begins that measured `point`, both in the sensor's frame.
  Vec3d origin_of(std::uint16_t laser, Vec3d point) const;
};

/// Without cones where a beam changes its elevation as the sensor turns (rosettes).
SensorCones cones_of(const LidarModel& model);

/// Of the library's sensors that have cones and that a maker sells, by name.
std::vector<SensorCones> library_cones();

}  // namespace adasplats
