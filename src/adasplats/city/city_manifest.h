// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/city/tile_grid.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/splats/model/any_model.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

/// Of a city's folder: its tiles.
inline constexpr const char* kCityFile = "city.json";
/// What all tiles have in common, a model without splats.
inline constexpr const char* kCityCommonFile = "common.ply";

/// One tile of a city that was modelled.
struct CityTile {
  TileKey key;
  std::size_t points = 0;
  std::size_t splats = 0;
  std::string sha256;  ///< of its file
  Vec3d low, high;     ///< box of its splats, world coordinates; zeros without
};

/// How many splats a tile has, and their box.
void set_splats(const SplatModel& model, CityTile& tile);

/// The model of a city: a folder of tiles, each a model of its own with the splats that stand in
/// it, all with the same local origin.
struct CityManifest {
  TileGrid grid;
  Vec3d origin;                 ///< local origin of the whole, world coordinates
  double halo_m = 0;            ///< around a tile what it was modelled with
  std::vector<CityTile> tiles;  ///< by their keys

  std::size_t points() const;
  std::size_t splats() const;
};

/// The file of a tile's model, below the folder of the city.
std::string model_file_of(TileKey tile);

/// Whether a path is the folder of a city's model.
bool is_city(const std::filesystem::path& path);

std::string city_text(const CityManifest& city);
/// Errors: no_input, data (damaged, or of another version).
CityManifest load_city_manifest(const std::filesystem::path& folder);

/// Says which tile a splat with its middle there belongs to: the one it stands in, or where that is
/// none of the city's, a neighbour that is.
TileKey owner_of(Vec3d world, const TileGrid& grid, const std::vector<CityTile>& tiles);

/// The splats of tile `k` of CityManifest::tiles, relative to the city's origin. Errors: data (not
/// as many as the manifest says, or beyond the tile's box there), those of load_model.
SplatModel load_city_tile(const std::filesystem::path& folder, const CityManifest& city,
                          std::size_t k);

/// The city as one model, tile after tile. Errors: data (a tile has not as many splats as the
/// manifest says), those of load_model.
SplatModel load_city(const std::filesystem::path& folder);

/// A model, of one file or the folder of a city; a mesh, too.
SplatModel load_splats(const std::filesystem::path& path);
AnyModel load_any_model_or_city(const std::filesystem::path& path);

/// Throws data where a tile's file is not the one that was written.
void verify_city(const std::filesystem::path& folder, const CityManifest& city);

}  // namespace adasplats
