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

/// The splat of a city that a ray meets first.
struct CityHit {
  float range_m = 0;
  std::size_t splat = 0;  ///< among all of the city, tile after tile
  Disk disk;              ///< relative to the city's origin
  std::optional<std::uint16_t> class_id;
  std::optional<float> intensity;
};

/// Casts single rays into a city whose tiles are on disk: into those that a ray crosses, nearest
/// first, which are loaded one by one; a few stay in memory. Used by one thread.
class CityPicker {
 public:
  /// A ray that met nothing in so many tiles goes no further.
  static constexpr std::size_t kMaxTiles = 8;
  /// Tiles stay in memory while they have no more together (about 100 MB); the last one does in any
  /// case.
  static constexpr std::size_t kKeptSplats = 2'000'000;

  CityPicker(std::filesystem::path folder, CityManifest city);

  /// `ray`: relative to the city's origin. Errors: those of load_city_tile().
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
  std::vector<std::size_t> first_splats_;  ///< of each tile
  std::list<Kept> kept_;                   ///< last used first
};

}  // namespace adasplats
