// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/make_city.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/output/resumable_folder.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/pipeline/session/repeated_warnings.h"
#include "adasplats/recipes/city/city_classes.h"
#include "adasplats/recipes/city/city_level_files.h"
#include "adasplats/recipes/city/city_points.h"
#include "adasplats/recipes/city/city_rays.h"
#include "adasplats/recipes/city/city_survey.h"
#include "adasplats/recipes/city/city_tiles.h"
#include "adasplats/recipes/city/tile_workers.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The order of the steps, with the folder that they go on in.
class CityMaker {
 public:
  CityMaker(const CityJob& job, Session& session)
      : classifier_(classifier_for(job)),
        folder_(job.output, job.overwrite, kCityCommand, content_with_network(job)),
        work_(job, session, folder_.path()) {
    if (classifier_) work_.common.network_sha256 = classifier_->facts().sha256;
  }

  CityResult run() {
    prepare();
    step("tiles", [&] { model_tiles(); });
    write_manifest();
    return std::move(result_);
  }

  /// All but the tiles behind the pilot; gives those that are to be done.
  std::vector<TileKey> plan() {
    prepare();
    fs::create_directories(work_.path("tiles"));
    model_pilot(TileModeller(work_), work_.session.progress);
    std::vector<TileKey> to_do;
    for (const CityTile& tile : result_.city.tiles)
      if (!is_made(tile.key)) to_do.push_back(tile.key);
    return to_do;
  }

 private:
  /// Tasks do not run the network, and so do not look what is in it.
  Json content_with_network(const CityJob& job) const {
    Json content = content_of(job);
    if (classifier_) content["network_sha256"] = classifier_->facts().sha256;
    return content;
  }

  template <class Work>
  void step(const char* name, const Work& work) {
    const Stopwatch watch;
    work();
    result_.steps.push_back({name, watch.seconds()});
  }

  /// All that comes before the tiles.
  void prepare() {
    step("points", [&] { sort_points(work_, folder_); });
    result_.steps.push_back({"calibration_of_points", work_.calibrated_s});
    if (classifier_) step("segment", [&] { give_classes(*classifier_, work_, folder_); });
    step("rays", [&] { hand_out_rays(work_, folder_); });
    step("spacing", [&] { survey_spacing(work_, folder_); });
    result_.points_read = work_.facts.points_read;
    result_.segmented = work_.segmented;
    result_.city.tiles = tiles_to_model(work_);
  }

  /// Its tile comes first: the others need the response that it finds.
  void model_pilot(const TileModeller& modeller, ProgressSink& warnings) {
    CityTile& pilot = *std::ranges::find(result_.city.tiles, pilot_tile(work_), &CityTile::key);
    if (!take_made(pilot)) {
      Session session = {work_.session.executor, warnings, work_.session.seed,
                         work_.session.device};
      note(model_and_save(pilot, work_, modeller, session));
    }
    find_response(pilot);
  }

  void model_tiles() {
    fs::create_directories(work_.path("tiles"));
    const TileModeller modeller(work_);
    RepeatedWarnings warnings(work_.session.progress, "tiles");
    work_.session.progress.begin_step("tiles", work_.tiles.tiles.size());
    model_pilot(modeller, warnings);
    std::vector<CityTile> to_do;
    for (CityTile& tile : result_.city.tiles)
      if (tile.key != pilot_tile(work_) && !take_made(tile)) to_do.push_back(tile);
    std::size_t done = result_.city.tiles.size() - to_do.size();
    work_.session.progress.advance(done);
    adasplats::model_tiles(work_, modeller, to_do, warnings, [&](const CityTile& made) {
      note(made);
      work_.session.progress.advance(++done);
    });
    work_.session.progress.end_step();
    warnings.end();
  }

  /// By an earlier run, or by a task.
  bool is_made(TileKey tile) {
    const std::string file = model_file_of(tile);
    return folder_.has(file) || folder_.take(file);
  }

  bool take_made(CityTile& tile) {
    if (!is_made(tile.key)) return false;
    set_splats(load_model(work_.path(model_file_of(tile.key))), tile);
    tile.sha256 = folder_.recorded().at(model_file_of(tile.key));
    ++result_.tiles_resumed;
    return true;
  }

  /// That the file of a tile is whole.
  void note(const CityTile& made) {
    const FileDigest digest = {model_file_of(made.key), made.sha256};
    folder_.record(std::span(&digest, 1));
    *std::ranges::find(result_.city.tiles, made.key, &CityTile::key) = made;
  }

  /// Of the pilot tile that was modelled, for the others, into a file of its own.
  void find_response(const CityTile& pilot) {
    if (!folder_.has(kResponseFile)) {
      SplatModel sensor = work_.common;
      sensor.response = load_model(work_.path(model_file_of(pilot.key))).response;
      save_model(work_.path(kResponseFile), sensor);
      folder_.record(std::string(kResponseFile));
    }
    work_.response = load_response(work_.path(kResponseFile));
  }

  void write_manifest() {
    result_.city.grid = work_.tiles.grid;
    result_.city.origin = work_.facts.origin;
    result_.city.halo_m = work_.tiles.halo_m;
    if (result_.city.splats() == 0)
      throw Error(ErrorKind::data, "no splats: no surface was found in any tile");
    write_level_files(result_.city, folder_, work_.session);
    if (work_.response) {
      work_.common.response = *work_.response;
      save_model(work_.path(kCityCommonFile), work_.common);
      folder_.record(std::string(kCityCommonFile));
    }
    write_file_in_place(work_.path(kCityFile), city_text(result_.city));
    folder_.record(std::string(kCityFile));
    fs::remove_all(work_.path("rays"));
    fs::remove_all(work_.path("points"));
    folder_.commit({{"points", result_.city.points()}, {"splats", result_.city.splats()}}, aids());
  }

  /// What was recorded and is no part of the city.
  std::vector<std::string> aids() const {
    std::vector<std::string> files;
    for (const auto& [file, hash] : folder_.recorded())
      if (file.starts_with("rays/") || file.starts_with("points/")) files.push_back(file);
    return files;
  }

  std::optional<PointClassifier> classifier_;
  ResumableFolder folder_;
  CityWork work_;
  CityResult result_;
};

}  // namespace

CityResult make_city(const CityJob& job, Session& session) {
  for (const fs::path& input : job.inputs) require_input(input);
  const Stopwatch total;
  CityResult result = CityMaker(job, session).run();
  result.seconds = total.seconds();
  return result;
}

std::vector<TileKey> plan_city(const CityJob& job, Session& session) {
  for (const fs::path& input : job.inputs) require_input(input);
  return CityMaker(job, session).plan();
}

Json to_json(const CityResult& result) {
  Json json = {{"points_read", result.points_read},     {"points", result.city.points()},
               {"primitives", result.city.splats()},    {"tiles", result.city.tiles.size()},
               {"tiles_resumed", result.tiles_resumed}, {"tile_m", result.city.grid.side_m},
               {"halo_m", result.city.halo_m}};
  if (result.segmented) json["segmentation"] = to_json(*result.segmented);
  json["seconds"]["total"] = result.seconds;
  for (const StepTime& step : result.steps) json["seconds"][step.name] = step.seconds;
  return json;
}

}  // namespace adasplats
