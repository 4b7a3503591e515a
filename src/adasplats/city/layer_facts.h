// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include "adasplats/city/tile_grid.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats {

/// Figures of a tile's points after all have been written.
struct TileCount {
  std::size_t points = 0;
  std::size_t empty_beams = 0;
  /// Contains the points and their sensor positions, and so everything that their rays can cross.
  GroundBox rays = kNoGround;
};

/// Figures of a layer: the points of a city that were read together.
struct LayerFacts {
  Vec3d origin;  ///< of all clouds and models of the city's tiles, world coordinates
  CurveBox box;
  std::size_t points_read = 0;
  /// Measured rays of the remaining points. If a network classifies the points, it is 0 in this
  /// file and taken from the file of the classes.
  std::size_t rays = 0;
  float empty_reach_m = 0;
  std::string attributes;  ///< see TilePointsWriter::attributes()
  std::map<TileKey, TileCount> tiles;
};

/// JSON text.
std::string text_of(const LayerFacts& facts);
/// Errors: no_input, data (damaged).
LayerFacts load_facts(const std::filesystem::path& file);

}  // namespace adasplats
