// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/beam_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "adasplats/core/constants.h"

namespace adasplats {
namespace {

double azimuth_of(Vec3d direction) { return std::atan2(direction.y, direction.x); }
double elevation_of(Vec3d direction) {
  return std::atan2(direction.z, std::hypot(direction.x, direction.y));
}

std::size_t cell_along(double value, double low, double step, std::size_t count) {
  const double cell = std::floor((value - low) / step);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
}

/// Share of the full circle with directions, in steps of a degree.
double covered_share(const std::vector<double>& azimuths_rad) {
  constexpr std::size_t kDegrees = 360;
  std::vector<bool> seen(kDegrees);
  for (const double azimuth_rad : azimuths_rad)
    seen[cell_along(azimuth_rad, -std::numbers::pi, kDegree, kDegrees)] = true;
  return static_cast<double>(std::ranges::count(seen, true)) / kDegrees;
}

}  // namespace

std::uint16_t BeamCells::of(Vec3d direction) const {
  const std::size_t column =
      cell_along(azimuth_of(direction), azimuth_rad, azimuth_step_rad, columns);
  const std::size_t row =
      cell_along(elevation_of(direction), elevation_rad, elevation_step_rad, rows);
  return static_cast<std::uint16_t>(row * columns + column);
}

BeamCells cover_beams(std::span<const Vec3d> directions) {
  constexpr double kCell_rad = 2 * kDegree, kRing_rad = 0.5 * kDegree, kAllRound = 0.9;
  BeamCells cells;
  if (directions.empty()) return cells;
  std::vector<double> azimuths_rad, elevations_rad;
  for (const Vec3d direction : directions) {
    azimuths_rad.push_back(azimuth_of(direction));
    elevations_rad.push_back(elevation_of(direction));
  }
  const auto [first, last] = std::ranges::minmax(azimuths_rad);
  const auto [low, high] = std::ranges::minmax(elevations_rad);
  const bool is_all_round = covered_share(azimuths_rad) > kAllRound;
  cells.azimuth_rad = is_all_round ? -std::numbers::pi : first;
  cells.azimuth_step_rad = is_all_round ? 2 * std::numbers::pi : kCell_rad;
  cells.elevation_rad = low;
  cells.elevation_step_rad = is_all_round ? kRing_rad : kCell_rad;
  const auto count = [](double span, double step) {
    return static_cast<std::size_t>(span / step) + 1;
  };
  cells.columns = is_all_round ? 1 : count(last - first, kCell_rad);
  cells.rows = count(high - low, cells.elevation_step_rad);
  return cells;
}

}  // namespace adasplats
