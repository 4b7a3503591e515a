// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/simkitti32.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/dataset/parallel_scan_writer.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/evaluate/fit_sensor.h"
#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/scans/scan_folder.h"
#include "adasplats/jobs/scans/scan_manifest.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/scene/scene_files.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/settings_json.h"
#include "adasplats/simulate/world/moving_points.h"
#include "adasplats/simulate/world/world.h"
#include "adasplats/simulate/world/world_file.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr const char* kSimKitti32 = "simkitti32";
const std::string kModelFile = "model.ply";

bool is_world(const SimKitti32Job& job) { return job.model.extension() == ".toml"; }

/// The part of a sequence that is simulated: scan i of the output is scan numbers[i] of the input.
struct Source {
  KittiSequence sequence;
  std::vector<std::size_t> numbers;
  std::string name;  ///< of the output's sequence folder
  Trajectory poses;  ///< of the sensor that measured scan i, where the static model is right
  HeldOutPoses poses_are = HeldOutPoses::as_given;
};

/// "08" for ".../sequences/08"; folders of other names become 00.
std::string sequence_name(const fs::path& folder) {
  const fs::path normal = fs::absolute(folder).lexically_normal();
  const std::string name = (normal.has_filename() ? normal : normal.parent_path()).filename();
  const bool is_number =
      name.size() == 2 && name.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? name : "00";
}

Source open_source(const SimKitti32Job& job, const Executor& executor) {
  require_input(job.sequence);
  const fs::path folder = resolve_cloud_input(job.sequence);
  Source source;
  source.sequence = open_kitti_sequence(folder);
  source.name = sequence_name(folder);
  verify_poses(source.sequence, executor);
  if (source.sequence.labels.empty())
    throw Error(ErrorKind::data, folder.string() +
                                     ": has no labels/, which identify moving objects and the "
                                     "classes of simulated points");
  source.numbers = chosen_scans(job.scans, source.sequence.scans.size(), folder);
  for (const std::size_t number : source.numbers)
    source.poses.push_back(source.sequence.trajectory[number]);
  return source;
}

/// The poses of the simulated sensor.
std::vector<ScanMotion> motions_of(const SimKitti32Job& job, const Source& source) {
  return still_scans(shifted(source.poses, job.offset_m));
}

/// Corrects the poses of the scans by the calibration of a given model.
void apply_calibration(const ModelScene& given, Source& source) {
  const SplatModel* const model = given.splats();
  if (model == nullptr || !model->calibration.moves_scans()) return;
  if (!apply(model->calibration, source.poses))
    throw Error(ErrorKind::data, not_of_calibrated_drive(source.sequence.folder) +
                                     ": the position of its scans in the model is undetermined");
  source.poses_are = HeldOutPoses::interpolated;
}

/// Throws data unless a ray of the first scans hits the static model. Moving objects, which would
/// be hit in any case, are not in it yet.
void require_in_view(const ModelScene& scene, std::span<const ScanMotion> scans,
                     const LidarModel& sensor) {
  constexpr std::size_t kScans = 10;
  const std::span<const ScanMotion> first = scans.first(std::min(kScans, scans.size()));
  const std::vector<Firing> firings = firings_of(sensor);
  for (const ScanMotion& scan : first) {
    bool is_hit = false;
    scene.scan_caster().cast(
        sensor, firings, std::span(&scan, 1), 1, [&](std::size_t, std::span<const Hit> hits) {
          is_hit = std::ranges::any_of(hits, [](const Hit& hit) { return hit.valid(); });
        });
    if (is_hit) return;
  }
  throw_no_returns(firings.size() * first.size(), scene, first, sensor,
                   "are sequence and model in the same frame? `offset` shifts the sensor");
}

/// Share of the static points of some scans whose ray hits the model within half a metre of the
/// measured range.
double agreement_of(const ModelScene& scene, const Source& source, const LabelScheme& labels,
                    const Executor& executor) {
  constexpr std::size_t kScans = 5;  // spread over all
  constexpr float kNear_m = 0.5F;
  const std::size_t step = (source.numbers.size() + kScans - 1) / kScans;
  std::size_t returns = 0, near = 0;
  for (std::size_t k = 0; k < source.numbers.size(); k += step) {
    const KittiScan scan = read_kitti_scan(source.sequence, source.numbers[k]);
    const ScanPose pose = scan_pose(source.poses[k].world_from_sensor, scene.origin());
    std::vector<Ray> rays;
    std::vector<float> ranges_m;
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
      const SemanticClass* const label = labels.find(scan.classes[i]);
      const float range_m = length(scan.positions[i]);
      if ((label != nullptr && label->mobility == Mobility::moving) || !(range_m > 0)) continue;
      rays.push_back({pose.origin, 0, normalized(turned(pose, scan.positions[i]))});
      ranges_m.push_back(range_m);
    }
    std::vector<Hit> hits(rays.size());
    scene.tracer().nearest(rays, hits, executor);
    returns += hits.size();
    for (std::size_t i = 0; i < hits.size(); ++i)
      near += hits[i].valid() && std::fabs(hits[i].t - ranges_m[i]) < kNear_m ? 1 : 0;
  }
  return returns == 0 ? 0 : static_cast<double>(near) / static_cast<double>(returns);
}

