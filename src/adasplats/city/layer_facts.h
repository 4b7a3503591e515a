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

/// What is known of a tile's points when all are written.
struct TileCount {
  std::size_t points = 0;
  std::size_t empty_beams = 0;
  /// Holds the points and where they were measured from: what their rays can cross.
  GroundBox rays = kNoGround;
};

/// What is known of the points of a city that were read at one time: a layer of them.
struct LayerFacts {
  Vec3d origin;  ///< of all clouds and models of the city's tiles, world coordinates
  CurveBox box;
  std::size_t points_read = 0;
  /// Measured ones that stay. Where a network gives the points classes it is 0 in the file, and
  /// comes from that of the classes.
  std::size_t rays = 0;
  float empty_reach_m = 0;
  std::string attributes;  ///< as TilePointsWriter::attributes() says
  std::map<TileKey, TileCount> tiles;
};

/// As a file of JSON has it.
std::string text_of(const LayerFacts& facts);
/// Errors: no_input, data (damaged).
LayerFacts load_facts(const std::filesystem::path& file);

}  // namespace adasplats
