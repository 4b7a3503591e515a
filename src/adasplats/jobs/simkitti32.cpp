// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/simkitti32.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

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
#include "adasplats/jobs/no_returns.h"
#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/scan_manifest.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/settings_json.h"
#include "adasplats/simulate/world/moving_points.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr const char* kSimKitti32 = "simkitti32";
const std::string kModelFile = "model.ply";

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
  require_poses_that_fit(source.sequence, executor);
  if (source.sequence.labels.empty())
    throw Error(ErrorKind::data, folder.string() +
                                     ": has no labels/, which say what moves and what simulated "
                                     "points are");
  source.numbers = chosen_scans(job.scans, source.sequence.scans.size(), folder);
  for (const std::size_t number : source.numbers)
    source.poses.push_back(source.sequence.trajectory[number]);
  return source;
}

/// Where the simulated sensor stands.
std::vector<ScanMotion> motions_of(const SimKitti32Job& job, const Source& source) {
  return still_scans(shifted(source.poses, job.offset_m));
}

/// Brings the scans to where a given model has them.
void take_calibration(const ModelScene& given, Source& source) {
  const SplatModel* const model = given.splats();
  if (model == nullptr || !model->calibration.moves_scans()) return;
  if (!apply(model->calibration, source.poses))
    throw Error(ErrorKind::data, not_of_calibrated_drive(source.sequence.folder) +
                                     ": nothing tells where in the model they are");
  source.poses_are = HeldOutPoses::interpolated;
}

/// Throws data unless a ray of the first scans meets the place. What moves is not in it yet, which
/// would be met wherever the place is.
void require_in_view(const ModelScene& place, std::span<const ScanMotion> scans,
                     const LidarModel& sensor) {
  constexpr std::size_t kScans = 10;
  const std::span<const ScanMotion> first = scans.first(std::min(kScans, scans.size()));
  const std::vector<Firing> firings = firings_of(sensor);
  for (const ScanMotion& scan : first) {
    bool is_met = false;
    place.scan_caster().cast(
        sensor, firings, std::span(&scan, 1), 1, [&](std::size_t, std::span<const Hit> hits) {
          is_met = std::ranges::any_of(hits, [](const Hit& hit) { return hit.valid(); });
        });
    if (is_met) return;
  }
  throw_no_returns(firings.size() * first.size(), place, first, sensor,
                   "are sequence and model in one frame? offset shifts the sensor");
}

/// Share of what some scans measured, without what moves, that the place has within half a metre.
double agreement_of(const ModelScene& place, const Source& source, const LabelScheme& labels,
                    const Executor& executor) {
  constexpr std::size_t kScans = 5;  // spread over all
  constexpr float kNear_m = 0.5F;
  const std::size_t step = (source.numbers.size() + kScans - 1) / kScans;
  std::size_t returns = 0, near = 0;
  for (std::size_t k = 0; k < source.numbers.size(); k += step) {
    const KittiScan scan = read_kitti_scan(source.sequence, source.numbers[k]);
    const ScanPose pose = scan_pose(source.poses[k].world_from_sensor, place.origin());
    std::vector<Ray> rays;
    std::vector<float> ranges_m;
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
      const SemanticClass* const known = labels.find(scan.classes[i]);
      const float range_m = length(scan.positions[i]);
      if ((known != nullptr && known->mobility == Mobility::moving) || !(range_m > 0)) continue;
      rays.push_back({pose.origin, 0, normalized(turned(pose, scan.positions[i]))});
      ranges_m.push_back(range_m);
    }
    std::vector<Hit> hits(rays.size());
    place.tracer().nearest(rays, hits, executor);
    returns += hits.size();
    for (std::size_t i = 0; i < hits.size(); ++i)
      near += hits[i].valid() && std::fabs(hits[i].t - ranges_m[i]) < kNear_m ? 1 : 0;
  }
  return returns == 0 ? 0 : static_cast<double>(near) / static_cast<double>(returns);
}

/// The model that a user gives, with the poses of `source` as it has them. Null: none is given.
std::unique_ptr<ModelScene> open_given(const SimKitti32Job& job, const LidarModel& sensor,
                                       Source& source, Session& session) {
  if (job.model.empty()) return nullptr;
  auto given = std::make_unique<ModelScene>(job.model, job.labels, session);
  if (given->attributes().classes.empty())
    throw Error(ErrorKind::data, job.model.string() +
                                     ": has no classes, which simulated points get theirs from "
                                     "(make it of points with labels)");
  take_calibration(*given, source);
  require_in_view(*given, motions_of(job, source), sensor);
  const LabelScheme labels = load_label_scheme(job.labels);
  require_one_place(agreement_of(*given, source, labels, session.executor),
                    source.sequence.folder.string());
  return given;
}

