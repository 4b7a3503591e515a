// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/model/make_traffic.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/trace/tracer.h"
#include "adasplats/traffic/find_moving.h"
#include "adasplats/traffic/label_boxes.h"
#include "adasplats/traffic/object_cloud.h"
#include "adasplats/traffic/object_ground.h"
#include "adasplats/traffic/object_kind.h"

namespace adasplats {
namespace {

/// "044-car": letters, digits and hyphens only.
std::string file_name_of(const RecordedObject& object) {
  std::string name = std::to_string(object.id);
  if (name.size() < 3) name.insert(0, 3 - name.size(), '0');
  name += '-';
  for (const char c : lower_case(object.label.empty() ? "object" : object.label)) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_plain || name.back() != '-') name += is_plain ? c : '-';
  }
  while (name.back() == '-') name.pop_back();
  return name;
}

/// The chosen scans of the drive, as the model reads them. Errors: usage (not one drive with
/// times).
KittiSequence open_scans(const ModelJob& job, Session& session) {
  for (const std::filesystem::path& input : job.inputs) require_input(input);
  const OpenInputs opened(job.inputs, job.load, session.executor, session.progress);
  if (opened.inputs().size() != 1 || !opened.inputs().front().sequence)
    throw Error(ErrorKind::usage,
                "`traffic` needs exactly one drive: scans of one sensor with poses");
  const KittiSequence& drive = *opened.inputs().front().sequence;
  if (!drive.has_times)
    throw Error(ErrorKind::usage, "`traffic` needs the times of the scans, but " +
                                      drive.folder.string() + " has none (times.txt)");
  std::vector<std::size_t> chosen;
  for (std::size_t k = job.load.first_scan;
       k < drive.scans.size() && chosen.size() < job.load.scan_count; k += job.load.scan_stride)
    chosen.push_back(k);
  return with_scans(drive, chosen);
}

std::vector<RecordedObject> collect_objects(const KittiSequence& drive, Session& session) {
  constexpr std::size_t kAtOnce = 64;  // scans
  ObjectCollector collector(*drive.boxes);
  session.progress.begin_step("collect objects", drive.scans.size());
  for (std::size_t begin = 0; begin < drive.scans.size(); begin += kAtOnce) {
    std::vector<std::vector<ObjectCollector::Part>> parts(
        std::min(kAtOnce, drive.scans.size() - begin));
    session.executor.for_chunks(parts.size(), 1, [&](std::size_t n, std::size_t) {
      parts[n] = collector.parts_of(drive, begin + n, read_all_returns(drive, begin + n));
    });
    for (std::vector<ObjectCollector::Part>& of_scan : parts) collector.add(std::move(of_scan));
    session.progress.advance(begin + parts.size());
  }
  session.progress.end_step();
  return collector.take();
}

/// Changes measured intensities to reflectances by the response of the scene's sensor at each
/// point's range, at the incidence of most surfaces.
void to_reflectances(const IntensityResponse& response, PointCloud& cloud) {
  constexpr float kCosine = 0.8F;
  if (response.empty()) return;
  for (std::size_t i = 0; i < cloud.intensities.size(); ++i) {
    const float range_m = length(cloud.positions[i] - cloud.sensor_positions[i]);
    const float gain = response.gain(range_m, kCosine);
    if (gain > 0) cloud.intensities[i] /= gain;
  }
}

/// The splats of an object from all of its points.
/// Rays through those of people and cyclists, whose limbs move, do not count against them.
SplatModel body_of(PointCloud cloud, bool is_rigid, const ModelJob& job, const Session& session) {
  ModelOptions options;
  options.build.recipe = job.build.recipe;
  options.build.remove = DynamicRemoval::none;
  options.build.reflectances = false;
  options.build.trust_origins = true;
  options.calibration.on = false;
  if (auto* const ours = std::get_if<ConsistentOptions>(&options.build.recipe))
    ours->refine = is_rigid;
  // Starting a GPU takes longer than making so few splats.
  DeviceChoice cpu;
  ProgressSink silence;
  Session quiet{session.executor, silence, session.seed, cpu};
  return make_model([&cloud] { return cloud; }, options, quiet).first;
}

/// Models one object and writes its files; fills in what the caller does not know yet.
void write_object(RecordedObject& object, const ModelJob& job, const IntensityResponse& response,
                  const std::filesystem::path& folder, const Session& session,
                  TrafficObject& made) {
  constexpr std::size_t kMinPoints = 100;
  constexpr float kMirrorApart_m = 0.4F;
  made.ground_points = remove_ground(object);
  made.scans = object.scans.size();
  made.points = object.points();
  made.world_from_object = object.world_from_object.front().world_from_sensor;
  made.begin_s = object.world_from_object.front().time_s;
  made.end_s = object.world_from_object.back().time_s;
  if (made.points < kMinPoints) {
    made.left_out = "fewer than " + std::to_string(kMinPoints) + " points";
    return;
  }
  if (made.scans < 2 || (!made.is_at_rest && object.world_from_object.size() < 2)) {
    made.left_out = "seen once";
    return;
  }
  if (!made.is_at_rest) made.aligned = align_scans(object, {}, session.executor);
  PointCloud cloud = cloud_of(object);
  to_reflectances(response, cloud);
  const bool is_vehicle = object_kind_of(object.label).is_vehicle;
  if (is_vehicle) made.mirrored_points = add_mirrored(cloud, kMirrorApart_m, session.executor);
  SplatModel body;
  try {
    body = body_of(std::move(cloud), is_vehicle, job, session);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::data) throw;
    made.left_out = error.what();
    return;
  }
  made.splats = body.size();
  save_model(folder / (made.name + ".ply"), body);
  if (!made.is_at_rest)
    write_trajectory_csv(folder / (made.name + ".csv"), object.world_from_object);
}

