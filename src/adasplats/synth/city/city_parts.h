// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/synth/city/city_grid.h"
#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/world/world_parts.h"

// Inside synth/city/: what a street of a city has beside that of a world: crossings at its ends,
// parks and squares along it.

namespace adasplats {

/// What a street that crosses takes of the one it crosses.
struct CityCrossing {
  double reach_m = 0;  ///< from the middle of the crossing to the end of its sidewalk
};

/// The quarter of a crossing on one side of a piece of an east street, at its beginning or its end:
/// appends the street to the north and its sidewalk up to the rim of the piece, and what is
/// painted. `profile` is the bare plan of the piece.
CityCrossing add_crossing(const CityGrid& grid, const CityPieceId& id, const WorldPlan& profile,
                          int side, bool at_end, std::vector<Patch>& patches);
/// Lights or signs at the corners of the crossings of a piece.
void add_crossing_furniture(const CityGrid& grid, const CityPieceId& id, const WorldPlan& plan,
                            MeshBuilder& builder);

/// The ground of parks and squares.
void add_open_ground(const CityPieceId& id, const WorldPlan& profile,
                     const std::vector<WorldPlot>& plots, std::vector<Patch>& patches);
/// Trees, benches, lamps, stalls and people of parks and squares. Instance ids from `instance`;
/// returns the first that is free.
std::uint16_t add_open_places(const CityGrid& grid, const CityPieceId& id, const WorldPlan& plan,
                              std::uint16_t instance, MeshBuilder& builder);

}  // namespace adasplats
