// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/city/tile_grid.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/splats/model/any_model.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

/// Lists the tiles in a city's folder.
inline constexpr const char* kCityFile = "city.json";
/// Common properties of all tiles: a model without splats.
inline constexpr const char* kCityCommonFile = "common.ply";

/// A modelled tile of a city.
struct CityTile {
  TileKey key;
  std::size_t points = 0;
  std::size_t splats = 0;
  std::string sha256;  ///< of the model file
  Vec3d low, high;     ///< box of the splats, world coordinates; zeros without splats
};

/// Sets the number of splats of a tile, and their box.
void set_splats(const SplatModel& model, CityTile& tile);

/// The model of a city: a folder of tiles. Each tile is a model of the splats inside it; all have
/// the same local origin.
struct CityManifest {
  TileGrid grid;
  Vec3d origin;                 ///< local origin of all tiles, world coordinates
  double halo_m = 0;            ///< margin around a tile that was used for modelling it
  std::vector<CityTile> tiles;  ///< sorted by key

  std::size_t points() const;
  std::size_t splats() const;
};

/// Model file of a tile, relative to the city's folder.
std::string model_file_of(TileKey tile);

/// Whether a path is the folder of a city's model.
bool is_city(const std::filesystem::path& path);

std::string city_text(const CityManifest& city);
/// Errors: no_input, data (damaged, or of another version).
CityManifest load_city_manifest(const std::filesystem::path& folder);

/// The tile of a splat with its center at `world`: the one that contains it or, if the city lacks
/// that tile, a neighbour.
TileKey owner_of(Vec3d world, const TileGrid& grid, const std::vector<CityTile>& tiles);

/// The splats of tile `k` of CityManifest::tiles, relative to the city's origin. Errors: data
/// (their number or box contradicts the manifest), those of load_model.
SplatModel load_city_tile(const std::filesystem::path& folder, const CityManifest& city,
                          std::size_t k);

/// Whether the tiles of a city have the same attributes, which programs that change a tile may
/// lose.
class SameAttributes {
 public:
  /// Throws data if a tile has other attributes than the ones before.
  void check(const std::filesystem::path& folder, const CityTile& tile, const SplatModel& part);

 private:
  std::optional<std::array<bool, 4>> has_;
};

/// The city as one model, tile by tile. Errors: data (a number of splats contradicts the manifest),
/// those of load_model.
SplatModel load_city(const std::filesystem::path& folder);

/// Loads a model from one file or from the folder of a city; the second function also loads meshes.
SplatModel load_splats(const std::filesystem::path& path);
AnyModel load_any_model_or_city(const std::filesystem::path& path);

/// Throws data if a tile's file has changed.
void verify_city(const std::filesystem::path& folder, const CityManifest& city);

}  // namespace adasplats
