// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_tiles.h"

#include <set>

#include "adasplats/jobs/model/make_model.h"

namespace adasplats {
namespace {

/// All tiles that rays may begin in.
std::set<TileKey> tiles_with_rays(const LayerFacts& facts) {
  std::set<TileKey> all;
  for (const auto& [tile, count] : facts.tiles) all.insert(tile);
  return all;
}

void add_rays(PointCloud& all, const PointCloud& more) {
  all.positions.insert(all.positions.end(), more.positions.begin(), more.positions.end());
  all.sensor_positions.insert(all.sensor_positions.end(), more.sensor_positions.begin(),
                              more.sensor_positions.end());
}

}  // namespace

TileModeller::TileModeller(const CityWork& work) : work_(work), tiles_(tiles_to_model(work)) {
  if (work.layers.size() == 1) pilot_ = pilot_tile(work);
  for (const PointLayer& layer : work.layers) {
    const std::set<TileKey> from = tiles_with_rays(layer.facts);
    const std::filesystem::path folder = work.path(layer.folder);
    rays_.push_back({{folder, from, RaySort::passing}, {folder, from, RaySort::empty}});
  }
}

GlobalContext TileModeller::whole_of(TileKey tile) const {
  GlobalContext whole;
  whole.box = work_.first().box;
  whole.typical = work_.typical;
  whole.rays = work_.first().rays;
  for (const LayerRays& rays : rays_) {
    add_rays(whole.passing, rays.passing.read(tile));
    add_rays(whole.empty, rays.empty.read(tile));
  }
  if (tile != pilot_) whole.response = work_.response;
  return whole;
}

SplatModel TileModeller::model(TileKey tile, Session& session) const {
  const GlobalContext whole = whole_of(tile);
  ModelOptions options = work_.job;
  options.build.recipe = work_.options;
  options.calibration.on = false;
  options.segment.on = false;                  // the points have their classes
  options.labels = work_.common.label_scheme;  // also if only the inputs name it
  options.build.whole = &whole;
  options.build.reflectances =
      options.build.reflectances && (tile == pilot_ || whole.response.has_value());
  SplatModel model = make_model([&] { return points_around(tile, work_); }, options, session).first;
  model.label_scheme = work_.common.label_scheme;
  model.network_sha256 = work_.common.network_sha256;
  keep_own(tile, model);
  return model;
}

std::vector<std::string> TileModeller::files_for(TileKey tile) const {
  std::vector<std::string> files;
  for (std::size_t k = 0; k < work_.layers.size(); ++k) {
    const PointLayer& layer = work_.layers[k];
    for (const TileKey near : tiles_around(tile, work_)) {
      if (!layer.has_points(near)) continue;
      files.push_back(layer.file(points_file_of(near)));
      if (work_.job.segment.on) files.push_back(layer.file(classes_file_of(near)));
    }
    for (const TileKey from : rays_[k].passing.sources(tile))
      files.push_back(layer.file(rays_file_of(from, RaySort::passing)));
    for (const TileKey from : rays_[k].empty.sources(tile))
      files.push_back(layer.file(rays_file_of(from, RaySort::empty)));
  }
  return files;
}

/// Removes splats of other tiles.
void TileModeller::keep_own(TileKey tile, SplatModel& model) const {
  std::size_t kept = 0;
  const auto move_down = [&](auto& values, std::size_t i) {
    if (!values.empty()) values[kept] = values[i];
  };
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Vec3d place = model.origin + vec_cast<double>(model.disks[i].center);
    if (owner_of(place, work_.tiles.grid, tiles_) != tile) continue;
    move_down(model.classes, i);
    move_down(model.groups, i);
    move_down(model.intensities, i);
    model.disks[kept++] = model.disks[i];
  }
  const auto cut = [&](auto& values) {
    if (!values.empty()) values.resize(kept);
  };
  cut(model.classes);
  cut(model.groups);
  cut(model.intensities);
  model.disks.resize(kept);
}

std::optional<IntensityResponse> load_response(const std::filesystem::path& file) {
  IntensityResponse response = load_model(file).response;
  if (response.empty()) return std::nullopt;
  return response;
}

}  // namespace adasplats
