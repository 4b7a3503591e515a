// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/make_city.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/city/city_addition.h"
#include "adasplats/jobs/city/city_alignment.h"
#include "adasplats/jobs/city/city_classes.h"
#include "adasplats/jobs/city/city_fit.h"
#include "adasplats/jobs/city/city_level_files.h"
#include "adasplats/jobs/city/city_origins.h"
#include "adasplats/jobs/city/city_points.h"
#include "adasplats/jobs/city/city_rays.h"
#include "adasplats/jobs/city/city_survey.h"
#include "adasplats/jobs/city/city_tiles.h"
#include "adasplats/jobs/city/tile_workers.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/repeated_warnings.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The order of the steps, with the folder that they go on in.
class CityMaker {
 public:
  CityMaker(const CityJob& job, Session& session)
      : classifier_(classifier_for(job)),
        before_(job.add_to.empty() ? nullptr : std::make_unique<CityToExtend>(job)),
        folder_(job.output, job.overwrite, kCityCommand, whole_content(job)),
        work_(job, session, folder_.path()) {}

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
    if (before_)
      take_over_tiles();
    else
      model_pilot(TileModeller(work_), work_.session.progress);
    std::vector<TileKey> to_do;
    for (const CityTile& tile : result_.city.tiles)
      if (!is_made(tile.key)) to_do.push_back(tile.key);
    return to_do;
  }

 private:
  /// Tasks do not run the network, and so do not look what is in it; nor into the city before.
  Json whole_content(const CityJob& job) const {
    Json content = content_of(job);
    if (classifier_) content["network_sha256"] = classifier_->facts().sha256;
    if (before_) content["added_to"] = before_->content();
    return content;
  }

  template <class Work>
  void step(const char* name, const Work& work) {
    const Stopwatch watch;
    work();
    result_.steps.push_back({name, watch.seconds()});
  }

  void discard_after(const Error& rejection) {
    try {
      folder_.discard();
    } catch (const Error& error) {
      throw Error(error.kind(), std::string(rejection.what()) + "; " + error.what() + "; remove " +
                                    folder_.path().string() + " to start again");
    }
  }

  /// Discards rejected points, so that the next run reads the corrected inputs.
  template <class Check>
  void discard_if_rejected(const Check& check_points) {
    try {
      check_points();
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::data) discard_after(error);
      throw;
    }
  }

  /// All that comes before the tiles.
  void prepare() {
    LayerWork reading(work_.job, work_.session, folder_.path(), before_ ? before_->layers() : 0);
    if (classifier_) reading.common.network_sha256 = classifier_->facts().sha256;
    step("points", [&] { read_points(reading); });
    result_.steps.push_back({"calibration_of_points", reading.calibrated_s});
    if (classifier_) step("segment", [&] { give_classes(*classifier_, reading, folder_); });
    result_.points_read = reading.layer.facts.points_read;
    result_.segmented = reading.segmented;
    work_.add(std::move(reading.layer));
    if (before_)
      step("fit", [&] {
        discard_if_rejected([&] { result_.fit = require_fit(*before_, work_, folder_); });
      });
    step("rays", [&] { hand_out(); });
    step("spacing", [&] { survey_spacing(work_, folder_); });
    step("origin_check", [&] {
      discard_if_rejected([&] { result_.origins = check_city_origins(work_, folder_); });
    });
    result_.city.tiles = tiles_to_model(work_);
  }

  void read_points(LayerWork& reading) {
    std::unique_ptr<CityAlignment> alignment;
    if (before_) {
      before_->hand_over_layers(folder_, work_.session.executor);
      load_layers(before_->layers(), work_);
      reading.before = before_->before();
      if (work_.job.calibration.on && work_.job.calibration.options.poses) {
        alignment = std::make_unique<CityAlignment>(before_->path(), before_->manifest(),
                                                    work_.session.executor);
        reading.before->alignment = alignment.get();
      }
    }
    if (before_ && reading.common.network_sha256 != work_.common.network_sha256)
      throw Error(ErrorKind::usage, "the points of " + work_.job.add_to.string() +
                                        " have their classes by another network (`network`)");
    sort_points(reading, folder_);
    if (alignment && alignment->report().groups > 0) result_.alignment = alignment->report();
    if (!before_) work_.common = reading.common;
  }

  /// Rays to all tiles, or where points are added to those that these reach.
  void hand_out() {
    hand_out_rays(work_.layers.back(), work_.tiles, work_, folder_);
    reached_ = work_.tiles;
    if (before_) reached_.tiles = tiles_reached(work_);
    for (std::size_t k = 0; k + 1 < work_.layers.size(); ++k)
      hand_out_rays(work_.layers[k], reached_, work_, folder_);
    write_file_in_place(work_.path(kLayersFile),
                        Json({{"layers", work_.layers.size()}}).dump() + "\n");
    folder_.record(std::string(kLayersFile));
  }

  /// Those that nothing that was added reaches.
  void take_over_tiles() {
    work_.response = load_response(work_.path(kResponseFile));
    for (const CityTile& tile : before_->manifest().tiles) {
      if (reached_.tiles.contains(tile.key)) continue;
      ++result_.tiles_kept;
      if (!folder_.has(model_file_of(tile.key))) before_->hand_over_tile(tile, folder_);
    }
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
    if (before_)
      take_over_tiles();
    else
      model_pilot(modeller, warnings);
    std::vector<CityTile> to_do;
    for (CityTile& tile : result_.city.tiles)
      if ((before_ || tile.key != pilot_tile(work_)) && !take_made(tile)) to_do.push_back(tile);
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
    if (reached_.tiles.contains(tile.key)) ++result_.tiles_resumed;
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
    result_.city.origin = work_.origin();
    result_.city.halo_m = work_.tiles.halo_m;
    if (result_.city.splats() == 0)
      throw Error(ErrorKind::data, "no splats: no surface was found in any tile");
    write_level_files(result_.city, folder_, work_.session);
    if (work_.response) work_.common.response = *work_.response;
    save_model(work_.path(kCityCommonFile), work_.common);
    folder_.record(std::string(kCityCommonFile));
    write_file_in_place(work_.path(kCityFile), city_text(result_.city));
    folder_.record(std::string(kCityFile));
    const std::vector<std::string> none_of_it = aids();
    for (const PointLayer& layer : work_.layers) fs::remove_all(work_.path(layer.file("rays")));
    if (!keeps_points()) fs::remove_all(work_.path("layers"));
    folder_.commit({{"points", result_.city.points()}, {"splats", result_.city.splats()}},
                   none_of_it);
  }

  bool keeps_points() const { return work_.job.keep_points || before_; }

  /// What was recorded and is no part of the city.
  std::vector<std::string> aids() const {
    std::vector<std::string> files;
    for (const auto& [file, hash] : folder_.recorded()) {
      const bool is_of_layer = file.starts_with("layers/");
      const bool stays = file.find("/points/") != std::string::npos && !file.ends_with(".order") &&
                         !file.ends_with(".squares");
      if (is_of_layer && !(keeps_points() && stays)) files.push_back(file);
    }
    return files;
  }

  std::optional<PointClassifier> classifier_;
  std::unique_ptr<CityToExtend> before_;  ///< null: the city is made of the job's inputs alone
  ResumableFolder folder_;
  CityWork work_;
  TileSet reached_;  ///< tiles that are not as in the city before
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
  if (result.fit) {
    json["tiles_kept"] = result.tiles_kept;
    json["fit"] = to_json(*result.fit);
    if (result.alignment) json["alignment"] = to_json(*result.alignment);
  }
  if (result.segmented) json["segmentation"] = to_json(*result.segmented);
  if (result.origins) json["origin_check"] = to_json(*result.origins);
  json["seconds"]["total"] = result.seconds;
  for (const StepTime& step : result.steps) json["seconds"][step.name] = step.seconds;
  return json;
}

}  // namespace adasplats
