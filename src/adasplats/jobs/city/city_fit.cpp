// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kTiles = 24;           // that are looked at, at most
constexpr std::size_t kBeamsATile = 20'000;  // likewise
constexpr std::size_t kMinBeams = 200;       // that say anything of a tile

/// Tiles of the city with splats and enough new points, all over what they have in common.
std::vector<std::size_t> tiles_in_common(const CityManifest& city, const PointLayer& added) {
  std::vector<std::size_t> common;
  for (std::size_t k = 0; k < city.tiles.size(); ++k) {
    const auto found = added.facts.tiles.find(city.tiles[k].key);
    const std::size_t points = found == added.facts.tiles.end() ? 0 : found->second.points;
    if (city.tiles[k].splats > 0 && points >= kMinBeams) common.push_back(k);
  }
  if (common.size() <= kTiles) return common;
  std::vector<std::size_t> some;
  some.reserve(kTiles);
  for (std::size_t k = 0; k < kTiles; ++k) some.push_back(common[k * common.size() / kTiles]);
  return some;
}

FitPart part_of(std::size_t tile, const CityManifest& city, const CityToExtend& before,
                const CityWork& work) {
  FitPart part = {FitScene(load_city_tile(before.path(), city, tile).disks, work.session.executor),
                  {}};
  const PointLayer& added = work.layers.back();
  PointCloud cloud;
  cloud.origin = work.origin();
  read_points_of(city.tiles[tile].key, work.path(added.folder), work.job, cloud);
  if (!cloud.has_beams()) return part;
  const std::optional<LabelScheme> scheme = scheme_of(work.job);
  const RemovedPoints removed =
      points_to_remove(cloud, scheme ? &*scheme : nullptr, work.job.build.remove);
  const std::size_t every = std::max<std::size_t>(1, cloud.size() / kBeamsATile);
  for (std::size_t i = 0; i < cloud.size(); i += every) {
    const bool stays =
        removed.ids.empty() || cloud.classes.empty() || removed.ids[cloud.classes[i]] == 0;
    if (!stays || !is_beam(cloud.origin_kind(i))) continue;
    part.rays.ends.push_back(cloud.positions[i]);
    part.rays.sensors.push_back(cloud.sensor_positions[i]);
  }
  return part;
}

PointFit measure_fit(const CityToExtend& before, const CityWork& work) {
  const CityManifest& city = before.manifest();
  const std::vector<std::size_t> tiles = tiles_in_common(city, work.layers.back());
  std::vector<FitPart> parts;
  parts.reserve(tiles.size());
  for (const std::size_t tile : tiles) parts.push_back(part_of(tile, city, before, work));
  return fit_of_points(parts, work.session.executor);
}

std::string metres(double value_m) {
  return decimal_text(std::round(value_m * 1000) / 1000) + " m";
}

PointFit fit_in(const std::filesystem::path& file) {
  const Json json = Json::parse(read_file(file), nullptr, false);
  try {
    PointFit fit;
    fit.rays = json.at("rays");
    fit.parts = json.at("tiles");
    const Json& shift = json.at("shift_m");
    fit.shift_m = {shift.at(0), shift.at(1), shift.at(2)};
    fit.part_shift_m = json.at("tile_shift_m");
    fit.distance_m = json.at("distance_m");
    fit.distance_shifted_m = json.at("distance_shifted_m");
    return fit;
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + error.what());
  }
}

}  // namespace

Json to_json(const PointFit& fit) {
  return {{"rays", fit.rays},
          {"tiles", fit.parts},
          {"shift_m", {fit.shift_m.x, fit.shift_m.y, fit.shift_m.z}},
          {"tile_shift_m", fit.part_shift_m},
          {"distance_m", fit.distance_m},
          {"distance_shifted_m", fit.distance_shifted_m}};
}

PointFit require_fit(const CityToExtend& before, const CityWork& work, ResumableFolder& folder) {
  const std::string name = work.layers.back().file(kFitFile);
  if (folder.has(name)) return fit_in(work.path(name));
  const PointFit fit = measure_fit(before, work);
  if (fit.parts == 0) {
    work.session.progress.warn("the new points and " + before.path().string() +
                               " hardly overlap, so their fit cannot be checked (" +
                               std::to_string(fit.rays) + " new rays end near its splats)");
  } else if (std::max(length(fit.shift_m), fit.part_shift_m) > work.job.addition.max_shift_m) {
    throw Error(ErrorKind::data, "the new points are shifted against " + before.path().string() +
                                     ": they fit best when all "
                                     "are shifted by " +
                                     metres(fit.shift_m.x) + ", " + metres(fit.shift_m.y) + ", " +
                                     metres(fit.shift_m.z) + ", tiles alone by " +
                                     metres(fit.part_shift_m) + " (median of " +
                                     std::to_string(fit.parts) + "), and `max_shift` is " +
                                     metres(work.job.addition.max_shift_m) +
                                     ": both would be modelled side by side; correct their poses");
  }
  write_file_in_place(work.path(name), to_json(fit).dump(1) + "\n");
  folder.record(name);
  return fit;
}

}  // namespace adasplats