/// The user's static model; `source` gets its poses. Null: none was given.
std::unique_ptr<ModelScene> open_given(const SimKitti32Job& job, const LidarModel& sensor,
                                       Source& source, Session& session) {
  if (job.model.empty()) return nullptr;
  session.progress.begin_step("load " + job.model.filename().string(), 0);
  const std::optional<WorldFile> world =
      is_world(job) ? std::optional(read_world_file(job.model)) : std::nullopt;
  if (world && world->model.empty())
    throw Error(ErrorKind::config, job.model.string() + ": has no model");
  AnyModel model = load_any_model_or_city(world ? world->model : job.model);
  // Averages of hits are those of opaque splats.
  if (auto* splats = std::get_if<SplatModel>(&model); splats != nullptr && job.depth > 1)
    *splats = opaque(std::move(*splats));
  auto given =
      std::make_unique<ModelScene>(std::move(model), load_label_scheme(job.labels), session);
  if (given->attributes().classes.empty())
    throw Error(ErrorKind::data, job.model.string() +
                                     ": has no classes for the simulated points (make the model "
                                     "of points with labels)");
  apply_calibration(*given, source);
  require_in_view(*given, motions_of(job, source), sensor);
  const LabelScheme labels = load_label_scheme(job.labels);
  require_one_place(agreement_of(*given, source, labels, session.executor),
                    source.sequence.folder.string());
  if (world) given->add_objects([&](World& objects) { add_objects(objects, *world, labels); });
  return given;
}

/// SHA-256 of all files that determine the output, by their names in the sequence folder.
Json input_hashes(const Source& source, Session& session) {
  const KittiSequence& sequence = source.sequence;
  std::vector<fs::path> files;
  for (const char* name : {"calib.txt", "poses.txt", "times.txt"})
    if (fs::exists(sequence.folder / name)) files.push_back(sequence.folder / name);
  for (const std::size_t number : source.numbers) {
    files.push_back(sequence.scans[number]);
    files.push_back(sequence.labels[number]);
  }
  session.progress.begin_step("hash the inputs", kPassUnits);
  std::vector<std::string> digests(files.size());
  {
    const ProgressPass pass(session.executor, files.size());
    session.executor.for_chunks(files.size(), 1, [&](std::size_t i, std::size_t) {
      digests[i] = sha256_of_file(files[i]);
    });
  }
  session.progress.end_step();
  Json hashes = Json::object();
  for (std::size_t i = 0; i < files.size(); ++i)
    hashes[files[i].lexically_relative(sequence.folder).generic_string()] = digests[i];
  return hashes;
}

/// The splats are opaque where hits are averaged.
MethodOptions recipe_of(const SimKitti32Job& job) {
  MethodChoice choice{.method = job.method};
  choice.consistent.refine = job.depth == 1;
  return choice.recipe();
}

/// The method with its settings, or the hash of the given model.
Json model_content(const SimKitti32Job& job, const Source& source) {
  if (!job.model.empty()) {
    Json json = {{"sha256", sha256_of_file(job.model)},
                 {"poses", word_of(source.poses_are, kHeldOutPoses)},
                 {"opaque", job.depth > 1}};
    if (is_world(job)) {
      const fs::path folder = fs::absolute(job.model).parent_path();
      for (const fs::path& file : files_of_scene(fs::absolute(job.model)))
        json["files"][file.lexically_relative(folder).generic_string()] = sha256_of_file(file);
    }
    return json;
  }
  const SplatMethod method = job.method;
  Json json = {{"method", word_of(method, kSplatMethods)}};
  const MethodOptions recipe = recipe_of(job);
  std::visit([&json](const auto& settings) { put_settings(settings, json); }, recipe);
  return json;
}

