// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/make_city.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "adasplats/city/passing_rays.h"
#include "adasplats/city/tile_points.h"
#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/model/label_use.h"
#include "adasplats/pipeline/output/resumable_folder.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/pipeline/session/repeated_warnings.h"
#include "adasplats/pipeline/session/settings_json.h"
#include "adasplats/recipes/city/city_inputs.h"
#include "adasplats/splats/model_engine.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPointsFile = "points/points.json";
constexpr const char* kSpacingFile = "points/spacing.json";
/// Points that wait in memory to be written to their tiles.
constexpr std::size_t kBufferedPoints = 4'000'000;
/// Points of the tiles whose cells say how dense cells are, about.
constexpr std::size_t kSurveyedPoints = 32'000'000;

Json json_of(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3f float_vector(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

/// What is known of the whole before the first tile is modelled.
struct CityFacts {
  Vec3d origin;
  CurveBox box;
  std::size_t points_read = 0;
  std::size_t rays = 0;
  float empty_reach_m = 0;
  std::map<TileKey, TileCount> tiles;
};

Json to_json(const CityFacts& facts) {
  Json json = {{"origin_m", {facts.origin.x, facts.origin.y, facts.origin.z}},
               {"low_m", json_of(facts.box.low)},
               {"high_m", json_of(facts.box.high)},
               {"points_read", facts.points_read},
               {"rays", facts.rays},
               {"empty_reach_m", facts.empty_reach_m},
               {"tiles", Json::array()}};
  for (const auto& [tile, count] : facts.tiles)
    json["tiles"].push_back({tile.x, tile.y, count.points, count.empty_beams});
  return json;
}

CityFacts facts_of(const Json& json) {
  CityFacts facts;
  const Json& origin = json.at("origin_m");
  facts.origin = {origin.at(0), origin.at(1), origin.at(2)};
  facts.box = {float_vector(json.at("low_m")), float_vector(json.at("high_m"))};
  facts.points_read = json.at("points_read");
  facts.rays = json.at("rays");
  facts.empty_reach_m = json.at("empty_reach_m");
  for (const Json& tile : json.at("tiles"))
    facts.tiles[{tile.at(0), tile.at(1)}] = {tile.at(2), tile.at(3)};
  return facts;
}

const ConsistentOptions& options_of(const CityJob& job) {
  const auto* ours = std::get_if<ConsistentOptions>(&job.build.recipe);
  if (ours == nullptr)
    throw Error(ErrorKind::usage, "tiles are modelled by the method consistent alone");
  if (job.segment.on)
    throw Error(ErrorKind::usage,
                "`segment` does not work tile by tile yet: segment the points first (adasplats "
                "segment), and model what it writes");
  return *ours;
}

/// Puts how points are read into JSON, whatever the types of its settings.
struct PutLoadSetting {
  Json& json;

  template <class T>
  void operator()(const Setting& setting, const T& value) const {
    json[setting.name] = json_of_value(value);
  }

  static Json json_of_value(const fs::path& value) { return value.string(); }
  static Json json_of_value(const Vec3d& value) { return {value.x, value.y, value.z}; }
  static Json json_of_value(const Extent& value) {
    return {json_of_value(value.low), json_of_value(value.high)};
  }
  template <class T>
  static Json json_of_value(const std::optional<T>& value) {
    return value ? json_of_value(*value) : Json();
  }
  template <class T>
  requires std::is_enum_v<T>
  static Json json_of_value(T value) { return static_cast<int>(value); }
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_same_v<T, std::string>
  static Json json_of_value(const T& value) { return value; }
};

/// What the files of a city depend on.
Json content_of(const CityJob& job) {
  Json json = {{"inputs", Json::array()}, {"input_bytes", Json::array()}};
  for (const fs::path& input : job.inputs) {
    std::error_code is_folder;
    const auto bytes = fs::file_size(input, is_folder);
    json["inputs"].push_back(input.string());
    json["input_bytes"].push_back(is_folder ? Json() : Json(bytes));
  }
  LoadOptions load = job.load;
  visit_settings(load, PutLoadSetting{json["load"]});
  json["load"]["sensor_fields"] = {load.sensor_x_field, load.sensor_y_field, load.sensor_z_field};
  put_settings(job.tiles, json);
  put_settings(options_of(job), json);
  put_settings(job.calibration, json);
  json["remove"] = name_of(job.build.remove);
  json["labels"] = job.labels;
  json["reflectances"] = job.build.reflectances;
  json["scans"] = {job.load.first_scan, job.load.scan_count, job.load.scan_stride};
  return json;
}

class CityMaker {
 public:
  CityMaker(const CityJob& job, Session& session)
      : job_(job),
        options_(options_of(job)),
        session_(session),
        folder_(job.output, job.overwrite, "model", content_of(job)),
        warnings_(session.progress, "tiles"),
        grid_{job.tiles.tile_m} {}

  CityResult run() {
    step("points", [&] { sort_points(); });
    step("rays", [&] { hand_out_rays(); });
    step("spacing", [&] { survey(); });
    step("tiles", [&] { model_tiles(); });
    warnings_.end();
    write_manifest();
    return std::move(result_);
  }

 private:
  template <class Work>
  void step(const char* name, const Work& work) {
    const Stopwatch watch;
    work();
    result_.steps.push_back({name, watch.seconds()});
  }

  fs::path path(const std::string& file) const { return folder_.path() / file; }

  // ---- points

  void sort_points() {
    fs::create_directories(path("points"));
    if (folder_.has(kPointsFile)) {
      facts_ = facts_of(Json::parse(read_file(path(kPointsFile))));
      for (const std::string& file : files_of_points())
        if (!folder_.has(file))
          throw Error(ErrorKind::data, path(file).string() + ": not as it was written; remove " +
                                           folder_.path().string() + " to start anew");
      common_ = load_model(path(kCityCommonFile));
      common_.origin = facts_.origin;
    } else {
      read_points();
    }
    for (const auto& [tile, count] : facts_.tiles)
      if (count.points > 0) tiles_.tiles.insert(tile);
    tiles_.grid = grid_;
    tiles_.halo_m = job_.tiles.halo_m;
    result_.points_read = facts_.points_read;
  }

  void read_points() {
    fs::remove_all(path("points"));  // what a killed run left half done
    fs::remove_all(path("rays"));
    TilePointsWriter writer(folder_.path(), grid_, kBufferedPoints);
    RangeCounts ranges;
    std::optional<CurveBox> box;
    ModelJob reading = job_;
    reading.load.empty_beams = options_.empty_beams && options_.balance_rounds > 0;
    const std::optional<LabelScheme> scheme = label_scheme_for(job_.labels, job_.inputs);
    const CityPoints read = read_city_points(reading, session_, [&](const PointCloud& cloud) {
      const bool is_first = !box;
      writer.add(cloud);
      if (is_first) {
        common_.crs = cloud.crs;
        check_label_use({job_.labels, job_.build.remove, job_.removal_is_asked}, cloud,
                        scheme ? &*scheme : nullptr, session_.progress);
      }
      count_rays(cloud, scheme ? &*scheme : nullptr, ranges);
      if (!cloud.empty())
        grow(box, curve_box_of(cloud.positions, session_.executor), cloud.origin - writer.origin());
    });
    facts_.tiles = writer.finish();
    if (!box) throw Error(ErrorKind::data, "no points: there is nothing to model");
    facts_.box = *box;
    facts_.origin = writer.origin();
    facts_.points_read = read.read;
    facts_.empty_reach_m = ranges.empty_reach_m();
    common_.origin = facts_.origin;
    common_.calibration = read.calibration;
    common_.method = "consistent";
    if (scheme) common_.label_scheme = scheme_reference(job_.labels, *scheme);
    save_model(path(kCityCommonFile), common_);
    write_file_in_place(path(kPointsFile), to_json(facts_).dump(1) + "\n");
    folder_.record(std::string(kCityCommonFile));
    folder_.record(files_of_points());
    folder_.record(std::string(kPointsFile));
  }

  std::vector<std::string> files_of_points() const {
    std::vector<std::string> files;
    for (const auto& [tile, count] : facts_.tiles) {
      if (count.points > 0) files.push_back(points_file_of(tile));
      if (count.empty_beams > 0) files.push_back(beams_file_of(tile));
    }
    return files;
  }

  static void grow(std::optional<CurveBox>& box, CurveBox more, Vec3d shift) {
    if (!(shift == Vec3d{})) {
      more.low = vec_cast<float>(vec_cast<double>(more.low) + shift);
      more.high = vec_cast<float>(vec_cast<double>(more.high) + shift);
    }
    if (!box) box = more;
    box->low = min(box->low, more.low);
    box->high = max(box->high, more.high);
  }

  void count_rays(const PointCloud& cloud, const LabelScheme* scheme, RangeCounts& ranges) {
    const RemovedPoints removed = points_to_remove(cloud, scheme, job_.build.remove);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!is_beam(cloud.origin_kind(i))) continue;
      const float range_m = length(cloud.positions[i] - cloud.sensor_positions[i]);
      ranges.add(range_m);
      const bool stays =
          removed.ids.empty() || cloud.classes.empty() || removed.ids[cloud.classes[i]] == 0;
      if (stays && static_cast<double>(range_m) >= options_.least_range_m) ++facts_.rays;
    }
  }

  // ---- rays

  void hand_out_rays() {
    fs::create_directories(path("rays"));
    const std::optional<LabelScheme> scheme = label_scheme_for(job_.labels, job_.inputs);
    session_.progress.begin_step("rays", facts_.tiles.size());
    std::size_t done = 0;
    for (const auto& [tile, count] : facts_.tiles) {
      const std::vector<std::string> files = {rays_file_of(tile, RaySort::passing),
                                              rays_file_of(tile, RaySort::empty)};
      if (!folder_.has(files)) {
        write_rays_of(tile, count, scheme ? &*scheme : nullptr);
        folder_.record(files);
      }
      session_.progress.advance(++done);
    }
    session_.progress.end_step();
    std::set<TileKey> all;
    for (const auto& [tile, count] : facts_.tiles) all.insert(tile);
    passing_.emplace(folder_.path(), all, RaySort::passing);
    empty_.emplace(folder_.path(), all, RaySort::empty);
  }

  void write_rays_of(TileKey tile, const TileCount& count, const LabelScheme* scheme) {
    RaysByTile passing, empty;
    if (count.points > 0) {
      PointCloud cloud;
      cloud.origin = facts_.origin;
      read_tile_points(folder_.path(), tile, cloud);
      const RemovedPoints removed = points_to_remove(cloud, scheme, job_.build.remove);
      if (!removed.ids.empty() && !cloud.classes.empty()) {
        std::vector<std::uint32_t> stay;
        for (std::uint32_t i = 0; i < cloud.size(); ++i)
          if (removed.ids[cloud.classes[i]] == 0) stay.push_back(i);
        cloud = gather(cloud, stay);
      }
      passing = passing_rays(cloud, tiles_, options_.least_range_m, session_.executor);
    }
    if (count.empty_beams > 0) {
      PointCloud ends = ends_of(read_tile_beams(folder_.path(), tile), facts_.empty_reach_m);
      ends.origin = facts_.origin;
      empty = crossing_rays(ends, tiles_, session_.executor);
    }
    write_rays(path(rays_file_of(tile, RaySort::passing)), passing);
    write_rays(path(rays_file_of(tile, RaySort::empty)), empty);
  }

  // ---- tiles

  /// A tile's points with those around it.
  PointCloud points_around(TileKey tile) const {
    const GroundBox reach = tiles_.reach_of(tile);
    PointCloud cloud;
    cloud.origin = facts_.origin;
    cloud.crs = common_.crs;
    const TileKey low = grid_.tile_of({reach.low_x, reach.low_y, 0});
    const TileKey high = grid_.tile_of({reach.high_x, reach.high_y, 0});
    for (TileKey near = low; near.x <= high.x; ++near.x)
      for (near.y = low.y; near.y <= high.y; ++near.y)
        if (tiles_.tiles.contains(near))
          read_tile_points(folder_.path(), near, cloud, [&](Vec3f p) {
            return reach.contains(facts_.origin + vec_cast<double>(p));
          });
    cloud.crs = common_.crs;
    return cloud;
  }

  WholePlace whole_of(TileKey tile) const {
    WholePlace whole;
    whole.box = facts_.box;
    whole.typical = typical_;
    whole.rays = facts_.rays;
    whole.passing = passing_->read(tile);
    whole.empty = empty_->read(tile);
    whole.response = response_;
    return whole;
  }

  /// Tiles all over the city whose cells say how dense cells are: all of them, or every n-th.
  std::vector<TileKey> surveyed() const {
    std::size_t points = 0;
    for (const auto& [tile, count] : facts_.tiles) points += count.points;
    const std::size_t every = std::max<std::size_t>(1, points / kSurveyedPoints);
    std::vector<TileKey> chosen;
    std::size_t k = 0;
    for (const TileKey tile : tiles_.tiles)
      if (k++ % every == 0) chosen.push_back(tile);
    return chosen;
  }

  void survey() {
    if (folder_.has(kSpacingFile)) {
      const Json json = Json::parse(read_file(path(kSpacingFile)));
      typical_ = {json.at("with_beam"), json.at("without")};
      return;
    }
    std::vector<float> with_beam, without;
    const std::vector<TileKey> chosen = surveyed();
    session_.progress.begin_step("spacing of cells", chosen.size());
    const std::unique_ptr<ModelEngine> engine = make_cpu_model_engine(session_.executor);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      add_spacings(chosen[k], *engine, with_beam, without);
      session_.progress.advance(k + 1);
    }
    session_.progress.end_step();
    typical_ = typical_spacing(std::move(with_beam), std::move(without));
    const Json json = {{"with_beam", typical_.with_beam}, {"without", typical_.without}};
    write_file_in_place(path(kSpacingFile), json.dump() + "\n");
    folder_.record(std::string(kSpacingFile));
  }

  void add_spacings(TileKey tile, const ModelEngine& engine, std::vector<float>& with_beam,
                    std::vector<float>& without) const {
    const std::optional<LabelScheme> scheme = label_scheme_for(job_.labels, job_.inputs);
    PointCloud cloud = points_around(tile);
    ClassTables tables;
    tables.removed = points_to_remove(cloud, scheme ? &*scheme : nullptr, job_.build.remove).ids;
    WholePlace whole;
    whole.box = facts_.box;
    const std::unique_ptr<ConsistentSteps> steps = engine.consistent_steps();
    if (steps->load(std::move(cloud), tables, &whole) == 0) return;
    steps->fuse(options_);
    const GroundBox own = grid_.box_of(tile);
    for (const CellSpacing& cell : steps->spacings(options_)) {
      if (!(cell.spacing > 0) || !own.contains(facts_.origin + vec_cast<double>(cell.place)))
        continue;
      (cell.with_beam ? with_beam : without).push_back(cell.spacing);
    }
  }

  void model_tiles() {
    fs::create_directories(path("tiles"));
    for (const TileKey tile : tiles_.tiles) {
      CityTile made;
      made.key = tile;
      made.points = facts_.tiles.at(tile).points;
      result_.city.tiles.push_back(made);
    }
    session_.progress.begin_step("tiles", tiles_.tiles.size());
    std::size_t done = 0;
    const std::size_t pilot = pilot_tile();
    model_tile(result_.city.tiles[pilot], true);
    session_.progress.advance(++done);
    for (std::size_t k = 0; k < result_.city.tiles.size(); ++k) {
      if (k == pilot) continue;
      model_tile(result_.city.tiles[k], false);
      session_.progress.advance(++done);
    }
    session_.progress.end_step();
  }

  /// The one with the most points: its rays say what the sensor's response is.
  std::size_t pilot_tile() const {
    const auto most = std::ranges::max_element(result_.city.tiles, {}, &CityTile::points);
    return static_cast<std::size_t>(most - result_.city.tiles.begin());
  }

  void model_tile(CityTile& tile, bool is_pilot) {
    const std::string file = model_file_of(tile.key);
    SplatModel model;
    if (folder_.has(file)) {
      model = load_model(path(file));
      ++result_.tiles_resumed;
    } else {
      model = modelled(tile.key, is_pilot);
      save_model(path(file), model);
      folder_.record(file);
    }
    if (is_pilot && !model.response.empty()) response_ = model.response;
    tile.splats = model.size();
    tile.sha256 = folder_.recorded().at(file);
    const auto [low, high] = bounds(model);
    tile.low = model.origin + vec_cast<double>(low);
    tile.high = model.origin + vec_cast<double>(high);
  }

  SplatModel modelled(TileKey tile, bool is_pilot) {
    const WholePlace whole = whole_of(tile);
    ModelOptions options = job_;
    options.calibration.on = false;
    options.labels = common_.label_scheme;  // also where the inputs alone said it
    options.build.whole = &whole;
    options.build.reflectances = options.build.reflectances && (is_pilot || response_.has_value());
    Session quiet = {session_.executor, warnings_, session_.seed, session_.device};
    SplatModel model = make_model(points_around(tile), options, quiet).first;
    model.label_scheme = common_.label_scheme;
    keep_own(tile, model);
    return model;
  }

  /// Takes out splats that stand in other tiles.
  void keep_own(TileKey tile, SplatModel& model) const {
    std::size_t kept = 0;
    const auto move_down = [&](auto& values, std::size_t i) {
      if (!values.empty()) values[kept] = values[i];
    };
    for (std::size_t i = 0; i < model.size(); ++i) {
      const Vec3d place = model.origin + vec_cast<double>(model.disks[i].center);
      if (owner_of(place, grid_, result_.city.tiles) != tile) continue;
      move_down(model.classes, i);
      move_down(model.groups, i);
      move_down(model.intensities, i);
      model.disks[kept++] = model.disks[i];
    }
    const auto cut = [&](auto& values) {
      if (!values.empty()) values.resize(kept);
    };
    cut(model.classes);
    cut(model.groups);
    cut(model.intensities);
    model.disks.resize(kept);
  }

  void write_manifest() {
    result_.city.grid = grid_;
    result_.city.origin = facts_.origin;
    result_.city.halo_m = job_.tiles.halo_m;
    if (result_.city.splats() == 0)
      throw Error(ErrorKind::data, "no splats: no surface was found in any tile");
    if (response_) {
      common_.response = *response_;
      save_model(path(kCityCommonFile), common_);
      folder_.record(std::string(kCityCommonFile));
    }
    write_file_in_place(path(kCityFile), city_text(result_.city));
    folder_.record(std::string(kCityFile));
    fs::remove_all(path("rays"));
    fs::remove_all(path("points"));
    folder_.commit({{"points", result_.city.points()}, {"splats", result_.city.splats()}}, aids());
  }

  /// What was recorded and is no part of the city.
  std::vector<std::string> aids() const {
    std::vector<std::string> files;
    for (const auto& [file, hash] : folder_.recorded())
      if (file.starts_with("rays/") || file.starts_with("points/")) files.push_back(file);
    return files;
  }

  const CityJob& job_;
  const ConsistentOptions& options_;
  Session& session_;
  ResumableFolder folder_;
  RepeatedWarnings warnings_;
  TileGrid grid_;
  TileSet tiles_;
  CityFacts facts_;
  SplatModel common_;
  TypicalSpacing typical_;
  std::optional<RayFiles> passing_, empty_;
  std::optional<IntensityResponse> response_;
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

Json to_json(const CityResult& result) {
  Json json = {{"points_read", result.points_read},     {"points", result.city.points()},
               {"primitives", result.city.splats()},    {"tiles", result.city.tiles.size()},
               {"tiles_resumed", result.tiles_resumed}, {"tile_m", result.city.grid.side_m},
               {"halo_m", result.city.halo_m}};
  json["seconds"]["total"] = result.seconds;
  for (const StepTime& step : result.steps) json["seconds"][step.name] = step.seconds;
  return json;
}

}  // namespace adasplats
