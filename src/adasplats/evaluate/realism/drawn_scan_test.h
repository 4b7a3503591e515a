// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/realism/ring_scan.h"

namespace adasplats::test {

/// The measurement of a beam of a synthetic scan.
struct DrawnReturn {
  double range_m;
  float intensity = 0.5F;
};

inline constexpr std::size_t kDrawnRings = 64;
inline constexpr std::size_t kDrawnColumns = 2048;
inline constexpr double kDrawnStep_rad = 2 * std::numbers::pi / kDrawnColumns;

/// From ring 0 at the top, 2 degrees up, to 25 degrees down.
inline double drawn_elevation_rad(std::size_t ring) {
  return (2 - 27.0 * static_cast<double>(ring) / (kDrawnRings - 1)) * std::numbers::pi / 180;
}

inline Vec3d drawn_direction(std::size_t ring, std::size_t column) {
  // Clockwise from the rear, half a step from the seam.
  const double azimuth_rad =
      std::numbers::pi - (static_cast<double>(column) + 0.5) * kDrawnStep_rad;
  const double flat = std::cos(drawn_elevation_rad(ring));
  return {flat * std::cos(azimuth_rad), flat * std::sin(azimuth_rad),
          std::sin(drawn_elevation_rad(ring))};
}

/// A scan with beams from the origin and measurements from `beam`; nothing: no return.
inline KittiScan drawn_points(
    const std::function<std::optional<DrawnReturn>(std::size_t ring, std::size_t column)>& beam) {
  KittiScan scan;
  for (std::size_t ring = 0; ring < kDrawnRings; ++ring) {
    for (std::size_t column = 0; column < kDrawnColumns; ++column) {
      const std::optional<DrawnReturn> measured = beam(ring, column);
      if (!measured) continue;
      scan.positions.push_back(vec_cast<float>(measured->range_m * drawn_direction(ring, column)));
      scan.intensities.push_back(measured->intensity);
      scan.origins.push_back({});
      scan.lasers.push_back(static_cast<std::uint16_t>(ring));
    }
  }
  return scan;
}

/// All beams of a drawn scan leave the origin.
inline const std::vector<double> kDrawnHeights_m(kDrawnRings, 0);

/// The same arranged, with missing beams counted.
inline RingScan drawn_scan(
    const std::function<std::optional<DrawnReturn>(std::size_t ring, std::size_t column)>& beam) {
  RingScan scan = arrange_in_rings({}, 0, drawn_points(beam), kDrawnHeights_m);
  count_missing(scan, kDrawnStep_rad);
  return scan;
}

/// Random numbers of one beam.
inline Random of_beam(std::uint64_t seed, std::size_t ring, std::size_t column) {
  return {seed, 6, ring * kDrawnColumns + column};
}

}  // namespace adasplats::test