/// Inputs and settings of the data set: the beginning of its manifest.
Json content_of(const SimKitti32Job& job, const Source& source, const LidarModel& sensor,
                Session& session) {
  Json content = {{"sequence", source.name},
                  {"scans", source.numbers},
                  {"labels", load_label_scheme(job.labels).name()},
                  {"sensor", sensor_content(sensor)},
                  {"seed", session.seed}};
  put_settings(job, content);
  content["point_order"] = word_of(PointOrder::kitti, kPointOrders);
  for (const char* key : {"method", "model_every", "keep_model"})
    if (!job.model.empty()) content.erase(key);
  content["model"] = model_content(job, source);
  if (is_ray_drop_file(job.ray_drop))
    content["ray_drop"] = sha256_of_file(job.ray_drop);
  else if (!job.ray_drop.empty())
    content["ray_drop"] = job.ray_drop.string();
  content["inputs"] = input_hashes(source, session);
  return content;
}

/// Simulates the missing scans.
class Simulation {
 public:
  /// `given`: the static model, or null to make one.
  Simulation(const SimKitti32Job& job, const Source& source, const ScanSettings& settings,
             std::unique_ptr<ModelScene> given, ResumableFolder& folder, Session& session)
      : job_(job),
        source_(source),
        scene_(std::move(given)),
        labels_(load_label_scheme(job.labels)),
        settings_(settings),
        folder_(folder),
        session_(session),
        sequence_(fs::path("sequences") / source.name),
        scans_(motions_of(job, source)),
        writer_(prepared_writer()) {}

  void run(SimKitti32Result& result) {
    const std::vector<std::size_t> missing = keep_written_scans();
    result.scans = source_.numbers.size();
    result.scans_resumed = result.scans - missing.size();
    if (!missing.empty()) {
      if (!scene_) make_model(result);
      simulate(missing, result);
    } else {
      writer_->finish();
    }
  }

 private:
  /// A run that was interrupted while it finished may have written the poses.
  std::unique_ptr<ScanWriter> prepared_writer() const {
    fs::remove(folder_.path() / sequence_ / "poses.txt");
    return make_sequence_writer(folder_.path(), source_.name);
  }

  /// Points and labels of a written scan; labels of an empty scan are written with the poses.
  std::vector<std::string> files_of(std::size_t scan) const {
    const std::string name = scan_name(scan);
    const std::string points = (sequence_ / "velodyne" / (name + ".bin")).string();
    std::error_code missing;
    if (fs::file_size(folder_.path() / points, missing) == 0) return {points};
    return {points, (sequence_ / "labels" / (name + ".label")).string()};
  }

