// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_task.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/jobs/city/city_classes.h"
#include "adasplats/jobs/city/city_points.h"
#include "adasplats/jobs/city/city_survey.h"
#include "adasplats/jobs/city/city_tiles.h"
#include "adasplats/jobs/output/folder_task.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

Error no_such_tile(TileKey tile, const fs::path& city) {
  return {ErrorKind::usage,
          "`only_tile` " + name_of(tile) + ": no points of " + city.string() + " are there"};
}

/// Files that the plan has made, as they were written.
void require_planned(const std::vector<std::string>& files, const FolderTask& task) {
  for (const std::string& file : files)
    if (!task.is_recorded(file))
      throw Error(ErrorKind::no_input, task.path().string() +
                                           ": it is not planned to the end: it has no " + file +
                                           "; plan again (`plan`)");
  task.require(files);
}

/// What is known of the whole, of the files of the folder.
void load_what_is_known(CityWork& work, const FolderTask& task) {
  require_planned({kLayersFile, kSpacingFile, kResponseFile}, task);
  const std::size_t layers = load_layer_count(work.path(kLayersFile));
  std::vector<std::string> files;
  for (std::size_t k = 0; k < layers; ++k) {
    const PointLayer layer = {layer_folder(k), {}};
    files.push_back(layer.file(kPointsFile));
    files.push_back(layer.file(kLayerCommonFile));
    if (work.job.segment.on) files.push_back(layer.file(kClassesFile));
  }
  require_planned(files, task);
  load_layers(layers, work);
  work.typical = load_spacing(work.path(kSpacingFile));
  work.response = load_response(work.path(kResponseFile));
}

/// The files that a tile is made of are as they were written, and none of another tile is missing
/// that might have had rays for it.
void check_files(TileKey tile, const TileModeller& modeller, const CityWork& work,
                 const FolderTask& task) {
  task.require(modeller.files_for(tile));
  for (const PointLayer& layer : work.layers) {
    for (const auto& [from, count] : layer.facts.tiles) {
      for (const RaySort sort : {RaySort::passing, RaySort::empty}) {
        const fs::path file = work.path(layer.file(rays_file_of(from, sort)));
        if (!fs::is_regular_file(file))
          throw Error(ErrorKind::data,
                      file.string() + ": it is not there any more; plan again (`plan`)");
      }
    }
  }
}

/// Of a city that is finished.
CityTaskResult finished_tile(TileKey tile, const FolderTask& task) {
  const CityManifest city = load_city_manifest(task.path());
  if (!std::ranges::binary_search(city.tiles, tile, {}, &CityTile::key))
    throw no_such_tile(tile, task.path());
  const std::string file = model_file_of(tile);
  if (!task.has(file))
    throw Error(ErrorKind::data,
                (task.path() / file).string() +
                    ": has changed since it was written, and the city is finished; "
                    "model it again (`overwrite`)");
  return {file, true};
}

}  // namespace

CityTaskResult make_city_tile(const CityJob& job, TileKey tile, Session& session) {
  nlohmann::ordered_json content = content_of(job);
  content.erase("input_bytes");  // the inputs need not be on this machine
  FolderTask task(job.output, kCityCommand, content);
  if (task.is_finished()) return finished_tile(tile, task);
  CityWork work(job, session, task.path());
  load_what_is_known(work, task);
  if (!work.tiles.tiles.contains(tile)) throw no_such_tile(tile, job.output);
  const std::string file = model_file_of(tile);
  if (task.has(file)) return {file, true};
  const TileModeller modeller(work);
  check_files(tile, modeller, work, task);
  save_model(work.path(file), modeller.model(tile, session));
  task.record(file);
  return {file, false};
}

}  // namespace adasplats
