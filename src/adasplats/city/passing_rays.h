// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "adasplats/city/tile_grid.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// Ends and sensor positions of rays, by the tile that they are for.
using RaysByTile = std::map<TileKey, PointCloud>;

/// Which tiles there are, and how far a tile looks beyond its borders.
struct TileSet {
  TileGrid grid;
  double halo_m = 0;
  std::set<TileKey> tiles;

  /// The ground that a tile is modelled on.
  GroundBox reach_of(TileKey tile) const { return grid.box_of(tile).grown(halo_m); }
  /// Those that a piece of the ground touches, in order.
  std::vector<TileKey> touched(const GroundBox& ground) const;
  /// Those whose reach a straight way has a part in.
  std::set<TileKey> crossed(Vec3d from, Vec3d to) const;
};

/// The measured rays of points with a beam, by the tiles whose reach they cross and in whose reach
/// they do not end: to these they say what is free. `cloud.empty_beams` are left alone.
RaysByTile passing_rays(const PointCloud& cloud, const TileSet& tiles, double min_range_m,
                        const Executor& executor);
/// Rays that end nowhere, as ends_of() makes them, by all tiles whose reach they cross.
RaysByTile crossing_rays(const PointCloud& ends, const TileSet& tiles, const Executor& executor);

/// The rays that begin in one tile, for others, in a file: "rays/NAME.passing" or ".empty" below
/// the folder of a city, with a head that says where those of each tile are.
enum class RaySort : std::uint8_t { passing, empty };
std::string rays_file_of(TileKey from, RaySort sort);
void write_rays(const std::filesystem::path& file, const RaysByTile& rays);

/// Reads the rays for tiles from the files of all.
class RayFiles {
 public:
  /// Reads the heads. Files that are not there have none. Errors: data (damaged).
  RayFiles(const std::filesystem::path& folder, const std::set<TileKey>& tiles, RaySort sort);
  /// Those for one tile, with ends and sensor positions.
  PointCloud read(TileKey tile) const;
  /// The tiles whose files have rays for one.
  std::vector<TileKey> sources(TileKey tile) const;
  /// The tiles that there are rays for.
  std::vector<TileKey> targets() const;

 private:
  struct Place {
    TileKey from;
    std::filesystem::path file;
    std::size_t at = 0;  ///< bytes
    std::size_t rays = 0;
  };
  std::map<TileKey, std::vector<Place>> places_;
};

}  // namespace adasplats
