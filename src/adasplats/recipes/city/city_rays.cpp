// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/city_rays.h"

#include <cstdint>

#include "adasplats/city/passing_rays.h"
#include "adasplats/city/tile_points.h"
#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {
namespace {

/// A tile's points without those that a model is made without.
PointCloud points_that_stay(TileKey tile, const LabelScheme* scheme, const CityWork& work) {
  PointCloud cloud;
  cloud.origin = work.facts.origin;
  read_tile_points(work.folder, tile, cloud);
  const RemovedPoints removed = points_to_remove(cloud, scheme, work.job.build.remove);
  if (removed.ids.empty() || cloud.classes.empty()) return cloud;
  std::vector<std::uint32_t> stay;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (removed.ids[cloud.classes[i]] == 0) stay.push_back(i);
  return gather(cloud, stay);
}

void write_rays_of(TileKey tile, const TileCount& count, const LabelScheme* scheme,
                   const CityWork& work) {
  const Executor& executor = work.session.executor;
  RaysByTile passing, empty;
  if (count.points > 0)
    passing = passing_rays(points_that_stay(tile, scheme, work), work.tiles,
                           work.options.least_range_m, executor);
  if (count.empty_beams > 0) {
    PointCloud ends = ends_of(read_tile_beams(work.folder, tile), work.facts.empty_reach_m);
    ends.origin = work.facts.origin;
    empty = crossing_rays(ends, work.tiles, executor);
  }
  write_rays(work.path(rays_file_of(tile, RaySort::passing)), passing);
  write_rays(work.path(rays_file_of(tile, RaySort::empty)), empty);
}

}  // namespace

void hand_out_rays(const CityWork& work, ResumableFolder& folder) {
  std::filesystem::create_directories(work.path("rays"));
  const std::optional<LabelScheme> scheme = work.scheme();
  ProgressSink& progress = work.session.progress;
  progress.begin_step("rays", work.facts.tiles.size());
  std::size_t done = 0;
  for (const auto& [tile, count] : work.facts.tiles) {
    const std::vector<std::string> files = {rays_file_of(tile, RaySort::passing),
                                            rays_file_of(tile, RaySort::empty)};
    if (!folder.has(files)) {
      write_rays_of(tile, count, scheme ? &*scheme : nullptr, work);
      folder.record(files);
    }
    progress.advance(++done);
  }
  progress.end_step();
}

}  // namespace adasplats
