// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/city_work.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/session/inputs.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json json_of(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3f float_vector(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

}  // namespace

std::string text_of(const CityFacts& facts) {
  Json json = {{"origin_m", {facts.origin.x, facts.origin.y, facts.origin.z}},
               {"low_m", json_of(facts.box.low)},
               {"high_m", json_of(facts.box.high)},
               {"points_read", facts.points_read},
               {"rays", facts.rays},
               {"empty_reach_m", facts.empty_reach_m},
               {"tiles", Json::array()}};
  for (const auto& [tile, count] : facts.tiles)
    json["tiles"].push_back({tile.x, tile.y, count.points, count.empty_beams});
  return json.dump(1) + "\n";
}

CityFacts load_facts(const fs::path& file) {
  const std::string text = read_file(file);
  try {
    const Json json = Json::parse(text);
    CityFacts facts;
    const Json& origin = json.at("origin_m");
    facts.origin = {origin.at(0), origin.at(1), origin.at(2)};
    facts.box = {float_vector(json.at("low_m")), float_vector(json.at("high_m"))};
    facts.points_read = json.at("points_read");
    facts.rays = json.at("rays");
    facts.empty_reach_m = json.at("empty_reach_m");
    for (const Json& tile : json.at("tiles"))
      facts.tiles[{tile.at(0), tile.at(1)}] = {tile.at(2), tile.at(3)};
    return facts;
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + error.what());
  }
}

CityWork::CityWork(const CityJob& its_job, Session& its_session, fs::path its_folder)
    : job(its_job),
      options(consistent_options_of(its_job)),
      session(its_session),
      folder(std::move(its_folder)) {
  tiles.grid = {job.tiles.tile_m};
  tiles.halo_m = job.tiles.halo_m;
}

std::optional<LabelScheme> CityWork::scheme() const {
  if (job.segment.on) return semantickitti_labels();
  return label_scheme_for(job.labels, job.inputs);
}

std::vector<CityTile> tiles_to_model(const CityWork& work) {
  std::vector<CityTile> tiles;
  for (const TileKey tile : work.tiles.tiles) {
    CityTile made;
    made.key = tile;
    made.points = work.facts.tiles.at(tile).points;
    tiles.push_back(made);
  }
  return tiles;
}

TileKey pilot_tile(const CityWork& work) {
  const std::vector<CityTile> tiles = tiles_to_model(work);
  return std::ranges::max_element(tiles, {}, &CityTile::points)->key;
}

std::vector<TileKey> tiles_in(const GroundBox& ground, const CityWork& work) {
  const TileGrid& grid = work.tiles.grid;
  const TileKey low = grid.tile_of({ground.low_x, ground.low_y, 0});
  const TileKey high = grid.tile_of({ground.high_x, ground.high_y, 0});
  std::vector<TileKey> found;
  for (TileKey near = low; near.x <= high.x; ++near.x)
    for (near.y = low.y; near.y <= high.y; ++near.y)
      if (work.tiles.tiles.contains(near)) found.push_back(near);
  return found;
}

std::vector<TileKey> tiles_around(TileKey tile, const CityWork& work) {
  return tiles_in(work.tiles.reach_of(tile), work);
}

void read_points_of(TileKey tile, const CityWork& work, PointCloud& cloud,
                    const std::function<bool(Vec3f)>& wanted) {
  std::vector<std::uint16_t> classes;
  if (work.job.segment.on) classes = read_tile_classes(work.folder, tile);
  if (work.job.segment.on && classes.empty())
    throw Error(ErrorKind::data,
                work.path(classes_file_of(tile)).string() + ": damaged: it has no classes");
  read_tile_points(work.folder, tile, cloud, wanted, classes);
}

PointCloud points_around(TileKey tile, const CityWork& work) {
  const GroundBox reach = work.tiles.reach_of(tile);
  PointCloud cloud;
  cloud.origin = work.facts.origin;
  cloud.crs = work.common.crs;
  for (const TileKey near : tiles_around(tile, work))
    read_points_of(near, work, cloud, [&](Vec3f p) {
      return reach.contains(work.facts.origin + vec_cast<double>(p));
    });
  cloud.crs = work.common.crs;
  return cloud;
}

}  // namespace adasplats
