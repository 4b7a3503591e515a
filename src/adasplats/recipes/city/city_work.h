// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/city/passing_rays.h"
#include "adasplats/city/tile_points.h"
#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/pipeline/model/make_model.h"
#include "adasplats/pipeline/session/session.h"
#include "adasplats/recipes/city/city_job.h"
#include "adasplats/splats/consistent/whole_place.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

/// The command that makes cities.
inline constexpr const char* kCityCommand = "model";

// Files of an unfinished city that say what is known of the whole; all of it is written before the
// first tile that needs it is modelled.
inline constexpr const char* kPointsFile = "points/points.json";     ///< CityFacts
inline constexpr const char* kClassesFile = "points/classes.json";   ///< of points by a network
inline constexpr const char* kSpacingFile = "points/spacing.json";   ///< TypicalSpacing
inline constexpr const char* kResponseFile = "points/response.ply";  ///< of the pilot tile

/// What is known of the points of a city when all are read.
struct CityFacts {
  Vec3d origin;  ///< of all clouds and models of its tiles, world coordinates
  CurveBox box;
  std::size_t points_read = 0;
  /// Measured ones that stay. Where a network gives the points classes it is 0 in kPointsFile, and
  /// comes from kClassesFile.
  std::size_t rays = 0;
  float empty_reach_m = 0;
  std::map<TileKey, TileCount> tiles;
};

std::string text_of(const CityFacts& facts);
/// Reads kPointsFile. Errors: no_input, data (damaged).
CityFacts load_facts(const std::filesystem::path& file);

/// What the steps that make a city share. Each fills in what it finds out, or reads what an earlier
/// run found out from the files of the folder.
struct CityWork {
  const CityJob& job;
  const ConsistentOptions& options;  ///< the job's
  Session& session;
  std::filesystem::path folder;  ///< the unfinished one, with the points and the rays
  CityFacts facts;
  SplatModel common;  ///< without splats: coordinate system, label scheme, calibration
  TileSet tiles;      ///< those with points, which are modelled
  TypicalSpacing typical;
  std::optional<SegmentReport> segmented;     ///< where a network gives the points classes
  double calibrated_s = 0;                    ///< of reading the points
  std::optional<IntensityResponse> response;  ///< of the sensor, by the pilot tile; nothing: none

  CityWork(const CityJob& its_job, Session& its_session, std::filesystem::path its_folder);
  std::filesystem::path path(const std::string& file) const { return folder / file; }
  /// What labels mean, by the network or the job's inputs; nothing without labels.
  std::optional<LabelScheme> scheme() const;
};

/// The tiles that are modelled, in order, with nothing known of their splats.
std::vector<CityTile> tiles_to_model(const CityWork& work);
/// The one with the most points: its rays say what the sensor's response is.
TileKey pilot_tile(const CityWork& work);

/// Those with points that a piece of the ground touches, in order.
std::vector<TileKey> tiles_in(const GroundBox& ground, const CityWork& work);
/// The tiles whose points a tile is modelled with: itself and those in its halo.
std::vector<TileKey> tiles_around(TileKey tile, const CityWork& work);
/// Adds a tile's points, as read_tile_points() does, with the classes that they are modelled by.
void read_points_of(TileKey tile, const CityWork& work, PointCloud& cloud,
                    const std::function<bool(Vec3f)>& wanted = {});
/// The points that a tile is modelled with: its own and those in its halo.
PointCloud points_around(TileKey tile, const CityWork& work);

}  // namespace adasplats
