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

// The points of a city on disk, one file per tile, for more points than fit in memory. A file of
// points is a sequence of blocks: a line "adasplats points 1 COUNT NAME..." with the names of the
// attributes (PointAttribute::name), then the positions (three floats per point, relative to the
// city's origin) and the values of the attributes, one array after another, in little-endian byte
// order. Other files: beams without return, an array of EmptyBeam; the order of points, a 64-bit
// number per point: how many points came before it in all tiles; classes that replace those of the
// points, a 16-bit number per point.

/// Files of a tile's points, order, classes and empty beams, relative to the folder of a city.
std::string points_file_of(TileKey tile);
std::string order_file_of(TileKey tile);
std::string classes_file_of(TileKey tile);
std::string beams_file_of(TileKey tile);

/// Appends points to the files of their tiles.
class TilePointsWriter {
 public:
  /// `folder`: of the city; its folder "points" is created if missing. At most `buffered` points
  /// wait in memory. `keeps_order`: also write files of the order. `executor` must outlive the
  /// writer; files are the same for any number of threads. `origin`: of the city; default: that of
  /// the first cloud.
  TilePointsWriter(std::filesystem::path folder, const TileGrid& grid, std::size_t buffered,
                   const Executor& executor, bool keeps_order = false,
                   std::optional<Vec3d> origin = std::nullopt);

  /// Clouds are moved to the city's origin. Empty beams go to the tile in which they begin. Errors:
  /// data (a cloud with other attributes than the first; instances and origin kinds may be
  /// missing), io.
  void add(const PointCloud& cloud);
  /// Writes the remaining points. Call once, at the end.
  std::map<TileKey, TileCount> finish();
  Vec3d origin() const { return origin_.value_or(Vec3d{}); }
  /// The names of the attributes that all points have, each preceded by a space.
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

/// Passes a tile's points to `take`, block by block. Errors: data (the file is damaged), no_input.
void read_tile_pieces(const std::filesystem::path& folder, TileKey tile,
                      FunctionRef<void(PointCloud& block)> take);
/// Appends the points of a tile for which `wanted` (of a position) is true; all if it is empty.
/// `classes`, if not empty, replaces the classes of all the tile's points. Errors: as above, and
/// data (the number of classes differs from the number of points).
void read_tile_points(const std::filesystem::path& folder, TileKey tile, PointCloud& cloud,
                      const std::function<bool(Vec3f)>& wanted = {},
                      std::span<const std::uint16_t> classes = {});
std::vector<std::uint64_t> read_tile_order(const std::filesystem::path& folder, TileKey tile);
std::vector<std::uint16_t> read_tile_classes(const std::filesystem::path& folder, TileKey tile);
void write_tile_classes(const std::filesystem::path& folder, TileKey tile,
                        std::span<const std::uint16_t> classes);
/// Empty if the file does not exist.
std::vector<EmptyBeam> read_tile_beams(const std::filesystem::path& folder, TileKey tile);

/// Classes from a network for the points of some squares, which differ from the tiles.
struct SquareClasses {
  std::size_t squares = 0, cells = 0;  ///< processed by the network
  /// By the tile that contains the points, in the order of its file of points.
  std::map<TileKey, std::vector<std::uint16_t>> of_tile;
};

/// "points/NAME.squares" in the folder of a city, for the squares with their center in a tile.
std::string squares_file_of(TileKey tile);
void write_square_classes(const std::filesystem::path& file, const SquareClasses& classes);
/// Errors: no_input, data (damaged).
SquareClasses read_square_classes(const std::filesystem::path& file);

}  // namespace adasplats
