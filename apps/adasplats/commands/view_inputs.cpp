// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/view_inputs.h"

#include <algorithm>
#include <cstddef>
#include <future>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/city/city_levels.h"
#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/error_points.h"
#include "adasplats/jobs/scene/view_choice.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/levels/level_file.h"
#include "adasplats/view/error_layers.h"

namespace adasplats::app {
namespace {

namespace fs = std::filesystem;

/// Memory limit for the tiles of a city around the sensor.
constexpr std::size_t kTileBytes = 1'000'000'000;

/// The inputs by kind.
struct Sorted {
  fs::path model;                ///< splats, a mesh or a world file; empty: none
  std::vector<fs::path> places;  ///< other splats and meshes
  std::vector<fs::path> clouds, errors, sequences, trajectories;
};

/// The splat model in a folder. Errors: usage (several).
fs::path model_in(const fs::path& folder) {
  std::vector<fs::path> models;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".ply" && is_splat_model(entry.path()))
      models.push_back(entry.path());
  std::sort(models.begin(), models.end());
  if (models.empty()) return {};
  if (models.size() == 1) return models.front();
  std::string names;
  for (const fs::path& model : models)
    names += (names.empty() ? "" : ", ") + model.filename().string();
  throw Error(ErrorKind::usage,
              folder.string() + ": holds several models (" + names + "); name one of them");
}

/// The one sequence next to a model, also in the street of `demo`; empty: none.
fs::path sequence_next_to(const fs::path& folder) {
  std::vector<fs::path> sequences = sequences_of_tree(folder);
  if (sequences.empty()) sequences = sequences_of_tree(folder / "street");
  if (sequences.size() > 1)
    throw Error(ErrorKind::usage, folder.string() + ": holds " + std::to_string(sequences.size()) +
                                      " sequences; name the model, and one of them as --sequence");
  return sequences.empty() ? fs::path() : sequences.front();
}

void sort_folder(const fs::path& folder, Sorted& sorted) {
  sorted.model = is_city(folder) ? folder : model_in(folder);
  if (!sorted.model.empty()) {
    const fs::path sequence = sequence_next_to(folder);
    if (!sequence.empty()) sorted.sequences.push_back(sequence);
    return;
  }
  // Without a model, a sequence is also shown as points; with a model, --cloud adds them.
  const fs::path points = resolve_cloud_input(folder);
  if (is_kitti_sequence(points)) sorted.sequences.push_back(points);
  sorted.clouds.push_back(points);
}

bool is_world_file(const fs::path& path) { return path.extension() == ".toml"; }
bool is_place(const fs::path& path) { return is_splat_model(path) || is_mesh_file(path); }

/// Sorts a layer by kind, as the input itself.
void sort_layer(const fs::path& path, Sorted& sorted) {
  require_input(path);
  if (is_world_file(path))
    throw Error(ErrorKind::usage,
                path.string() + ": a world file cannot be a layer; give it as INPUT");
  if (fs::is_directory(path) && !is_city(path))
    sorted.clouds.push_back(resolve_cloud_input(path));
  else if (is_place(path))
    sorted.places.push_back(path);
  else if (has_error_points(path))
    sorted.errors.push_back(path);
  else
    sorted.clouds.push_back(path);
}

Sorted sorted_inputs(const ViewJob& job) {
  require_input(job.input);
  Sorted sorted;
  if (fs::is_directory(job.input)) {
    sort_folder(job.input, sorted);
  } else if (is_world_file(job.input) || is_place(job.input)) {
    sorted.model = job.input;
  } else if (has_error_points(job.input)) {
    sorted.errors.push_back(job.input);
  } else {
    sorted.clouds.push_back(job.input);
  }
  for (const fs::path& layer : job.layers) sort_layer(layer, sorted);
  for (const fs::path& cloud : job.clouds) sorted.clouds.push_back(resolve_cloud_input(cloud));
  for (const fs::path& sequence : job.sequences)
    sorted.sequences.push_back(resolve_cloud_input(sequence));
  sorted.errors.insert(sorted.errors.end(), job.errors.begin(), job.errors.end());
  sorted.trajectories = job.trajectories;
  return sorted;
}

std::string name_of(const fs::path& path) {
  const fs::path normal = fs::absolute(path).lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).filename().string();
}