  /// Keeps the scans of an interrupted run and returns the others, which may be in between.
  std::vector<std::size_t> keep_written_scans() {
    const std::size_t count = source_.numbers.size();
    session_.progress.begin_step("check written scans", kPassUnits);
    std::vector<std::uint8_t> is_written(count);
    {
      const ProgressPass pass(session_.executor, count);
      session_.executor.for_chunks(count, 1, [&](std::size_t i, std::size_t) {
        is_written[i] = folder_.has(files_of(i)) ? 1 : 0;
      });
    }
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < count; ++i) {
      if (is_written[i] != 0) {
        writer_->keep(i, scans_[i].reference);
      } else {
        missing.push_back(i);
      }
    }
    session_.progress.end_step();
    return missing;
  }

  /// Loads the model from its file, also in the run that made it, so that both are the same.
  void make_model(SimKitti32Result& result) {
    if (!folder_.has(kModelFile)) write_model(result);
    scene_ = std::make_unique<ModelScene>(folder_.path() / kModelFile, job_.labels, session_);
  }

  void write_model(SimKitti32Result& result) {
    ModelJob model;
    model.inputs = {source_.sequence.folder};
    model.labels = job_.labels;
    model.load.first_scan = source_.numbers.front();
    model.load.scan_count = (source_.numbers.size() + job_.model_every - 1) / job_.model_every;
    model.load.scan_stride = job_.scans.stride * job_.model_every;
    model.load.driven_path_m = 0;  // labels identify what moved
    model.build.recipe = recipe_of(job_);
    model.build.remove = DynamicRemoval::moving;
    model.calibration.on = false;  // scans are simulated at the sequence's own poses
    result.model = run_model(model, folder_.path() / kModelFile, session_);
    folder_.record(kModelFile);
  }

  void simulate(std::span<const std::size_t> missing, SimKitti32Result& result) {
    const Stopwatch watch;
    if (job_.moving && !is_world(job_)) {
      const IntensityResponse* const response = scene_->attributes().response;
      scene_->add_objects(
          [&](World& world) { result.moving_splats = add_moving(missing, response, world); });
    }
    ScanSettings settings = settings_;
    settings.fields = fields_of(ScanFormat::semantickitti);
    ScanSimulator simulator(*scene_, std::move(settings), session_.executor);
    ParallelWriteOptions parallel;
    parallel.written = [this](std::size_t, std::size_t, std::span<const FileDigest> files) {
      folder_.record(files);
    };
    ScanRecorder recorder(*writer_, parallel, 0, session_);
    session_.progress.begin_step("simulate", missing.size());
    // Consecutive scans are cast together; unless files were damaged, the end of the sequence is
    // missing.
    for (std::size_t begin = 0; begin < missing.size();) {
      std::size_t end = begin + 1;
      while (end < missing.size() && follows(missing[end - 1], missing[end])) ++end;
      recorder.record(simulator, scans_, missing[begin], end - begin,
                      source_.numbers[missing[begin]]);
      begin = end;
    }
    recorder.finish();
    session_.progress.end_step();
    result.seconds_simulated = watch.seconds();
  }

  /// Scans are numbered as in the sequence; noise, patterns and moving objects depend on it.
  bool follows(std::size_t scan, std::size_t next) const {
    return next == scan + 1 && source_.numbers[next] == source_.numbers[scan] + 1;
  }

  std::size_t add_moving(std::span<const std::size_t> scans, const IntensityResponse* response,
                         World& world) const {
    session_.progress.begin_step("splats of moving objects", kPassUnits);
    std::vector<std::size_t> splats(scans.size());
    std::size_t first = 0;
    {
      const ProgressPass pass(session_.executor, scans.size());
      first = world.add_geometries(
          scans.size(),
          [&](std::size_t k) {
            MovingSplats moving = moving_in(source_.numbers[scans[k]]);
            splats[k] = moving.splats.size();
            if (response != nullptr) to_reflectances(moving.splats, *response);
            return NewGeometry{std::move(moving.splats), std::move(moving.instances)};
          },
          session_.executor);
    }
    for (std::size_t k = 0; k < scans.size(); ++k) {
      if (splats[k] == 0) continue;
      const std::size_t number = source_.numbers[scans[k]];
      WorldObject object;
      object.geometry = first + k;
      object.trajectory = {source_.poses[scans[k]]};
      object.only_scan = number;
      world.add_object(std::move(object));
    }
    session_.progress.end_step();
    return std::accumulate(splats.begin(), splats.end(), std::size_t{0});
  }

  MovingSplats moving_in(std::size_t number) const {
    MovingSplatOptions options;
    options.radius_m = job_.moving_radius_m;
    return moving_splats(read_kitti_scan(source_.sequence, number), labels_, options,
                         session_.executor);
  }

  /// The scene has reflectances; these are intensities measured by a sensor at the origin.
  static void to_reflectances(SplatModel& splats, const IntensityResponse& response) {
    for (std::size_t i = 0; i < splats.intensities.size(); ++i) {
      const Disk& disk = splats.disks[i];
      const float range_m = length(disk.center);
      const float cosine = std::fabs(dot(disk.normal, disk.center)) / range_m;
      splats.intensities[i] /= response.gain(range_m, cosine);
    }
  }

  const SimKitti32Job& job_;
  const Source& source_;
  std::unique_ptr<ModelScene> scene_;  ///< the static model; null until it is made
  LabelScheme labels_;
  const ScanSettings& settings_;
  ResumableFolder& folder_;
  Session& session_;
  fs::path sequence_;  ///< in the folder
  std::vector<ScanMotion> scans_;
  std::unique_ptr<ScanWriter> writer_;
};

constexpr std::size_t kClasses = 1 << 16;

struct Counts {
  std::map<std::uint16_t, ClassCount> by_class;

  void operator+=(const Counts& other) {
    for (const auto& [id, count] : other.by_class) {
      by_class[id].original += count.original;
      by_class[id].simulated += count.simulated;
    }
  }
};

std::vector<std::size_t> labels_in(std::span<const std::filesystem::path> files) {
  std::vector<std::size_t> of_class(kClasses);
  for (const std::filesystem::path& file : files)
    for (const std::uint32_t label : read_kitti_labels(file)) ++of_class[label & 0xffff];
  return of_class;
}