/// SHA-256 of all files that the output depends on, by their names in the sequence folder.
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

/// The method and all of its settings, or which file it is.
Json model_content(const SimKitti32Job& job, const Source& source) {
  if (!job.model.empty())
    return {{"sha256", sha256_of_file(job.model)},
            {"poses", word_of(source.poses_are, kHeldOutPoses)}};
  const SplatMethod method = job.method;
  Json json = {{"method", word_of(method, kSplatMethods)}};
  const MethodOptions recipe = MethodChoice{.method = method}.recipe();
  std::visit([&json](const auto& settings) { put_settings(settings, json); }, recipe);
  return json;
}

/// What the data set is made of and how: the beginning of its manifest.
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

/// Makes the scans that are not there yet.
class Simulation {
 public:
  /// `given`: the static model, or null where it is made.
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
    const std::vector<std::size_t> missing = keep_what_is_there();
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
  /// An attempt that was interrupted at its very end had been given the poses already.
  std::unique_ptr<ScanWriter> prepared_writer() const {
    fs::remove(folder_.path() / sequence_ / "poses.txt");
    return make_sequence_writer(folder_.path(), source_.name);
  }

  /// Points and labels of a scan that is written; labels of an empty scan come with the poses.
  std::vector<std::string> files_of(std::size_t scan) const {
    const std::string name = scan_name(scan);
    const std::string points = (sequence_ / "velodyne" / (name + ".bin")).string();
    std::error_code missing;
    if (fs::file_size(folder_.path() / points, missing) == 0) return {points};
    return {points, (sequence_ / "labels" / (name + ".label")).string()};
  }

  std::vector<std::size_t> keep_what_is_there() {
    const std::size_t count = source_.numbers.size();
    session_.progress.begin_step("check what is there", kPassUnits);
    std::vector<std::uint8_t> is_there(count);
    {
      const ProgressPass pass(session_.executor, count);
      session_.executor.for_chunks(count, 1, [&](std::size_t i, std::size_t) {
        is_there[i] = folder_.has(files_of(i)) ? 1 : 0;
      });
    }
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < count; ++i) {
      if (is_there[i] != 0) {
        writer_->keep(i, scans_[i].reference);
      } else {
        missing.push_back(i);
      }
    }
    session_.progress.end_step();
    return missing;
  }

  /// The model as its file has it, so that it does not matter whether this run made it.
  void make_model(SimKitti32Result& result) {
    if (!folder_.has(kModelFile)) write_model(result);
    scene_ = std::make_unique<ModelScene>(folder_.path() / kModelFile, job_.labels, session_);
  }

  void write_model(SimKitti32Result& result) {
    ModelFileJob model;
    model.inputs = {source_.sequence.folder};
    model.output = folder_.path() / kModelFile;
    model.labels = job_.labels;
    model.load.first_scan = source_.numbers.front();
    model.load.scan_count = (source_.numbers.size() + job_.model_every - 1) / job_.model_every;
    model.load.scan_stride = job_.scans.stride * job_.model_every;
    model.load.driven_path_m = 0;  // labels tell what moved
    model.build.recipe = MethodChoice{.method = job_.method}.recipe();
    model.build.remove = DynamicRemoval::moving;
    model.calibration.on = false;  // scans stand at the sequence's own poses, as its other data do
    result.model = run_model(model, session_);
    folder_.record(kModelFile);
  }

  void simulate(std::span<const std::size_t> missing, SimKitti32Result& result) {
    const Stopwatch watch;
    if (job_.moving) {
      const IntensityResponse* const response = scene_->attributes().response;
      scene_->add_objects(
          [&](World& world) { result.moving_splats = add_moving(missing, response, world); });
    }
    ScanSettings settings = settings_;
    settings.fields = fields_of(ScanFormat::semantickitti);
    ScanSimulator simulator(*scene_, std::move(settings), session_.executor);
    ParallelWriteOptions parallel;
    parallel.threads = session_.executor.threads();
    parallel.writes = FileWrites::in_place;
    parallel.hashed = true;
    parallel.written = [this](std::size_t, std::size_t, std::span<const FileDigest> files) {
      folder_.record(files);
    };
    ParallelScanWriter files(*writer_, parallel);
    session_.progress.begin_step("simulate", missing.size());
    std::size_t done = 0;
    // Scans that follow one another are cast together; what is missing is the end of the sequence
    // unless files were damaged.
    for (std::size_t begin = 0; begin < missing.size();) {
      std::size_t end = begin + 1;
      while (end < missing.size() && follows(missing[end - 1], missing[end])) ++end;
      write_run(simulator, missing[begin], end - begin, files, done);
      begin = end;
    }
    files.finish();
    session_.progress.end_step();
    result.seconds_simulated = watch.seconds();
  }

  /// Scans are numbered as in the sequence: noise, patterns and what moves go by that.
  bool follows(std::size_t scan, std::size_t next) const {
    return next == scan + 1 && source_.numbers[next] == source_.numbers[scan] + 1;
  }

  void write_run(ScanSimulator& simulator, std::size_t first, std::size_t count,
                 ParallelScanWriter& files, std::size_t& done) {
    simulator.run_held(std::span(scans_).subspan(first, count), source_.numbers[first],
                       [&](std::size_t i, HeldScan&& scan) {
                         files.write(first + i, std::move(scan));
                         session_.progress.advance(++done);
                       });
  }

  std::size_t add_moving(std::span<const std::size_t> scans, const IntensityResponse* response,
                         World& world) const {
    session_.progress.begin_step("splats of what moves", kPassUnits);
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

  /// The place has reflectances; these are intensities as the sensor at zero measured them.
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
  std::unique_ptr<ModelScene> scene_;  ///< of the static model, as soon as there is one
  LabelScheme labels_;
  const ScanSettings& settings_;
  ResumableFolder& folder_;
  Session& session_;
  fs::path sequence_;  ///< in the folder
  std::vector<ScanMotion> scans_;
  std::unique_ptr<ScanWriter> writer_;
};