/// Loads the sorted inputs, layer by layer.
class Loading {
 public:
  Loading(const ViewJob& job, const Sorted& sorted, Session& session)
      : job_(job), sorted_(sorted), session_(session) {}

  LoadedView run() {
    std::vector<fs::path> inputs = sorted_.clouds;
    inputs.insert(inputs.end(), sorted_.sequences.begin(), sorted_.sequences.end());
    view_.scene.labels = label_scheme_for(job_.labels, inputs);
    for (const fs::path& errors : sorted_.errors) read_errors(errors);
    if (stays_on_disk())
      add_city();
    else if (!sorted_.model.empty())
      add_model();
    for (const fs::path& place : sorted_.places) add_place(place);
    for (const fs::path& cloud : sorted_.clouds) add_cloud(cloud);
    for (std::size_t i = 0; i < errors_.size(); ++i)
      add_errors(name_of(sorted_.errors[i]), errors_[i]);
    for (const fs::path& sequence : sorted_.sequences)
      view_.scene.sequences.push_back({name_of(sequence), open_kitti_sequence(sequence)});
    for (const fs::path& poses : sorted_.trajectories)
      view_.scene.trajectories.emplace_back(name_of(poses), load_trajectory(poses));
    finish();
    return std::move(view_);
  }

 private:
  /// Whether tiles are loaded on demand: a city with levels of detail, without errors to show.
  bool stays_on_disk() const {
    if (!is_city(sorted_.model)) return false;
    const bool errors = !sorted_.errors.empty();
    if (!errors && has_levels(sorted_.model)) return true;
    session_.progress.warn(sorted_.model.string() +
                           (errors ? ": the complete city is loaded, because errors are shown"
                                   : ": the city has no levels of detail, so all of it is loaded; "
                                     "'adasplats model' writes them"));
    return false;
  }

  void add_city() {
    const fs::path& folder = sorted_.model;
    // Both are slow for large cities.
    auto table =
        std::async(std::launch::async, [&] { return read_levels(folder / kTopLevelsFile); });
    view_.city = std::make_unique<CityScene>(folder, job_.labels, session_, kTileBytes);
    const CityManifest& city = view_.city->manifest();
    auto levels = std::make_shared<const CityLevels>(folder, city, table.get());
    view_.picker = std::make_unique<CityPicker>(folder, city);
    ViewScene& scene = view_.scene;
    scene.place = view_.city.get();
    scene.picker = view_.picker.get();
    set_place(city.origin, view_.city->middle_box());
    crs_.add(folder, load_model(folder / kCityCommonFile).crs);
    if (view_.city->labels() != nullptr) scene.labels = *view_.city->labels();
    scene.command = {"adasplats", "simulate", folder.string()};
    scene.layers.push_back(city_layer(name_of(folder), std::move(levels)));
  }

  void add_model() {
    view_.model =
        std::make_unique<ModelScene>(sorted_.model, job_.labels, session_, WorldFiles::taken);
    ViewScene& scene = view_.scene;
    scene.place = scene.model = view_.model.get();
    set_place(view_.model->origin(), view_.model->middle_box());
    crs_.add(sorted_.model, view_.model->crs());
    if (view_.model->labels() != nullptr) scene.labels = *view_.model->labels();
    scene.command = {"adasplats", "simulate", sorted_.model.string()};
    session_.progress.begin_step("levels of detail", 0);
    const std::string name = name_of(sorted_.model);
    const SplatModel* const splats = view_.model->splats();
    scene.layers.push_back(
        splats != nullptr
            ? splat_layer(name, *splats, errors_of_splats(*splats), scene.origin, session_.executor)
            : model_layer(name, view_.model->model(), scene.origin, session_.executor));
    add_world(scene, session_.executor);
    session_.progress.end_step();
  }

