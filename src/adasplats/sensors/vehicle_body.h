// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Columns of half a degree, counter-clockwise from the rear (-x).
inline constexpr std::uint32_t kBodyColumns = 720;
/// The column of a direction in the sensor's frame.
std::uint32_t body_column(Vec3f direction);
/// Where a column begins, counter-clockwise from +x, -180 to 179.5.
double body_azimuth_deg(std::uint32_t column);

/// Returns of one ring in one column from the sensor's own vehicle: a roof, a mirror, a rack. The
/// vehicle does not move in the sensor's frame, so no model of a scene contains it.
struct BodyCell {
  std::uint16_t ring = 0;    ///< topmost 0
  std::uint16_t column = 0;  ///< body_column()
  float share = 0;           ///< of the beams that it reflects, 0..1; the others pass
  float range_m = 0;
  float intensity = 0;  ///< in the sensor's intensity unit; 0 if it reports none
};

/// A box of the vehicle, such as its roof, that no beam passes.
struct BodyBox {
  RigidTransform sensor_from_box;  ///< the box's centre and axes
  Vec3d half_size_m;
};

/// All cells of a calibrated sensor on its vehicle, by ring, then column; and boxes.
struct VehicleBody {
  std::vector<BodyCell> cells;
  std::vector<BodyBox> boxes;

  /// Index of the cell that a beam hits; cells.size(): none.
  std::size_t find(std::uint16_t ring, Vec3f direction) const;
  /// Distance at which a ray in the sensor's frame enters the nearest box, in lengths of
  /// `direction`; 0: it begins in a box; infinite: it misses all.
  double range_to_boxes(Vec3d origin, Vec3d direction) const;
};

/// The keys of a TOML table: cells, rows of ring, azimuth_deg, percent, range_mm, intensity.
std::string vehicle_body_toml(const VehicleBody& body);

}  // namespace adasplats
