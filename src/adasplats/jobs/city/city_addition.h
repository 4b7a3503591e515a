// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "adasplats/city/city_manifest.h"
#include "adasplats/jobs/city/city_job.h"
#include "adasplats/jobs/city/city_work.h"
#include "adasplats/jobs/city/point_layer.h"
#include "adasplats/jobs/output/resumable_folder.h"

namespace adasplats {

/// How the tiles of a city were cut. Errors: those of load_city_manifest.
TileChoice tiles_of_city(const std::filesystem::path& city);

/// A finished city that points are added to. Nothing in its folder is changed.
class CityToExtend {
 public:
  /// `job`: with `add_to`. Errors: no_input, data (no city, damaged), usage (it was made without
  /// its points being kept, or otherwise than the job says: with the setting that differs).
  explicit CityToExtend(const CityJob& job);

  const std::filesystem::path& path() const { return city_; }
  /// How many layers of points it has.
  std::size_t layers() const { return layers_; }
  CityBefore before() const;
  const CityManifest& manifest() const { return manifest_; }
  /// Sources of the extended city besides the job's inputs: those of this city, and its SHA-256.
  nlohmann::ordered_json content() const;

  /// Puts the points of all layers, and what is known of them, into another city's unfinished
  /// folder: as hard links, or copies where the file system has none. Errors: data (a file is not
  /// the one that was written).
  void hand_over_layers(ResumableFolder& to, const Executor& executor) const;
  /// The same for the model of a tile, as the manifest has it.
  void hand_over_tile(const CityTile& tile, ResumableFolder& to) const;

 private:
  const std::string& digest_of(const std::string& file) const;

  std::filesystem::path city_;
  CityManifest manifest_;
  std::unique_ptr<nlohmann::ordered_json> content_;  ///< never null
  std::map<std::string, std::string> digests_;       ///< SHA-256 by file
  std::size_t layers_ = 0;
};

/// Throws data where a file of a city's points is not the one that was written. Errors: no_input.
void verify_layers(const std::filesystem::path& city);

/// The tiles that points or rays of the last layer reach: all others are as they were. Needs the
/// rays of that layer.
std::set<TileKey> tiles_reached(const CityWork& work);

}  // namespace adasplats
