// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/city_rays.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adasplats/city/passing_rays.h"
#include "adasplats/city/tile_points.h"
#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {
namespace {

/// A tile's points without those that a model is made without.
PointCloud points_that_stay(TileKey tile, const LabelScheme* scheme, const CityWork& work) {
  PointCloud cloud;
  cloud.origin = work.facts.origin;
  read_points_of(tile, work, cloud);
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

/// Threads for each tile that is in memory at a time.
constexpr std::size_t kThreadsForRays = 4;

std::vector<std::string> files_of_rays(TileKey tile) {
  return {rays_file_of(tile, RaySort::passing), rays_file_of(tile, RaySort::empty)};
}

/// Writes the rays of some tiles at the same time.
void write_rays_of_all(std::span<const TileKey> tiles, const LabelScheme* scheme,
                       const CityWork& work, ResumableFolder& folder) {
  std::vector<FileDigest> digests(2 * tiles.size());
  work.session.executor.for_chunks(tiles.size(), 1, [&](std::size_t k, std::size_t) {
    write_rays_of(tiles[k], work.facts.tiles.at(tiles[k]), scheme, work);
    std::size_t next = 2 * k;
    for (const std::string& file : files_of_rays(tiles[k]))
      digests[next++] = {file, sha256_of_file(work.path(file))};
  });
  folder.record(digests);
}

}  // namespace

void hand_out_rays(const CityWork& work, ResumableFolder& folder) {
  std::filesystem::create_directories(work.path("rays"));
  const std::optional<LabelScheme> scheme = work.scheme();
  ProgressSink& progress = work.session.progress;
  std::vector<TileKey> to_do;
  for (const auto& [tile, count] : work.facts.tiles)
    if (!folder.has(files_of_rays(tile))) to_do.push_back(tile);
  progress.begin_step("rays", to_do.size());
  const auto threads = static_cast<std::size_t>(work.session.executor.threads());
  const std::size_t at_once = std::max<std::size_t>(1, threads / kThreadsForRays);
  for (std::size_t first = 0; first < to_do.size(); first += at_once) {
    const std::size_t count = std::min(at_once, to_do.size() - first);
    write_rays_of_all(std::span(to_do).subspan(first, count), scheme ? &*scheme : nullptr, work,
                      folder);
    progress.advance(first + count);
  }
  progress.end_step();
}

}  // namespace adasplats
