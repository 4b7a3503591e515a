// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Half degrees of a turn, counted counter-clockwise from the rear (-x).
inline constexpr std::uint32_t kBodyColumns = 720;
/// Of a direction in the sensor's frame.
std::uint32_t body_column(Vec3f direction);
/// Where one begins, counter-clockwise from +x, -180 to 179.5.
double body_azimuth_deg(std::uint32_t column);

/// What the beams of a ring measure in half a degree of azimuth where they meet the sensor's own
/// carrier: a roof, a mirror, a rack. It stands still in the sensor's frame, so no model of a place
/// has it.
struct BodyCell {
  std::uint16_t ring = 0;    ///< topmost 0
  std::uint16_t column = 0;  ///< body_column()
  float share = 0;           ///< of the beams that return from it, 0..1; others pass it
  float range_m = 0;
  float intensity = 0;  ///< in the unit of the sensor's; 0 where it reports none
};

/// All of one unit on its carrier, by ring, then column.
struct VehicleBody {
  std::vector<BodyCell> cells;

  /// Number of the cell that a beam meets; cells.size(): none.
  std::size_t find(std::uint16_t ring, Vec3f direction) const;
};

/// The keys of a TOML table: cells, rows of ring, azimuth_deg, percent, range_mm, intensity.
std::string vehicle_body_toml(const VehicleBody& body);

}  // namespace adasplats
