// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/city/layer_facts.h"
#include "adasplats/city/tile_grid.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"

namespace adasplats {

// The points of a city on disk, a file a tile: more of them than memory holds. Files of points hold
// pieces one behind another: a line "adasplats points 1 COUNT NAME..." with the attributes that
// there are (PointAttribute::name), then the positions (three floats a point, relative to the
// city's origin) and the attributes' values, one array behind another, as this machine has them
// (little-endian). Files of beams without return: EmptyBeam after EmptyBeam. Of the order of
// points: a number of 64 bits a point, how many came before it in all tiles. Of classes that points
// did not come with: a number of 16 bits a point.

/// Where the points of a tile, their order, their classes and the empty beams are, below the folder
/// of a city.
std::string points_file_of(TileKey tile);
std::string order_file_of(TileKey tile);
std::string classes_file_of(TileKey tile);
std::string beams_file_of(TileKey tile);

/// Puts points into the files of their tiles.
class TilePointsWriter {
 public:
  /// `folder`: of the city, with the folders "points" and "beams" (made where they are not there).
  /// At most `buffered` points wait in memory. `keeps_order`: writes files of the order, too.
  /// `executor` must outlive it; files are the same for any number of threads. `origin`: the
  /// city's, where it is known; else that of the first cloud.
  TilePointsWriter(std::filesystem::path folder, const TileGrid& grid, std::size_t buffered,
                   const Executor& executor, bool keeps_order = false,
                   std::optional<Vec3d> origin = std::nullopt);

  /// Clouds are moved to the city's origin. Empty beams go to the tile in
  /// which they begin. Errors: data (a cloud with other attributes than the first; instances and
  /// kinds of origins may be missing), io.
  void add(const PointCloud& cloud);
  /// Writes what waits. Call once, last.
  std::map<TileKey, TileCount> finish();
  Vec3d origin() const { return origin_.value_or(Vec3d{}); }
  /// The names of those that all points have, each with a space before it.
  std::string attributes() const { return attributes_.value_or(""); }

 private:
  struct Waiting {
    PointCloud points;
    std::vector<std::uint64_t> order;
    std::vector<EmptyBeam> beams;
  };
  void write(TileKey tile, const Waiting& waiting) const;
  GroundBox box_of_rays(const PointCloud& points) const;
  void write_all();

  std::filesystem::path folder_;
  TileGrid grid_;
  std::size_t buffered_;
  const Executor& executor_;
  bool keeps_order_;
  std::uint64_t added_ = 0;  ///< points
  std::size_t waiting_points_ = 0;
  std::optional<Vec3d> origin_;
  std::optional<std::string> attributes_;
  std::map<TileKey, Waiting> waiting_;
  std::map<TileKey, TileCount> counts_;
};

/// Gives a tile's points to `take`, piece by piece. Errors: data (the file is damaged: with its
/// name), those of files.
void read_tile_pieces(const std::filesystem::path& folder, TileKey tile,
                      FunctionRef<void(PointCloud& piece)> take);
/// Adds those of a tile's points to `cloud` for which `wanted` (of a position) holds; all without.
/// `classes`, where given: of all the tile's points, in place of those that they came with. Errors:
/// as above, and data (there are not as many classes as points).
void read_tile_points(const std::filesystem::path& folder, TileKey tile, PointCloud& cloud,
                      const std::function<bool(Vec3f)>& wanted = {},
                      std::span<const std::uint16_t> classes = {});
std::vector<std::uint64_t> read_tile_order(const std::filesystem::path& folder, TileKey tile);
std::vector<std::uint16_t> read_tile_classes(const std::filesystem::path& folder, TileKey tile);
void write_tile_classes(const std::filesystem::path& folder, TileKey tile,
                        std::span<const std::uint16_t> classes);
/// None where there is no file.
std::vector<EmptyBeam> read_tile_beams(const std::filesystem::path& folder, TileKey tile);

}  // namespace adasplats
