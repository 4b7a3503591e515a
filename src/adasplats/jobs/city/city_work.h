// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/city/passing_rays.h"
#include "adasplats/jobs/city/city_job.h"
#include "adasplats/jobs/city/point_layer.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/splats/consistent/global_context.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

/// The command that makes cities.
inline constexpr const char* kCityCommand = "model";

/// How many layers an unfinished city has, written when the rays of all are handed out.
inline constexpr const char* kLayersFile = "layers/layers.json";
// Files of the first layer that say what is known of the whole; all of it is written before the
// first tile that needs it is modelled.
inline constexpr const char* kSpacingFile = "layers/0/points/spacing.json";   ///< TypicalSpacing
inline constexpr const char* kResponseFile = "layers/0/points/response.ply";  ///< of the pilot tile

/// What the steps that make a city share. Each fills in what it finds out, or reads what an earlier
/// run found out from the files of the folder.
struct CityWork {
  const CityJob& job;
  const ConsistentOptions options;  ///< the job's
  Session& session;
  std::filesystem::path folder;    ///< the unfinished one
  std::vector<PointLayer> layers;  ///< one at least; the last is of the job's inputs
  SplatModel common;               ///< without splats: coordinate system, label scheme, calibration
  TileSet tiles;                   ///< those with points of any layer
  TypicalSpacing typical;
  std::optional<IntensityResponse> response;  ///< of the sensor, by the pilot tile; nothing: none

  CityWork(const CityJob& its_job, Session& its_session, std::filesystem::path its_folder);
  std::filesystem::path path(const std::string& file) const { return folder / file; }
  /// Takes the next layer; what the first says of the whole (box, number of rays, origin) holds for
  /// all.
  void add(PointLayer layer);
  const LayerFacts& first() const { return layers.front().facts; }
  Vec3d origin() const { return first().origin; }
  /// Of all layers.
  std::size_t points_in(TileKey tile) const;
};

/// Reads the layers of an unfinished folder that are sorted, the first `count`, and what tiles have
/// in common.
void load_layers(std::size_t count, CityWork& work);

/// Reads kLayersFile. Errors: no_input, data (damaged).
std::size_t load_layer_count(const std::filesystem::path& file);

/// The tiles that are modelled, in order, with nothing known of their splats.
std::vector<CityTile> tiles_to_model(const CityWork& work);
/// The one with the most points: its rays say what the sensor's response is.
TileKey pilot_tile(const CityWork& work);

/// The tiles whose points a tile is modelled with: itself and those in its halo.
std::vector<TileKey> tiles_around(TileKey tile, const CityWork& work);
/// The points that a tile is modelled with: its own and those in its halo.
PointCloud points_around(TileKey tile, const CityWork& work);
/// Those of one layer.
PointCloud points_around(TileKey tile, const PointLayer& layer, const CityWork& work);

}  // namespace adasplats
