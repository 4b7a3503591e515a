// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/point_layer.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/session/inputs.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json json_of(Vec3f v) { return {v.x, v.y, v.z}; }
Json json_of(const GroundBox& box) { return {box.low_x, box.low_y, box.high_x, box.high_y}; }
GroundBox ground_box(const Json& json) {
  return {json.at(0), json.at(1), json.at(2), json.at(3)};
}
Vec3f float_vector(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

}  // namespace

std::string text_of(const LayerFacts& facts) {
  Json json = {{"origin_m", {facts.origin.x, facts.origin.y, facts.origin.z}},
               {"low_m", json_of(facts.box.low)},
               {"high_m", json_of(facts.box.high)},
               {"points_read", facts.points_read},
               {"rays", facts.rays},
               {"empty_reach_m", facts.empty_reach_m},
               {"attributes", facts.attributes},
               {"tiles", Json::array()}};
  for (const auto& [tile, count] : facts.tiles)
    json["tiles"].push_back({tile.x, tile.y, count.points, count.empty_beams,
                             json_of(count.points > 0 ? count.rays : GroundBox{})});
  return json.dump(1) + "\n";
}

LayerFacts load_facts(const fs::path& file) {
  const std::string text = read_file(file);
  try {
    const Json json = Json::parse(text);
    LayerFacts facts;
    const Json& origin = json.at("origin_m");
    facts.origin = {origin.at(0), origin.at(1), origin.at(2)};
    facts.box = {float_vector(json.at("low_m")), float_vector(json.at("high_m"))};
    facts.points_read = json.at("points_read");
    facts.rays = json.at("rays");
    facts.empty_reach_m = json.at("empty_reach_m");
    facts.attributes = json.at("attributes");
    for (const Json& tile : json.at("tiles"))
      facts.tiles[{tile.at(0), tile.at(1)}] = {tile.at(2), tile.at(3), ground_box(tile.at(4))};
    return facts;
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + error.what());
  }
}

std::string layer_folder(std::size_t number) { return "layers/" + std::to_string(number); }

LayerWork::LayerWork(const CityJob& its_job, Session& its_session, fs::path its_city,
                     std::size_t number)
    : job(its_job),
      options(consistent_options_of(its_job)),
      session(its_session),
      city(std::move(its_city)) {
  layer.folder = layer_folder(number);
  tiles.grid = {job.tiles.tile_m};
  tiles.halo_m = job.tiles.halo_m;
}

std::optional<LabelScheme> scheme_of(const CityJob& job) {
  if (job.segment.on) return semantickitti_labels();
  return label_scheme_for(job.labels, job.inputs);
}

void read_points_of(TileKey tile, const fs::path& folder, const CityJob& job, PointCloud& cloud,
                    const std::function<bool(Vec3f)>& wanted) {
  std::vector<std::uint16_t> classes;
  if (job.segment.on) classes = read_tile_classes(folder, tile);
  if (job.segment.on && classes.empty())
    throw Error(ErrorKind::data,
                (folder / classes_file_of(tile)).string() + ": damaged: it has no classes");
  read_tile_points(folder, tile, cloud, wanted, classes);
}

std::size_t count_rays(const PointCloud& cloud, const LabelScheme* scheme, const CityJob& job) {
  const double least_range_m = consistent_options_of(job).least_range_m;
  const RemovedPoints removed = points_to_remove(cloud, scheme, job.build.remove);
  std::size_t rays = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_beam(cloud.origin_kind(i))) continue;
    const float range_m = length(cloud.positions[i] - cloud.sensor_positions[i]);
    const bool stays =
        removed.ids.empty() || cloud.classes.empty() || removed.ids[cloud.classes[i]] == 0;
    if (stays && static_cast<double>(range_m) >= least_range_m) ++rays;
  }
  return rays;
}

}  // namespace adasplats
