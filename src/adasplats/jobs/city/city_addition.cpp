// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_addition.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/output/unfinished_folder.h"
#include "adasplats/jobs/session/settings_json.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// What may differ between the job that made a city and one that adds to it: what is read, and how
/// it is corrected.
constexpr const char* kOfInputs[] = {"inputs", "input_bytes", "load",
                                     "scans",  "keep_points", "add_to",
                                     "labels", "network",     "max_shift_m"};

Json settings_of(const CityJob& job) {
  Json settings = content_of(job);
  for (const char* key : kOfInputs) settings.erase(key);
  Json calibration;
  put_settings(job.calibration, calibration);
  for (const auto& [key, value] : calibration.items()) settings.erase(key);
  return settings;
}

Json content_in(const fs::path& city) {
  const fs::path file = city / kContentFile;
  Json content = Json::parse(read_file(file), nullptr, false);
  if (!content.is_object() || !content.contains("outputs") || !content["outputs"].is_object())
    throw Error(ErrorKind::data, file.string() + ": damaged");
  return content;
}

/// Whether a tile is modelled with points of the last layer, or has a new neighbour: splats that it
/// had there now belong to the neighbour.
bool has_new_points(TileKey tile, const CityWork& work) {
  const PointLayer& added = work.layers.back();
  const GroundBox reach = work.tiles.reach_of(tile);
  for (const TileKey near : work.tiles.touched(work.tiles.grid.box_of(tile).grown(1e-3)))
    if (added.has_points(near) && work.points_in(near) == added.facts.tiles.at(near).points)
      return true;
  for (const TileKey near : tiles_around(tile, work)) {
    if (!added.has_points(near)) continue;
    bool found = false;
    read_tile_pieces(work.path(added.folder), near, [&](const PointCloud& piece) {
      found = found || std::ranges::any_of(piece.positions, [&](Vec3f p) {
                return reach.contains(work.origin() + vec_cast<double>(p));
              });
    });
    if (found) return true;
  }
  return false;
}

/// A file of the same content at another place, without copying it where that can be done.
void link_or_copy(const fs::path& from, const fs::path& to) {
  fs::create_directories(to.parent_path());
  fs::remove(to);
  std::error_code cannot;
  fs::create_hard_link(from, to, cannot);
  if (cannot) fs::copy_file(from, to, cannot);
  if (cannot) throw Error(ErrorKind::io, to.string() + ": cannot be written: " + cannot.message());
}

}  // namespace

TileChoice tiles_of_city(const fs::path& city) {
  const CityManifest manifest = load_city_manifest(city);
  return {manifest.grid.side_m, manifest.halo_m};
}

CityToExtend::CityToExtend(const CityJob& job)
    : city_(job.add_to),
      manifest_(load_city_manifest(city_)),
      content_(std::make_unique<Json>(content_in(city_))) {
  try {
    for (const auto& [name, digest] : (*content_)["outputs"].items()) digests_[name] = digest;
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, (city_ / kContentFile).string() + ": damaged: " + error.what());
  }
  content_->erase("outputs");
  while (digests_.contains(PointLayer{layer_folder(layers_), {}}.file(kPointsFile))) ++layers_;
  if (layers_ == 0)
    throw Error(ErrorKind::usage, city_.string() +
                                      ": it was made without its points being kept "
                                      "(`keep_points`), which are needed around what is added: "
                                      "model all inputs together");
  const std::string differs = difference_of_runs(*content_, settings_of(job));
  if (!differs.empty())
    throw Error(ErrorKind::usage,
                "what is added to " + city_.string() + " must be modelled as it was: " + differs);
}

CityBefore CityToExtend::before() const {
  const SplatModel common = load_model(city_ / kCityCommonFile);
  const LayerFacts facts = load_facts(city_ / layer_folder(0) / kPointsFile);
  CityBefore before;
  before.city = city_;
  before.origin = facts.origin;
  before.crs = common.crs;
  before.label_scheme = common.label_scheme;
  before.attributes = facts.attributes;
  const auto tile = std::ranges::max_element(manifest_.tiles, {}, &CityTile::points);
  before.place = 0.5 * (tile->low + tile->high);
  return before;
}

void verify_layers(const fs::path& city) {
  if (!fs::exists(city / layer_folder(0))) return;
  const Json content = content_in(city);
  for (const auto& [name, digest] : content["outputs"].items())
    if (name.starts_with("layers/") && Json(sha256_of_file(city / name)) != digest)
      throw Error(ErrorKind::data,
                  (city / name).string() + ": not the file that was written (its SHA-256 differs)");
}

Json CityToExtend::content() const {
  return {{"sha256", digest_of(kCityFile)}, {"made_of", *content_}};
}

const std::string& CityToExtend::digest_of(const std::string& file) const {
  const auto found = digests_.find(file);
  if (found == digests_.end())
    throw Error(ErrorKind::data, (city_ / kContentFile).string() + ": damaged: it has no " + file);
  return found->second;
}

void CityToExtend::hand_over_layers(ResumableFolder& to, const Executor& executor) const {
  std::vector<FileDigest> files;
  for (const auto& [name, digest] : digests_)
    if (name.starts_with("layers/") && !to.recorded().contains(name))
      files.push_back({name, digest});
  executor.for_chunks(files.size(), 1, [&](std::size_t k, std::size_t) {
    const fs::path from = city_ / files[k].name;
    if (sha256_of_file(from) != files[k].sha256)
      throw Error(ErrorKind::data,
                  from.string() + ": not the file that was written (its SHA-256 differs)");
    link_or_copy(from, to.path() / files[k].name);
  });
  to.record(files);
}

void CityToExtend::hand_over_tile(const CityTile& tile, ResumableFolder& to) const {
  const std::string file = model_file_of(tile.key);
  const fs::path from = city_ / file;
  if (sha256_of_file(from) != tile.sha256)
    throw Error(ErrorKind::data,
                from.string() + ": not the file that was written (its SHA-256 differs)");
  link_or_copy(from, to.path() / file);
  const FileDigest digest = {file, tile.sha256};
  to.record(std::span(&digest, 1));
}

std::set<TileKey> tiles_reached(const CityWork& work) {
  const PointLayer& added = work.layers.back();
  std::set<TileKey> begin, reached;
  for (const auto& [tile, count] : added.facts.tiles) begin.insert(tile);
  for (const RaySort sort : {RaySort::passing, RaySort::empty})
    for (const TileKey tile : RayFiles(work.path(added.folder), begin, sort).targets())
      reached.insert(tile);
  for (const TileKey tile : work.tiles.tiles)
    if (!reached.contains(tile) && has_new_points(tile, work)) reached.insert(tile);
  return reached;
}

}  // namespace adasplats
