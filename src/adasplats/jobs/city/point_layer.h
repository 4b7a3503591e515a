// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "adasplats/city/layer_facts.h"
#include "adasplats/city/passing_rays.h"
#include "adasplats/city/tile_points.h"
#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/jobs/city/city_job.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

// The points of a city lie in layers: those that it was made of, and those of each addition. A
// layer is a folder below the city's with points/ and, until the city is finished, rays/.

// Files of a layer, below its folder; all of them are written before the first tile that needs them
// is modelled.
inline constexpr const char* kPointsFile = "points/points.json";      ///< LayerFacts
inline constexpr const char* kLayerCommonFile = "points/common.ply";  ///< LayerWork::common
inline constexpr const char* kClassesFile = "points/classes.json";    ///< of points by a network
inline constexpr const char* kFitFile = "points/fit.json";  ///< of an addition: require_fit()

struct PointLayer {
  std::string folder;  ///< below the city's
  LayerFacts facts;

  /// A file of the layer by its name below the city's folder.
  std::string file(const std::string& name) const { return folder + "/" + name; }
  bool has_points(TileKey tile) const {
    const auto found = facts.tiles.find(tile);
    return found != facts.tiles.end() && found->second.points > 0;
  }
};
/// "layers/0": where the n-th layer is.
std::string layer_folder(std::size_t number);

class CityAlignment;

/// What new points have in common with those of the city that they are added to.
struct CityBefore {
  std::filesystem::path city;
  Vec3d origin;
  Crs crs;
  std::string label_scheme;
  std::string attributes;
  Vec3d place;                         ///< somewhere in the city, world coordinates
  CityAlignment* alignment = nullptr;  ///< lays the scans on the city's splats; null: they stay
};

/// What the steps that read a layer share. Each fills in what it finds out, or reads what an
/// earlier run found out from the files of the folder.
struct LayerWork {
  const CityJob& job;
  const ConsistentOptions options;  ///< the job's
  Session& session;
  std::filesystem::path city;  ///< the unfinished folder
  PointLayer layer;
  std::optional<CityBefore> before;  ///< where points are added to
  SplatModel common;  ///< without splats: coordinate system, label scheme, calibration
  TileSet tiles;      ///< those with points of the layer
  std::optional<SegmentReport> segmented;  ///< where a network gives the points classes
  double calibrated_s = 0;                 ///< of reading the points

  LayerWork(const CityJob& its_job, Session& its_session, std::filesystem::path its_city,
            std::size_t number = 0);
  /// The layer's own.
  std::filesystem::path folder() const { return city / layer.folder; }
  std::filesystem::path path(const std::string& name) const { return folder() / name; }
};

/// What labels of a job's points mean, by the network or the inputs; nothing without labels.
std::optional<LabelScheme> scheme_of(const CityJob& job);

/// Adds the points that a layer has in a tile, as read_tile_points() does, with the classes that
/// they are modelled by. `folder`: the layer's.
void read_points_of(TileKey tile, const std::filesystem::path& folder, const CityJob& job,
                    PointCloud& cloud, const std::function<bool(Vec3f)>& wanted = {});

/// How many measured rays of some points stay, by the points' classes.
std::size_t count_rays(const PointCloud& cloud, const LabelScheme* scheme, const CityJob& job);

}  // namespace adasplats