void count(const fs::path& written, const Source& source, Session& session,
           SimKitti32Result& result) {
  std::vector<fs::path> originals;
  for (const std::size_t number : source.numbers)
    originals.push_back(source.sequence.labels[number]);
  session.progress.begin_step("count", kPassUnits);
  result.by_class = count_classes(originals, open_kitti_sequence(written).labels, session.executor);
  session.progress.end_step();
  for (const auto& [id, of_class] : result.by_class) result.points += of_class.simulated;
}

Json classes_json(const SimKitti32Result& result, const LabelScheme& labels) {
  Json json = Json::object();
  for (const auto& [id, count] : result.by_class) {
    const SemanticClass* const known = labels.find(id);
    json[std::to_string(id)] = {{"name", known != nullptr ? known->name : ""},
                                {"original", count.original},
                                {"simulated", count.simulated}};
  }
  return json;
}

/// What can be wrong is said before long work, and before a folder is begun for it.
ScanSettings settings_of(const SimKitti32Job& job, std::uint64_t seed) {
  check_settings(job);
  ScanSettings settings;
  settings.sensor = load_lidar_model(job.sensor);
  settings.sensor.range_noise_m = job.noise_m;
  settings.beam.depth = job.depth;
  settings.weather = job.weather;
  settings.ray_drop = chosen_ray_drop(job.ray_drop, settings.sensor);
  settings.seed = seed;
  check(settings);
  return settings;
}

}  // namespace

std::vector<UnusedSetting> unused_settings(const SimKitti32Job& job) {
  std::vector<UnusedSetting> unused;
  const auto take = [&](bool has_no_effect, const std::set<std::string_view>& names,
                        const char* why) {
    if (!has_no_effect) return;
    for (UnusedSetting& each : all_unused(job, why))
      if (names.contains(each.setting.name)) unused.push_back(std::move(each));
  };
  take(!job.moving, {"moving_radius"}, "without what moves");
  take(!job.model.empty(), {"method", "model_every", "keep_model"}, "with a model that is given");
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
  count(folder.path() / "sequences" / source.name, source, session, result);
  session.progress.begin_step("finish", 0);
  const std::vector<std::string> aids = job.keep_model || !fs::exists(folder.path() / kModelFile)
                                            ? std::vector<std::string>{}
                                            : std::vector<std::string>{kModelFile};
  folder.commit(
      {{"points", result.points}, {"classes", classes_json(result, load_label_scheme(job.labels))}},
      aids);
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