/// Counts the labels of files, by class; file i of both is of one scan. Errors: those of
/// read_kitti_labels().
std::map<std::uint16_t, ClassCount> count_labels(std::span<const std::filesystem::path> originals,
                                                 std::span<const std::filesystem::path> simulated,
                                                 const Executor& executor) {
  constexpr std::size_t kScansAtOnce = 8;
  const ProgressPass pass(executor, originals.size());
  const auto of_scans = [&](std::size_t begin, std::size_t end) {
    const std::vector<std::size_t> in_originals = labels_in(originals.subspan(begin, end - begin));
    const std::vector<std::size_t> in_simulated = labels_in(simulated.subspan(begin, end - begin));
    Counts counts;
    for (std::size_t id = 0; id < kClasses; ++id) {
      if (in_originals[id] == 0 && in_simulated[id] == 0) continue;
      counts.by_class[static_cast<std::uint16_t>(id)] = {in_originals[id], in_simulated[id]};
    }
    return counts;
  };
  return executor.sum_chunks(originals.size(), kScansAtOnce, Counts{}, of_scans).by_class;
}

void count_points(const fs::path& written, const Source& source, Session& session,
                  SimKitti32Result& result) {
  std::vector<fs::path> originals;
  for (const std::size_t number : source.numbers)
    originals.push_back(source.sequence.labels[number]);
  session.progress.begin_step("count", kPassUnits);
  result.by_class = count_labels(originals, open_kitti_sequence(written).labels, session.executor);
  session.progress.end_step();
  for (const auto& [id, of_class] : result.by_class) result.points += of_class.simulated;
}

Json classes_json(const SimKitti32Result& result, const LabelScheme& labels) {
  Json json = Json::object();
  for (const auto& [id, count] : result.by_class) {
    const SemanticClass* const label = labels.find(id);
    json[std::to_string(id)] = {{"name", label != nullptr ? label->name : ""},
                                {"original", count.original},
                                {"simulated", count.simulated}};
  }
  return json;
}

/// Checks the job before long work and before a folder is begun.
ScanSettings settings_of(const SimKitti32Job& job, std::uint64_t seed) {
  check_settings(job);
  ScanSettings settings;
  settings.sensor = load_lidar_model(job.sensor);
  settings.sensor.range_noise_m = job.noise_m;
  settings.beam.depth = job.depth;
  settings.weather = job.weather;
  settings.ray_drop = load_ray_drop_choice(job.ray_drop, settings.sensor);
  settings.seed = seed;
  check(settings);
  return settings;
}

}  // namespace

std::vector<UnusedSetting> unused_settings(const SimKitti32Job& job) {
  std::vector<UnusedSetting> unused;
  const auto add = [&](bool has_no_effect, const std::set<std::string_view>& names,
                       const char* why) {
    if (!has_no_effect) return;
    for (UnusedSetting& each : all_unused(job, why))
      if (names.contains(each.setting.name)) unused.push_back(std::move(each));
  };
  add(!job.moving, {"moving_radius"}, "without moving objects");
  add(is_world(job), {"moving", "moving_radius"}, "with the objects of a world file");
  add(!job.model.empty(), {"method", "model_every", "keep_model"}, "with a given model");
  return unused;
}

SimKitti32Result run_simkitti32(const SimKitti32Job& job, Session& session) {
  const Stopwatch total;
  const ScanSettings settings = settings_of(job, session.seed);
  if (!job.model.empty()) {
    require_input(job.model);
    require_folder_apart(job.output, std::span(&job.model, 1));
  }
  Source source = open_source(job, session.executor);
  checked_output_folder(job.output, job.overwrite, kSimKitti32);  // before long work
  std::unique_ptr<ModelScene> given = open_given(job, settings.sensor, source, session);
  ResumableFolder folder(job.output, job.overwrite, kSimKitti32,
                         content_of(job, source, settings.sensor, session));
  SimKitti32Result result;
  Simulation(job, source, settings, std::move(given), folder, session).run(result);
  result.rays = result.scans * settings.sensor.rays_per_scan();
  count_points(folder.path() / "sequences" / source.name, source, session, result);
  session.progress.begin_step("finish", 0);
  const std::vector<std::string> unneeded =
      job.keep_model || !fs::exists(folder.path() / kModelFile)
          ? std::vector<std::string>{}
          : std::vector<std::string>{kModelFile};
  folder.commit(
      {{"points", result.points}, {"classes", classes_json(result, load_label_scheme(job.labels))}},
      unneeded);
  session.progress.end_step();
  result.seconds = total.seconds();
  return result;
}

Json to_json(const SimKitti32Result& result, const LabelScheme& labels) {
  Json json = {{"scans", result.scans},
               {"scans_resumed", result.scans_resumed},
               {"rays", result.rays},
               {"points", result.points},
               {"moving_splats", result.moving_splats},
               {"classes", classes_json(result, labels)}};
  if (result.model) json["model"] = to_json(*result.model);
  json["seconds"] = {{"total", result.seconds}, {"simulate", result.seconds_simulated}};
  return json;
}

}  // namespace adasplats
