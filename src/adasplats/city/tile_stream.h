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

/// Where a sensor is during a scan, and how far it sees: the box of its places in world
/// coordinates.
struct SeenFrom {
  Vec3d low, high;
  double range_m = 0;

  /// Whether something of the tile may be in reach.
  bool reaches(const CityTile& tile) const;
};

/// Who holds the tiles that are loaded, by their numbers in CityManifest::tiles.
class TileHolder {
 public:
  virtual ~TileHolder() = default;

  /// About how much memory a splat takes, bytes.
  virtual std::size_t bytes_a_splat() const = 0;
  /// Takes a tile; on another thread than the rest, and while others are used.
  virtual void load(std::size_t tile, SplatModel&& model, const Executor& executor) = 0;
  /// Gives back what a tile took. Nothing is used meanwhile, nor while this is called:
  virtual void drop(std::size_t tile) = 0;
  /// Which tiles are used from now on, ascending.
  virtual void show(std::span<const std::size_t> tiles) = 0;
};

/// What was done so far.
struct TileStreamCounts {
  std::size_t loaded = 0;     ///< tiles, each as often as it was
  std::size_t max_bytes = 0;  ///< that tiles took at the same time, as bytes_a_splat() says
  double waited_s = 0;        ///< for tiles
};

/// Tiles of a city that come and go ahead of a sensor. A thread of its own loads them in the order
/// in which they will be needed, while scans are cast in those that are there. Used by one thread.
class TileStream {
 public:
  /// Scans ahead whose tiles are looked for.
  static constexpr std::size_t kHorizon = 2048;

  /// `folder`: of the city. `budget_bytes`: that tiles may take; what one scan needs is there in
  /// any case. `holder` must outlive it.
  TileStream(std::filesystem::path folder, const CityManifest& city, TileHolder& holder,
             std::size_t budget_bytes, int threads);
  ~TileStream();
  TileStream(const TileStream&) = delete;
  TileStream& operator=(const TileStream&) = delete;

  /// Shows all that the first of some scans need, which are those of a drive from now on, and gives
  /// how many (at least one of them). Tiles of the next ones are loaded meanwhile. Nothing is cast
  /// while it is called. Errors: those of load_city_tile().
  std::size_t prefetch(std::span<const SeenFrom> scans);
  TileStreamCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
