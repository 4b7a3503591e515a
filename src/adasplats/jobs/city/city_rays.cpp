// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_rays.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
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

namespace fs = std::filesystem;

/// The rays of a layer for tiles.
class LayerRays {
 public:
  LayerRays(const PointLayer& layer, const TileSet& tiles, const CityWork& work)
      : layer_(layer), tiles_(tiles), work_(work), scheme_(scheme_of(work.job)) {}

  /// Writes the rays that begin in a tile.
  void write(TileKey tile) const {
    const Executor& executor = work_.session.executor;
    const TileCount& count = layer_.facts.tiles.at(tile);
    RaysByTile passing, empty;
    if (count.points > 0 && may_reach(count.rays))
      passing = passing_rays(points_that_stay(tile), tiles_, work_.options.min_range_m, executor);
    const auto reach_m = static_cast<double>(layer_.facts.empty_reach_m);
    if (count.empty_beams > 0 && may_reach(tiles_.grid.box_of(tile).grown(reach_m))) {
      PointCloud ends = ends_of(read_tile_beams(folder(), tile), layer_.facts.empty_reach_m);
      ends.origin = work_.origin();
      empty = crossing_rays(ends, tiles_, executor);
    }
    write_rays(folder() / rays_file_of(tile, RaySort::passing), passing);
    write_rays(folder() / rays_file_of(tile, RaySort::empty), empty);
  }

  std::vector<std::string> files_of(TileKey tile) const {
    return {layer_.file(rays_file_of(tile, RaySort::passing)),
            layer_.file(rays_file_of(tile, RaySort::empty))};
  }

 private:
  bool may_reach(const GroundBox& box) const {
    return std::ranges::any_of(tiles_.tiles,
                               [&](TileKey to) { return tiles_.reach_of(to).touches(box); });
  }

  fs::path folder() const { return work_.path(layer_.folder); }

  /// A tile's points without those that a model is made without.
  PointCloud points_that_stay(TileKey tile) const {
    PointCloud cloud;
    cloud.origin = work_.origin();
    read_points_of(tile, folder(), work_.job, cloud);
    const RemovedPoints removed =
        points_to_remove(cloud, scheme_ ? &*scheme_ : nullptr, work_.job.build.remove);
    if (removed.ids.empty() || cloud.classes.empty()) return cloud;
    std::vector<std::uint32_t> stay;
    for (std::uint32_t i = 0; i < cloud.size(); ++i)
      if (removed.ids[cloud.classes[i]] == 0) stay.push_back(i);
    return gather(cloud, stay);
  }

  const PointLayer& layer_;
  const TileSet& tiles_;
  const CityWork& work_;
  std::optional<LabelScheme> scheme_;
};

/// Threads for each tile that is in memory at a time.
constexpr std::size_t kThreadsForRays = 4;

/// Writes the rays of some tiles at the same time.
void write_rays_of_all(std::span<const TileKey> tiles, const LayerRays& rays, const CityWork& work,
                       ResumableFolder& folder) {
  std::vector<FileDigest> digests(2 * tiles.size());
  work.session.executor.for_chunks(tiles.size(), 1, [&](std::size_t k, std::size_t) {
    rays.write(tiles[k]);
    std::size_t next = 2 * k;
    for (const std::string& file : rays.files_of(tiles[k]))
      digests[next++] = {file, sha256_of_file(work.path(file))};
  });
  folder.record(digests);
}

}  // namespace

void hand_out_rays(const PointLayer& layer, const TileSet& tiles, const CityWork& work,
                   ResumableFolder& folder) {
  fs::create_directories(work.path(layer.file("rays")));
  const LayerRays rays(layer, tiles, work);
  ProgressSink& progress = work.session.progress;
  std::vector<TileKey> to_do;
  for (const auto& [tile, count] : layer.facts.tiles)
    if (!folder.has(rays.files_of(tile))) to_do.push_back(tile);
  progress.begin_step("rays", to_do.size());
  const auto threads = static_cast<std::size_t>(work.session.executor.threads());
  const std::size_t at_once = std::max<std::size_t>(1, threads / kThreadsForRays);
  for (std::size_t first = 0; first < to_do.size(); first += at_once) {
    const std::size_t count = std::min(at_once, to_do.size() - first);
    write_rays_of_all(std::span(to_do).subspan(first, count), rays, work, folder);
    progress.advance(first + count);
  }
  progress.end_step();
}

}  // namespace adasplats
