// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "adasplats/city/city_manifest.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

/// Box of a sensor's positions during a scan, in world coordinates, and its range.
struct SeenFrom {
  Vec3d low, high;
  double range_m = 0;

  /// Whether any splat of the tile may be within range.
  bool reaches(const CityTile& tile) const;
};

/// Owner of the loaded tiles; tiles are indices into CityManifest::tiles.
class TileHolder {
 public:
  virtual ~TileHolder() = default;

  /// Approximate memory per splat, bytes.
  virtual std::size_t bytes_per_splat() const = 0;
  /// Receives a loaded tile. Called on the loading thread while other tiles are in use.
  virtual void load(std::size_t tile, SplatModel&& model, const Executor& executor) = 0;
  /// Releases a tile. Like show(), never called while scans are cast.
  virtual void drop(std::size_t tile) = 0;
  /// Sets the tiles to use from now on, ascending.
  virtual void show(std::span<const std::size_t> tiles) = 0;
};

/// Figures of a stream.
struct TileStreamCounts {
  std::size_t loaded = 0;     ///< loaded tiles, counting repeated loads
  std::size_t max_bytes = 0;  ///< maximum memory of tiles, from bytes_per_splat()
  double waited_s = 0;        ///< time spent waiting for tiles
};

/// Loads the tiles of a city ahead of a sensor. A separate thread loads them in the order of need
/// while scans are cast against the loaded ones. Use from one thread.
class TileStream {
 public:
  /// Number of scans ahead for which tiles are loaded.
  static constexpr std::size_t kHorizon = 2048;

  /// `folder`: of the city. `budget_bytes`: maximum memory of tiles, except that the tiles of one
  /// scan are always loaded. `holder` must outlive the stream.
  TileStream(std::filesystem::path folder, const CityManifest& city, TileHolder& holder,
             std::size_t budget_bytes, int threads);
  ~TileStream();
  TileStream(const TileStream&) = delete;
  TileStream& operator=(const TileStream&) = delete;

  /// Shows all tiles that the next scans of a drive need, and returns the number of scans that can
  /// be cast (at least one). Tiles of later scans load meanwhile. No scan may be cast during the
  /// call. Errors: those of load_city_tile().
  std::size_t prefetch(std::span<const SeenFrom> scans);
  TileStreamCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
