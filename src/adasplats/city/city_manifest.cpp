// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/city_manifest.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/json_rows.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/sha256.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kCityVersion = 1;

Json json_of(Vec3d v) { return {v.x, v.y, v.z}; }
Vec3d vector_of(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

CityTile tile_of(const Json& json) {
  return {{json.at("x"), json.at("y")},
          json.at("points"),
          json.at("splats"),
          json.at("sha256"),
          vector_of(json.at("low_m")),
          vector_of(json.at("high_m"))};
}

void check_version(const Json& json, const fs::path& file) {
  if (json.at("format") != "adasplats city")
    throw Error(ErrorKind::data, file.string() + ": not the manifest of a city");
  if (json.at("version") != kCityVersion)
    throw Error(ErrorKind::data, file.string() + ": the city has version " +
                                     json.at("version").dump() + "; this program reads version " +
                                     std::to_string(kCityVersion));
}

/// Parses all but the tiles, which are added to `tiles` instead: a city may have a hundred
/// thousand.
Json parsed_manifest(const std::string& text, std::vector<CityTile>& tiles, const fs::path& file) {
  try {
    Json json =
        parse_json_rows(text, "tiles", [&](const Json& tile) { tiles.push_back(tile_of(tile)); });
    check_version(json, file);
    return json;
  } catch (const Json::exception&) {
    // Tiles may differ in other versions.
    check_version(Json::parse(text), file);
    throw;
  }
}

template <class T>
void append_to(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

std::size_t CityManifest::points() const {
  std::size_t sum = 0;
  for (const CityTile& tile : tiles) sum += tile.points;
  return sum;
}

std::size_t CityManifest::splats() const {
  std::size_t sum = 0;
  for (const CityTile& tile : tiles) sum += tile.splats;
  return sum;
}

void set_splats(const SplatModel& model, CityTile& tile) {
  tile.splats = model.size();
  const auto [low, high] = bounds(model);
  tile.low = model.origin + vec_cast<double>(low);
  tile.high = model.origin + vec_cast<double>(high);
}

std::string model_file_of(TileKey tile) { return "tiles/" + name_of(tile) + ".ply"; }

bool is_city(const fs::path& path) {
  std::error_code none;
  return fs::is_directory(path, none) && fs::exists(path / kCityFile, none);
}

std::string city_text(const CityManifest& city) {
  Json json = {{"format", "adasplats city"},       {"version", kCityVersion},
               {"tile_m", city.grid.side_m},       {"halo_m", city.halo_m},
               {"origin_m", json_of(city.origin)}, {"points", city.points()},
               {"splats", city.splats()},          {"tiles", Json::array()}};
  for (const CityTile& tile : city.tiles)
    json["tiles"].push_back({{"x", tile.key.x},
                             {"y", tile.key.y},
                             {"file", model_file_of(tile.key)},
                             {"points", tile.points},
                             {"splats", tile.splats},
                             {"sha256", tile.sha256},
                             {"low_m", json_of(tile.low)},
                             {"high_m", json_of(tile.high)}});
  return json.dump(1) + "\n";
}

CityManifest load_city_manifest(const fs::path& folder) {
  const fs::path file = folder / kCityFile;
  const std::string text = read_file(file);
  try {
    CityManifest city;
    const Json json = parsed_manifest(text, city.tiles, file);
    city.grid.side_m = json.at("tile_m");
    city.halo_m = json.at("halo_m");
    city.origin = vector_of(json.at("origin_m"));
    if (!(city.grid.side_m > 0) || !std::ranges::is_sorted(city.tiles, {}, &CityTile::key))
      throw Error(ErrorKind::data, file.string() + ": damaged: the tiles are not sorted");
    return city;
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + error.what());
  }
}

TileKey owner_of(Vec3d world, const TileGrid& grid, const std::vector<CityTile>& tiles) {
  const auto is_there = [&](TileKey key) {
    return std::ranges::binary_search(tiles, key, {}, &CityTile::key);
  };
  const TileKey own = grid.tile_of(world);
  if (is_there(own)) return own;
  for (TileKey near = {own.x - 1, 0}; near.x <= own.x + 1; ++near.x)
    for (near.y = own.y - 1; near.y <= own.y + 1; ++near.y)
      if (is_there(near)) return near;
  return own;
}

/// Throws data if splats are outside the manifest's box, since callers that rely on the box would
/// miss them.
void require_within(const CityTile& tile, const SplatModel& part, const fs::path& file) {
  if (part.size() == 0) return;
  const auto [low, high] = bounds(part);
  for (int axis = 0; axis < 3; ++axis) {
    const auto first = static_cast<double>(low[axis]), last = static_cast<double>(high[axis]);
    // Positions are floats, relative to different origins.
    const double rounded_m = 1e-3 + 0x1p-22 * std::max(std::fabs(first), std::fabs(last));
    const double from = part.origin[axis] + first, to = part.origin[axis] + last;
    if (from >= tile.low[axis] - rounded_m && to <= tile.high[axis] + rounded_m) continue;
    const std::string name(1, "xyz"[axis]);
    throw Error(ErrorKind::data, file.string() + ": the splats have " + name + " from " +
                                     decimal_text(from) + " to " + decimal_text(to) +
                                     "; the city's manifest has " + decimal_text(tile.low[axis]) +
                                     " to " + decimal_text(tile.high[axis]));
  }
}

SplatModel load_city_tile(const fs::path& folder, const CityManifest& city, std::size_t k) {
  const CityTile& tile = city.tiles[k];
  const fs::path file = folder / model_file_of(tile.key);
  SplatModel part = load_model(file);
  if (part.size() != tile.splats)
    throw Error(ErrorKind::data, file.string() + ": " + std::to_string(part.size()) +
                                     " splats; the city's manifest has " +
                                     std::to_string(tile.splats));
  if (!part.opacities.empty())
    throw Error(ErrorKind::data,
                file.string() + ": has opacities, which tiles of a city do not support");
  // The file's CRS header refers to world coordinates; the loaded model has a nearby origin.
  const Vec3d shift = part.origin - city.origin;
  for (Disk& disk : part.disks)
    disk.center = vec_cast<float>(vec_cast<double>(disk.center) + shift);
  part.origin = city.origin;
  require_within(tile, part, file);
  return part;
}

void SameAttributes::check(const fs::path& folder, const CityTile& tile, const SplatModel& part) {
  if (part.size() == 0) return;
  const std::array has = {part.classes.empty(), part.groups.empty(), part.intensities.empty(),
                          part.colors.empty()};
  if (has_.value_or(has) != has)
    throw Error(ErrorKind::data, (folder / model_file_of(tile.key)).string() +
                                     ": has other attributes (classes, groups, intensities, "
                                     "colours) than the tiles before it");
  has_ = has;
}

SplatModel load_city(const fs::path& folder) {
  SameAttributes attributes;
  const CityManifest city = load_city_manifest(folder);
  SplatModel all = load_model(folder / kCityCommonFile);
  all.origin = city.origin;
  for (std::size_t k = 0; k < city.tiles.size(); ++k) {
    if (city.tiles[k].splats == 0) continue;
    const SplatModel part = load_city_tile(folder, city, k);
    attributes.check(folder, city.tiles[k], part);
    append_to(all.disks, part.disks);
    append_to(all.classes, part.classes);
    append_to(all.groups, part.groups);
    append_to(all.intensities, part.intensities);
  }
  return all;
}

SplatModel load_splats(const fs::path& path) {
  return is_city(path) ? load_city(path) : load_model(path);
}

AnyModel load_any_model_or_city(const fs::path& path) {
  return is_city(path) ? AnyModel(load_city(path)) : load_any_model(path);
}

void verify_city(const fs::path& folder, const CityManifest& city) {
  for (const CityTile& tile : city.tiles) {
    if (tile.splats == 0) continue;
    const fs::path file = folder / model_file_of(tile.key);
    if (sha256_of_file(file) != tile.sha256)
      throw Error(
          ErrorKind::data,
          file.string() + ": the file has changed since it was written (its SHA-256 differs)");
  }
}

}  // namespace adasplats
