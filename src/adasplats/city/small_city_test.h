// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/city/city_levels.h"
#include "adasplats/city/city_manifest.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"

namespace adasplats::small_city {

inline constexpr double kSide_m = 10;

/// One tile of splats: a floor with a spacing of 0.2 m and a wall at its end.
inline SplatModel tile_of(TileKey key, Vec3d origin) {
  SplatModel tile;
  tile.origin = origin;
  tile.method = "consistent";
  tile.label_scheme = "semantickitti";
  const auto add = [&](Vec3d position, Vec3f normal, std::uint16_t class_id) {
    Random random(5, static_cast<std::uint64_t>(100 * key.x + key.y), tile.size());
    tile.disks.push_back({vec_cast<float>(position - origin), 0.18F, normal});
    tile.classes.push_back(class_id);
    tile.intensities.push_back(static_cast<float>(random.uniform(0.1, 0.9)));
  };
  for (int i = 0; i < 50; ++i) {
    const double x = kSide_m * key.x + 0.2 * i + 0.1;
    for (int j = 0; j < 50; ++j) add({x, kSide_m * key.y + 0.2 * j + 0.1, 0}, {0, 0, 1}, 40);
    for (int j = 0; j < 10; ++j) add({x, kSide_m * key.y + 9.9, 0.2 * j}, {0, 1, 0}, 50);
  }
  return tile;
}

/// Writes a city of 3 x 3 tiles without the middle one, and one tile without splats.
inline CityManifest write_city(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  fs::create_directories(folder / "tiles");
  CityManifest city;
  city.grid = {kSide_m};
  city.origin = {5000, 6000, 0};
  SplatModel common;
  common.origin = city.origin;
  common.method = "consistent";
  common.label_scheme = "semantickitti";
  save_model(folder / kCityCommonFile, common);
  for (int x = 499; x <= 501; ++x) {
    for (int y = 599; y <= 602; ++y) {
      if (x == 500 && y == 600) continue;
      const TileKey key = {x, y};
      const SplatModel tile = y == 602 ? common : tile_of(key, city.origin);
      if (y == 602 && x != 500) continue;
      save_model(folder / model_file_of(key), tile);
      const auto [low, high] = bounds(tile);
      city.tiles.push_back({key, 1, tile.size(), sha256_of_file(folder / model_file_of(key)),
                            city.origin + vec_cast<double>(low),
                            city.origin + vec_cast<double>(high)});
    }
  }
  write_file(folder / kCityFile, city_text(city));
  return city;
}

/// The same with levels of detail.
inline CityManifest write_city_with_levels(const std::filesystem::path& folder) {
  const CityManifest city = write_city(folder);
  std::filesystem::create_directories(folder / "levels");
  const Executor executor(2);
  const LevelFacts facts = survey_levels(folder, city);
  for (std::size_t k = 0; k < city.tiles.size(); ++k)
    if (city.tiles[k].splats > 0) write_tile_levels(folder, city, k, facts, executor);
  write_top_levels(
      folder, city, facts, [&](const std::string& file) { return sha256_of_file(folder / file); },
      executor);
  return city;
}

}  // namespace adasplats::small_city
