// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_work.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/city/city_classes.h"
#include "adasplats/jobs/city/city_points.h"

namespace adasplats {

CityWork::CityWork(const CityJob& its_job, Session& its_session, std::filesystem::path its_folder)
    : job(its_job),
      options(consistent_options_of(its_job)),
      session(its_session),
      folder(std::move(its_folder)) {
  tiles.grid = {job.tiles.tile_m};
  tiles.halo_m = job.tiles.halo_m;
}

void CityWork::add(PointLayer layer) {
  for (const auto& [tile, count] : layer.facts.tiles)
    if (count.points > 0) tiles.tiles.insert(tile);
  layers.push_back(std::move(layer));
}

void load_layers(std::size_t count, CityWork& work) {
  for (std::size_t k = 0; k < count; ++k) {
    LayerWork sorted(work.job, work.session, work.folder, k);
    load_sorted(sorted);
    if (work.job.segment.on) load_classes(sorted);
    if (k == 0) work.common = sorted.common;
    work.add(std::move(sorted.layer));
  }
}

std::size_t load_layer_count(const std::filesystem::path& file) {
  const auto json = nlohmann::json::parse(read_file(file), nullptr, false);
  if (!json.is_object() || !json.contains("layers") || !json["layers"].is_number_unsigned())
    throw Error(ErrorKind::data, file.string() + ": damaged");
  return json["layers"];
}

std::size_t CityWork::points_in(TileKey tile) const {
  std::size_t points = 0;
  for (const PointLayer& layer : layers) {
    const auto found = layer.facts.tiles.find(tile);
    if (found != layer.facts.tiles.end()) points += found->second.points;
  }
  return points;
}

std::vector<CityTile> tiles_to_model(const CityWork& work) {
  std::vector<CityTile> tiles;
  for (const TileKey tile : work.tiles.tiles) {
    CityTile made;
    made.key = tile;
    made.points = work.points_in(tile);
    tiles.push_back(made);
  }
  return tiles;
}

TileKey pilot_tile(const CityWork& work) {
  const std::vector<CityTile> tiles = tiles_to_model(work);
  return std::ranges::max_element(tiles, {}, &CityTile::points)->key;
}

std::vector<TileKey> tiles_around(TileKey tile, const CityWork& work) {
  return work.tiles.touched(work.tiles.reach_of(tile));
}

namespace {

PointCloud points_of_layers(TileKey tile, std::span<const PointLayer> layers,
                            const CityWork& work) {
  const GroundBox reach = work.tiles.reach_of(tile);
  PointCloud cloud;
  cloud.origin = work.origin();
  for (const TileKey near : tiles_around(tile, work)) {
    for (const PointLayer& layer : layers) {
      if (!layer.has_points(near)) continue;
      read_points_of(near, work.path(layer.folder), work.job, cloud,
                     [&](Vec3f p) { return reach.contains(work.origin() + vec_cast<double>(p)); });
    }
  }
  cloud.crs = work.common.crs;
  return cloud;
}

}  // namespace

PointCloud points_around(TileKey tile, const CityWork& work) {
  return points_of_layers(tile, work.layers, work);
}

PointCloud points_around(TileKey tile, const PointLayer& layer, const CityWork& work) {
  return points_of_layers(tile, std::span(&layer, 1), work);
}

}  // namespace adasplats
