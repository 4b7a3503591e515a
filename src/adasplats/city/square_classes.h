// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "adasplats/city/tile_grid.h"

namespace adasplats {

/// The classes that a network gave the points of some squares, which are not the tiles.
struct SquareClasses {
  std::size_t squares = 0, cells = 0;  ///< that the network saw
  /// By the tile that the points stand in, in the order of its file of points.
  std::map<TileKey, std::vector<std::uint16_t>> of_tile;
};

/// "points/NAME.squares" below the folder of a city: of the squares whose middle is in a tile.
std::string squares_file_of(TileKey tile);
void write_square_classes(const std::filesystem::path& file, const SquareClasses& classes);
/// Errors: no_input, data (damaged).
SquareClasses read_square_classes(const std::filesystem::path& file);

}  // namespace adasplats
