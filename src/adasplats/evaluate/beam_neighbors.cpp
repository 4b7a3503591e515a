// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/beam_neighbors.h"

namespace adasplats {
namespace {

std::vector<std::array<std::uint32_t, 4>> neighbors_on_rings(const LidarModel& sensor) {
  std::vector<std::array<std::uint32_t, 4>> neighbors(sensor.free_pattern.size(),
                                                      {kNoBeam, kNoBeam, kNoBeam, kNoBeam});
  std::vector<std::uint32_t> last_of_ring(sensor.rings(), kNoBeam);
  for (std::uint32_t i = 0; i < neighbors.size(); ++i) {
    std::uint32_t& last = last_of_ring[sensor.free_pattern[i].ring];
    if (last != kNoBeam) {
      neighbors[i][0] = last;
      neighbors[last][1] = i;
    }
    last = i;
  }
  return neighbors;
}

}  // namespace

std::vector<std::array<std::uint32_t, 4>> beam_neighbors(const LidarModel& sensor) {
  if (!sensor.free_pattern.empty()) return neighbors_on_rings(sensor);
  const std::uint32_t columns = sensor.columns;
  const auto rings = static_cast<std::uint32_t>(sensor.rings());
  std::vector<std::array<std::uint32_t, 4>> neighbors;
  neighbors.reserve(sensor.rays_per_scan());
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t first = ring * columns;
      neighbors.push_back({first + (column + columns - 1) % columns, first + (column + 1) % columns,
                           ring > 0 ? first - columns + column : kNoBeam,
                           ring + 1 < rings ? first + columns + column : kNoBeam});
    }
  }
  return neighbors;
}

}  // namespace adasplats