/// As MovingBoxes reads them.
std::string boxes_text(const MovingBoxes& boxes) {
  std::string text = "time,id,label,stationary,x,y,z,size_x,size_y,size_z,yaw\n";
  for (const BoxTrack& track : boxes.tracks()) {
    for (const TimedBox& box : track.boxes) {
      text += exact_text(box.time_s) + "," + std::to_string(track.id) + "," + track.label +
              (track.is_at_rest ? ",1" : ",0");
      for (const double value : {box.middle.x, box.middle.y, box.middle.z, 2 * box.half_size.x,
                                 2 * box.half_size.y, 2 * box.half_size.z, box.yaw_rad})
        text += "," + exact_text(value);
      text += "\n";
    }
  }
  return text;
}

/// The class of a kind in the scene's label scheme, which is SemanticKITTI's if it has none.
std::optional<std::uint16_t> class_of(const ObjectKind& kind, bool is_at_rest,
                                      const std::string& scheme_name) {
  const LabelScheme scheme =
      scheme_name.empty() ? semantickitti_labels() : load_label_scheme(scheme_name);
  for (const std::string_view name : {is_at_rest ? kind.at_rest : kind.moving, kind.word})
    if (const SemanticClass* found = scheme.find(name); !name.empty() && found != nullptr)
      return found->id;
  return std::nullopt;
}

std::string place_text(const RigidTransform& world_from_object) {
  const Vec3d at = world_from_object.translation;
  const Vec3d* const rows = world_from_object.rotation.rows;
  const double yaw_deg = std::atan2(rows[1].x, rows[0].x) * 180 / std::numbers::pi;
  return "position = [" + exact_text(at.x) + ", " + exact_text(at.y) + ", " + exact_text(at.z) +
         "]\nyaw_deg = " + exact_text(yaw_deg) + "\n";
}

std::string world_text(const std::vector<TrafficObject>& objects) {
  std::string text = "model = \"scene.ply\"\n";
  for (const TrafficObject& object : objects) {
    if (!object.left_out.empty()) continue;
    text += "\n[[object]]\nname = \"" + object.name + "\"\ngeometry = \"objects/" + object.name +
            ".ply\"\n";
    if (object.class_id) text += "class = " + std::to_string(*object.class_id) + "\n";
    if (object.is_at_rest)
      text += place_text(object.world_from_object);
    else
      text += "trajectory = \"objects/" + object.name + ".csv\"\npresent = \"during\"\n";
  }
  return text;
}

/// The objects to be taken out of the scans, the vehicles at rest behind the moving ones.
BoxContent objects_of(const KittiSequence& drive, const ModelJob& job, Session& session,
                      std::vector<StepTime>& steps) {
  BoxContent content;
  Stopwatch watch;
  if (drive.boxes) {
    content = drive.boxes->content();
  } else if (!job.segment.on) {
    if (const std::optional<LabelScheme> scheme =
            label_scheme_for(job.labels, job.inputs, job.load.label_field)) {
      content = boxes_of_labels(drive, *scheme, session.executor, session.progress);
      steps.push_back({"find labelled objects", watch.seconds()});
    }
  }
  if (!drive.boxes && content.moving.empty() && content.at_rest.empty()) {
    watch = {};
    std::vector<std::size_t> scans(drive.scans.size());
    std::iota(scans.begin(), scans.end(), std::size_t{0});
    content.moving = find_moving(drive, scans, {}, session.executor, session.progress);
    steps.push_back({"find moving objects", watch.seconds()});
  }
  for (BoxTrack& track : content.at_rest)
    if (!drive.boxes || object_kind_of(track.label).is_vehicle)
      content.moving.push_back(std::move(track));
  content.at_rest.clear();
  return content;
}

/// Counts the beams that ended on an object, and those that the scene without it lets pass.
void count_open_beams(const RecordedObject& object, const Tracer& tracer, Vec3d scene_origin,
                      const Executor& executor, TrafficObject& made) {
  std::vector<Ray> rays;
  for (const ObjectScan& scan : object.scans) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Vec3d from = scan.world_from_object * scan.origins[i];
      const Vec3d to = scan.world_from_object * scan.points[i];
      Ray ray;
      ray.origin = vec_cast<float>(from - scene_origin);
      ray.direction = vec_cast<float>(normalized(to - from));
      rays.push_back(ray);
    }
  }
  std::vector<Hit> hits(rays.size());
  tracer.nearest(rays, hits, executor);
  made.beams = rays.size();
  made.open_beams = static_cast<std::size_t>(
      std::ranges::count_if(hits, [](const Hit& hit) { return !hit.valid(); }));
}

