// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_origins.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/city/passing_rays.h"
#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/city/tile_workers.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/session/repeated_warnings.h"
#include "adasplats/splats/model_engine.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

/// What was found of where beams started.
constexpr const char* kOriginsFile = "points/origins.json";  // of the last layer

constexpr std::size_t kCheckedTiles = 8;

std::vector<TileKey> checked_tiles(const PointLayer& layer) {
  std::vector<TileKey> all;
  for (const auto& [tile, points] : layer.facts.tiles)
    if (points.points > 0) all.push_back(tile);
  const std::size_t count = std::min(all.size(), kCheckedTiles);
  std::vector<TileKey> chosen;
  for (std::size_t k = 0; k < count; ++k)
    chosen.push_back(all[(2 * k + 1) * all.size() / (2 * count)]);
  return chosen;
}

std::vector<MovedEvidence> evidence_in(TileKey tile, const LabelScheme* scheme,
                                       const GlobalContext& whole, const ModelEngine& engine,
                                       const CityWork& work) {
  PointCloud cloud = points_around(tile, work.layers.back(), work);
  if (!cloud.has_beams()) return {};
  ClassTables tables;
  tables.removed = points_to_remove(cloud, scheme, work.job.build.remove).ids;
  const std::unique_ptr<ConsistentSteps> steps = engine.consistent_steps();
  if (steps->load(std::move(cloud), tables, &whole) == 0) return {};
  steps->fuse(work.options);
  steps->fit_seeds(work.options);
  return steps->check_origins(work.options);
}

OriginCheck check_tiles(const CityWork& work) {
  const std::optional<LabelScheme> scheme = scheme_of(work.job);
  const PointLayer& layer = work.layers.back();
  const std::vector<TileKey> chosen = checked_tiles(layer);
  std::set<TileKey> begin;
  for (const auto& [tile, count] : layer.facts.tiles) begin.insert(tile);
  const RayFiles passing(work.path(layer.folder), begin, RaySort::passing);
  ProgressSink& progress = work.session.progress;
  progress.begin_step("check of sensor positions", chosen.size());
  RepeatedWarnings warnings(progress, "tiles");
  std::vector<std::vector<MovedEvidence>> of_tiles(chosen.size());
  std::size_t done = 0;
  const auto check = [&](std::size_t k, Session& session) {
    GlobalContext whole;
    whole.box = work.first().box;
    whole.typical = work.typical;
    whole.rays = work.first().rays;
    whole.passing = passing.read(chosen[k]);
    with_model_engine(session, [&](const ModelEngine& engine) {
      of_tiles[k] = evidence_in(chosen[k], scheme ? &*scheme : nullptr, whole, engine, work);
    });
  };
  work_side_by_side(chosen.size(), work.job.memory.tiles_at_once, work.session, warnings, check,
                    [&](std::size_t) { progress.advance(++done); });
  progress.end_step();
  warnings.end();
  std::vector<MovedEvidence> pieces;
  for (const auto& some : of_tiles) pieces.insert(pieces.end(), some.begin(), some.end());
  return origin_check(pieces);
}

OriginCheck load_check(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  try {
    const Json json = Json::parse(text);
    return {json.at("seeds"), json.at("contradicted"), json.at("near_rise"), json.at("far_rise")};
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + error.what());
  }
}

}  // namespace

std::optional<OriginCheck> check_city_origins(const CityWork& work, ResumableFolder& folder) {
  const bool is_asked = work.options.balance_rounds > 0 && !work.options.trust_origins &&
                        !work.job.build.trust_origins && !work.job.load.trust_origins;
  const PointLayer& layer = work.layers.back();
  if (!is_asked || layer.facts.rays == 0) return std::nullopt;
  const std::string name = layer.file(kOriginsFile);
  OriginCheck check;
  if (folder.has(name)) {
    check = load_check(work.path(name));
  } else {
    check = check_tiles(work);
    const std::string objection = origin_objection(check);
    if (!objection.empty()) throw Error(ErrorKind::data, objection);
    write_file_in_place(work.path(name), to_json(check).dump() + "\n");
    folder.record(name);
  }
  const std::string doubt = origin_doubt(check);
  if (!doubt.empty()) work.session.progress.warn(doubt);
  return check;
}

}  // namespace adasplats
