// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/layer_facts.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json json_of(Vec3f v) { return {v.x, v.y, v.z}; }
Json json_of(const GroundBox& box) { return {box.low_x, box.low_y, box.high_x, box.high_y}; }
GroundBox ground_box(const Json& json) { return {json.at(0), json.at(1), json.at(2), json.at(3)}; }
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
    const auto is_faulty = [](const auto& tile) {
      const GroundBox& rays = tile.second.rays;
      return tile.second.points > 0 && (rays.low_x > rays.high_x || rays.low_y > rays.high_y);
    };
    if (!is_finite(facts.origin) || std::ranges::any_of(facts.tiles, is_faulty))
      throw Error(ErrorKind::data, file.string() + ": damaged: invalid coordinates");
    return facts;
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + error.what());
  }
}

}  // namespace adasplats
