// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "adasplats/city/passing_rays.h"
#include "adasplats/core/progress.h"
#include "adasplats/jobs/city/city_work.h"

namespace adasplats {

/// Makes the models of tiles, of nothing but the job and the files of the folder: points, rays,
/// spacing and (but for the pilot tile) the response of the sensor.
class TileModeller {
 public:
  /// `work` must outlive it. Reads where the rays for each tile are.
  explicit TileModeller(const CityWork& work);

  /// The splats of a tile. The pilot's have the response of the sensor by its own rays,
  /// others `work.response`. Several threads may call it, each with a session of its own.
  SplatModel model(TileKey tile, Session& session) const;

  /// The files of the folder that hold the points, their classes where a network gives them, and
  /// the rays that a tile is modelled with.
  std::vector<std::string> files_for(TileKey tile) const;

 private:
  GlobalContext whole_of(TileKey tile) const;
  void keep_own(TileKey tile, SplatModel& model) const;

  /// Where a layer's rays for each tile are.
  struct LayerRays {
    RayFiles passing, empty;
  };

  const CityWork& work_;
  std::vector<CityTile> tiles_;
  std::optional<TileKey> pilot_;  ///< nothing where the response was known before
  std::vector<LayerRays> rays_;   ///< layer by layer
};

/// The response of the sensor, of a file of a model; nothing where it has none.
std::optional<IntensityResponse> load_response(const std::filesystem::path& file);

}  // namespace adasplats
