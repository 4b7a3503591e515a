// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <optional>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

/// The nearest splat of a city that a ray hits.
struct CityHit {
  float range_m = 0;
  std::size_t splat = 0;  ///< index in the city, tile after tile
  Disk disk;              ///< relative to the city's origin
  std::optional<std::uint16_t> class_id;
  std::optional<float> intensity;
};

/// Casts single rays into a city whose tiles are on disk. Loads the crossed tiles one by one,
/// nearest first, and keeps a few in memory. Not thread-safe.
class CityPicker {
 public:
  /// Maximum number of tiles to test per ray.
  static constexpr std::size_t kMaxTiles = 8;
  /// Maximum splats of the tiles in memory (about 100 MB); the last tile stays whatever its size.
  static constexpr std::size_t kKeptSplats = 2'000'000;

  CityPicker(std::filesystem::path folder, CityManifest city);

  /// The nearest hit of a ray relative to the city's origin. Errors: those of load_city_tile().
  std::optional<CityHit> nearest(const Ray& ray);

 private:
  struct Kept {
    std::size_t tile;
    SplatModel model;
  };
  struct Crossing {
    float range_m;
    std::size_t tile;
  };

  std::vector<Crossing> crossed(const Ray& ray) const;
  const SplatModel& tile(std::size_t k);

  std::filesystem::path folder_;
  CityManifest city_;
  std::vector<std::size_t> first_splats_;  ///< first splat of each tile
  std::list<Kept> kept_;                   ///< most recently used first
};

}  // namespace adasplats