  void add_place(const fs::path& path) {
    const AnyModel place = load_any_model_or_city(path);
    if (view_of(place).primitive_count() == 0)
      throw Error(ErrorKind::data, path.string() + ": holds no splats or triangles");
    crs_.add(path, crs_of(place));
    if (view_.scene.layers.empty()) set_place(origin_of(place), world_box_of(place));
    session_.progress.begin_step("levels of detail", 0);
    view_.scene.layers.push_back(
        model_layer(name_of(path), place, view_.scene.origin, session_.executor));
    session_.progress.end_step();
  }

  /// Mean errors of splats, from files with the splats that beams hit; empty without such a file.
  std::vector<float> errors_of_splats(const SplatModel& model) const {
    SplatErrors errors(model.size());
    bool any = false;
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      const fs::path& file = sorted_.errors[i];
      if (has_splat_hits(errors_[i])) {
        errors.add(errors_[i], file);
        any = true;
      } else {
        session_.progress.warn(file.string() +
                               ": has no column 'splat' (written by 'evaluate resimulate "
                               "--errors'), so only its points are shown");
      }
    }
    return any ? errors.means_m() : std::vector<float>();
  }

  void add_cloud(const fs::path& path) {
    LoadOptions load = job_.load;
    load.other_columns = KeptColumns::colors;
    const PointCloud cloud =
        load_cloud(std::span(&path, 1), load, session_.executor, session_.progress).first;
    if (cloud.empty()) throw Error(ErrorKind::data, path.string() + ": no points");
    crs_.add(path, cloud.crs);
    add_points(name_of(path), cloud, {});
  }

  void read_errors(const fs::path& path) {
    require_input(path);
    errors_.push_back(read_error_points(path));
    if (errors_.back().cloud.empty()) throw Error(ErrorKind::data, path.string() + ": no points");
  }

  void add_errors(const std::string& name, const ErrorPoints& points) {
    add_points(name, points.cloud, points.errors_m);
    for (ViewLayer& part : error_part_layers(points.cloud, points.errors_m, {}, view_.scene.origin,
                                             session_.executor))
      view_.scene.layers.push_back(std::move(part));
  }

  void add_points(const std::string& name, const PointCloud& cloud,
                  std::span<const float> errors_m) {
    if (view_.scene.layers.empty())
      set_place(cloud.origin, middle_box(cloud.positions, cloud.origin));
    session_.progress.begin_step("levels of detail", 0);
    view_.scene.layers.push_back(
        point_layer(name, cloud, errors_m, view_.scene.origin, session_.executor));
    session_.progress.end_step();
  }

  void set_place(Vec3d origin, std::pair<Vec3d, Vec3d> box) {
    view_.scene.origin = origin;
    view_.scene.middle_box = box;
  }

  void finish() {
    ViewScene& scene = view_.scene;
    if (const std::string warning = crs_.warning(); !warning.empty())
      session_.progress.warn(warning);
    scene.name = name_of(job_.input);
    scene.sensor = job_.sensor;
    scene.device = device_word(session_.device.kind);
    scene.start_pose = start_pose_of(scene, job_.mount_height_m, session_.executor);
  }

  const ViewJob& job_;
  const Sorted& sorted_;
  Session& session_;
  LoadedView view_;
  std::vector<ErrorPoints> errors_;  ///< of sorted_.errors
  SharedCrs crs_;                    ///< of the model and the clouds
};

}  // namespace

LoadedView load_view(const ViewJob& job, Session& session) {
  const Sorted sorted = sorted_inputs(job);
  if (sorted.clouds.empty() && !job.cloud_option.empty()) {
    throw Error(ErrorKind::usage, job.cloud_option +
                                      " has no effect: no points are shown (--cloud shows points, "
                                      "--poses a trajectory)");
  }
  if (sorted.model.empty() && job.sensor_is_asked) {
    throw Error(ErrorKind::usage, "--sensor has no effect: the input has no model to simulate in");
  }
  return Loading(job, sorted, session).run();
}

}  // namespace adasplats::app
