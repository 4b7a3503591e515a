// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Cells of directions in the frame of a sensor (x ahead, y left, z up). They replace the lasers of
/// a sensor whose lasers are unknown: its calibration has offsets of cells.
struct BeamCells {
  double azimuth_rad = 0, elevation_rad = 0;            ///< low bounds of the first cell
  double azimuth_step_rad = 0, elevation_step_rad = 0;  ///< size of a cell
  std::size_t columns = 0, rows = 0;

  bool empty() const { return columns == 0; }
  std::size_t size() const { return columns * rows; }
  /// Of a direction of any length; directions outside all cells belong to the nearest one.
  std::uint16_t of(Vec3d direction) const;
};

/// The cells that cover directions: 2 degrees wide and high, or rings of 0.5 degrees if the sensor
/// looks to all sides. Empty for no directions.
BeamCells cover_beams(std::span<const Vec3d> directions);

}  // namespace adasplats
