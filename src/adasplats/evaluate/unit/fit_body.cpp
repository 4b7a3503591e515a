// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The parts of the vehicle that the beams of its sensor hit.

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "adasplats/core/maths/median.h"
#include "adasplats/evaluate/unit/fit_unit.h"

namespace adasplats {
namespace {

constexpr float kFarthest_m = 4, kBeforeModel_m = 0.5F, kOneRange_m = 0.2F;

bool is_blocked(const SensorBeam& beam) {
  if (!beam.returned() || beam.range_m > kFarthest_m) return false;
  return !beam.hit || beam.range_m < beam.expected_m - kBeforeModel_m;
}

/// The beams of one ring in half a degree.
struct CellBeams {
  std::size_t beams = 0;
  std::set<std::uint32_t> places, places_with_returns;
  std::vector<float> ranges_m, intensities;  // of blocked beams

  void add(const SensorBeam& beam) {
    ++beams;
    places.insert(beam.place);
    if (!is_blocked(beam)) return;
    places_with_returns.insert(beam.place);
    ranges_m.push_back(beam.range_m);
    if (beam.intensity == beam.intensity) intensities.push_back(beam.intensity);
  }
  bool is_static() {
    const std::size_t seen = places_with_returns.size();
    if (seen < kMinBlockedPlaces || 2 * seen < places.size()) return false;
    std::ranges::sort(ranges_m);
    const auto at = [&](std::size_t tenths) {
      return ranges_m[(ranges_m.size() - 1) * tenths / 10];
    };
    return at(9) - at(1) < kOneRange_m;
  }
};

float middle_of(std::vector<float>& values) { return values.empty() ? 0 : upper_median_of(values); }

}  // namespace

std::optional<VehicleBody> fit_vehicle_body(std::span<const SensorBeam> beams) {
  std::map<std::pair<std::uint16_t, std::uint32_t>, CellBeams> cells;
  std::set<std::uint32_t> places;
  for (const SensorBeam& beam : beams) {
    places.insert(beam.place);
    if (is_blocked(beam)) cells[{beam.ring, body_column(beam.direction)}];
  }
  if (places.size() < kMinBlockedPlaces) return std::nullopt;
  for (const SensorBeam& beam : beams) {
    const auto cell = cells.find({beam.ring, body_column(beam.direction)});
    if (cell != cells.end()) cell->second.add(beam);
  }
  VehicleBody body;
  for (auto& [place, cell] : cells) {
    if (!cell.is_static()) continue;
    const auto returns = static_cast<float>(cell.ranges_m.size());
    body.cells.push_back({place.first, static_cast<std::uint16_t>(place.second),
                          returns / static_cast<float>(cell.beams), middle_of(cell.ranges_m),
                          middle_of(cell.intensities)});
  }
  return body;
}

}  // namespace adasplats
