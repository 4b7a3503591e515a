// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/synth/city/city_grid.h"
#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/world/world_parts.h"

// Private to synth/city/: additions to the streets of a world: crossings at both ends, parks and
// squares.

namespace adasplats {

/// The area that a crossing street occupies.
struct CityCrossing {
  double reach_m = 0;  ///< from the center of the crossing to the end of its sidewalk
};

/// The quarter of a crossing on one side of an east section, at its begin or end: appends the north
/// street with its sidewalk up to the edge of the section, and the road markings. `profile` is the
/// bare plan of the section.
CityCrossing add_crossing(const CityGrid& grid, const CityPieceId& id, const WorldPlan& profile,
                          int side, bool at_end, std::vector<Patch>& patches);
/// Traffic lights or signs at the corners of a section's crossings.
void add_crossing_furniture(const CityGrid& grid, const CityPieceId& id, const WorldPlan& plan,
                            MeshBuilder& builder);

/// Ground patches of parks and squares.
void add_open_ground(const CityPieceId& id, const WorldPlan& profile,
                     const std::vector<WorldPlot>& plots, std::vector<Patch>& patches);
/// Trees, benches, lamps, stalls and people in parks and squares. Instance ids start at `instance`;
/// returns the first unused one.
std::uint16_t add_open_places(const CityGrid& grid, const CityPieceId& id, const WorldPlan& plan,
                              std::uint16_t instance, MeshBuilder& builder);

}  // namespace adasplats