/// Models the objects, several at once, and writes their files.
std::vector<TrafficObject> model_objects(std::vector<RecordedObject>& objects,
                                         const KittiSequence& drive, const SplatModel& scene,
                                         const ModelJob& job, const std::filesystem::path& folder,
                                         Session& session) {
  std::filesystem::create_directory(folder);
  session.progress.begin_step("model objects", kPassUnits);
  std::vector<TrafficObject> all(objects.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    TrafficObject& made = all[k];
    made.id = objects[k].id;
    made.label = objects[k].label;
    made.name = file_name_of(objects[k]);
    made.is_at_rest = drive.boxes->tracks()[k].is_at_rest;
    made.class_id = class_of(object_kind_of(made.label), made.is_at_rest, scene.label_scheme);
    made.size_m = objects[k].size_m;
  }
  {
    const ProgressPass pass(session.executor, all.size());
    session.executor.for_chunks(all.size(), 1, [&](std::size_t k, std::size_t) {
      write_object(objects[k], job, scene.response, folder, session, all[k]);
    });
  }
  std::unique_ptr<Tracer> tracer;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!all[k].is_at_rest || objects[k].scans.empty()) continue;
    if (!tracer) tracer = make_cpu_tracer(scene.view(), session.executor);
    count_open_beams(objects[k], *tracer, scene.origin, session.executor, all[k]);
  }
  session.progress.end_step();
  return all;
}

}  // namespace

TrafficResult run_traffic(const ModelJob& job, const std::filesystem::path& folder, bool overwrite,
                          Session& session) {
  if (method_of(job.build.recipe) == SplatMethod::semantic)
    throw Error(ErrorKind::usage, "`traffic` does not work with the method semantic");
  const Stopwatch total;
  OutputFolder output(folder, overwrite, "model --traffic", {{"traffic", true}});
  TrafficResult result;
  KittiSequence drive = open_scans(job, session);
  ModelJob without = job;
  const bool are_given = drive.boxes != nullptr;
  std::vector<StepTime> steps;
  drive.boxes = std::make_shared<const MovingBoxes>(objects_of(drive, job, session, steps));
  BoxContent moving, parked;
  moving.are_of_scans = drive.boxes->are_of_scans();
  for (const BoxTrack& track : drive.boxes->tracks())
    (track.is_at_rest ? parked : moving).moving.push_back(track);
  without.load.found_boxes = std::make_shared<const MovingBoxes>(std::move(moving));
  if (!parked.moving.empty())
    without.parked = std::make_shared<const MovingBoxes>(std::move(parked));
  if (!are_given && !drive.boxes->empty())
    write_file(output.path() / "boxes.csv", boxes_text(*drive.boxes));
  auto [scene, made] = make_model(without, session);
  result.scene = std::move(made);
  steps.insert(steps.end(), result.scene.steps.begin(), result.scene.steps.end());
  save_model(output.path() / "scene.ply", scene);
  if (!result.scene.calibration.empty() && !apply(result.scene.calibration, drive))
    throw std::logic_error("run_traffic: the calibration is of other scans");
  Stopwatch watch;
  std::vector<RecordedObject> objects = collect_objects(drive, session);
  steps.push_back({"collect objects", watch.seconds()});
  watch = {};
  result.objects = model_objects(objects, drive, scene, job, output.path() / "objects", session);
  steps.push_back({"model objects", watch.seconds()});
  result.scene.steps = std::move(steps);
  write_file(output.path() / "world.toml", world_text(result.objects));
  output.commit();
  result.scene.seconds = total.seconds();
  return result;
}

nlohmann::ordered_json to_json(const TrafficResult& result) {
  nlohmann::ordered_json json = to_json(result.scene);
  json["objects"] = nlohmann::ordered_json::array();
  for (const TrafficObject& object : result.objects)
    json["objects"].push_back({{"id", object.id},
                               {"label", object.label},
                               {"name", object.name},
                               {"class", object.class_id ? nlohmann::ordered_json(*object.class_id)
                                                         : nlohmann::ordered_json()},
                               {"size_m", {object.size_m.x, object.size_m.y, object.size_m.z}},
                               {"at_rest", object.is_at_rest},
                               {"times_s", {object.begin_s, object.end_s}},
                               {"scans", object.scans},
                               {"points", object.points},
                               {"mirrored_points", object.mirrored_points},
                               {"splats", object.splats},
                               {"ground_points", object.ground_points},
                               {"scans_aligned", object.aligned.scans},
                               {"median_shift_m", object.aligned.median_shift_m},
                               {"median_turn_rad", object.aligned.median_turn_rad},
                               {"beams", object.beams},
                               {"open_beams", object.open_beams},
                               {"left_out", object.left_out}});
  return json;
}

}  // namespace adasplats
