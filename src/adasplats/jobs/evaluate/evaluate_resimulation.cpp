// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/drive_boxes.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/rig_of_drive.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/error_points.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/packets/capture_reader.h"
#include "adasplats/jobs/evaluate/evaluate_clouds.h"
#include "adasplats/jobs/evaluate/json_values.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/simulate/captions/color_bar.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats {
namespace {

KittiSequence with_range(const KittiSequence& all, const ScanRange& range) {
  return with_scans(all, chosen_scans(range, all.scans.size(), all.folder));
}

/// A folder of scans with a trajectory. The scheme of their classes is unknown, so classes are not
/// read.
KittiSequence open_frames(const HeldOutScans& scans, Session& session) {
  if (!scans.motion.empty())
    throw Error(ErrorKind::usage,
                "`motion` is for raw scans of a sequence; these scans have a trajectory");
  if (is_kitti_sequence(scans.sequence) && !lacks_poses(scans.sequence))
    throw Error(ErrorKind::usage, scans.sequence.string() +
                                      ": has its own poses; `trajectory` is for a folder of "
                                      "scans, one per file");
  DriveInput given = drive_of(scans.sequence, scans);
  given.with_classes = false;
  auto drive = open_drive(given, session.executor, session.progress);
  if (!drive)
    throw Error(ErrorKind::data, scans.sequence.string() +
                                     ": beams cannot be cast again, because their origins are "
                                     "unknown; give a folder of scans with a pose each, or points "
                                     "with times of a recognised sensor");
  if (is_recording(scans.sequence) || data_tree_of(scans.sequence) != nullptr)
    drive->rig_sensor = sensor_of_topic(scans.topic);
  return std::move(*drive);
}

/// Of scans as they are cast; `of_model`: how many of them the model was made from. Warns if any.
Lidar4dEvaluation evaluate_lidar4d(const ModelScene& scene, const KittiSequence& sequence,
                                   std::optional<std::size_t> of_model, Session& session) {
  if (of_model.value_or(0) > 0)
    session.progress.warn("the model was made from " + std::to_string(*of_model) + " of the " +
                          std::to_string(sequence.scans.size()) +
                          " scans that it is compared with, so these are not held-out figures");
  return {evaluate_lidar4d(scene.tracer(), scene.attributes(), scene.origin(), sequence,
                           session.executor, session.progress),
          of_model};
}

void write_beam_picture(const ResimulateJob& job, const ScanErrors& scan, Session& session) {
  constexpr double kWrong_m = 0.50;
  constexpr Rgb kNoHit = {120, 120, 120};
  session.progress.begin_step("draw a scan", 0);
  const ColorScale& scale = signed_scale();
  std::vector<Rgb> colors;
  colors.reserve(scan.errors_m.size());
  for (const float error_m : scan.errors_m) {
    const double share = 0.5 + 0.5 * static_cast<double>(error_m) / kWrong_m;
    colors.push_back(std::isnan(error_m) ? kNoHit : scale.at(share));
  }
  Camera camera = look_at({-16, 0, 11}, {9, 0, -1});  // sensor frame, x ahead
  camera.width = job.picture_width;
  camera.height = job.picture_width * 9 / 16;
  PointImageOptions options;
  options.background = {22, 22, 26};  // dark, because points without error are white
  options.point_size_m = 0.08;
  options.relief = false;  // it would draw an edge around every ring
  Image image = draw_points(scan.measured, {}, colors, camera, options, session.executor);
  draw_color_bar(image, scale,
                 {"predicted less measured range, cm",
                  {{0, "-50 early"}, {0.5, "0"}, {1, "late +50"}},
                  {{kNoHit, "no hit"}}});
  write_png(job.picture, image.width, image.height, image.pixels);
  session.progress.end_step();
}

/// "x 1.0 to 2.0, y 3.0 to 4.0".
std::string extent_text(Vec3d low, Vec3d high) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "x %.1f to %.1f, y %.1f to %.1f", low.x, high.x, low.y,
                high.y);
  return text.data();
}

/// Where the scans of a sequence were measured from and where the model is.
struct Places {
  Vec3d low, high;                    ///< of the poses
  std::pair<Vec3d, Vec3d> model_box;  ///< of the middle 98 %

  Places(const ModelScene& scene, const KittiSequence& sequence) : model_box(scene.middle_box()) {
    low = high = sequence.trajectory.front().world_from_sensor.translation;
    for (const TimedPose& pose : sequence.trajectory) {
      low = min(low, pose.world_from_sensor.translation);
      high = max(high, pose.world_from_sensor.translation);
    }
  }

  /// Horizontal distance between the two, m.
  double apart_m() const {
    const Vec3d gap = max(max(low - model_box.second, model_box.first - high), Vec3d{});
    return std::hypot(gap.x, gap.y);
  }

  std::string text() const {
    return "the sensor was at " + extent_text(low, high) + ", most of the model is at " +
           extent_text(model_box.first, model_box.second);
  }
};

constexpr const char* kOtherPlace =
    "; check that model and scans are of one place and in one coordinate system";

/// Throws data if the scans were measured out of reach of the model.
void require_same_place(const ModelScene& scene, const KittiSequence& sequence) {
  constexpr double kReach_m = 250;
  if (sequence.trajectory.empty()) return;
  const Places places(scene, sequence);
  if (places.apart_m() > kReach_m)
    throw Error(ErrorKind::data, sequence.folder.string() + ": its scans are out of reach of the " +
                                     "model: " + places.text() + kOtherPlace);
}

/// Warns if most beams disagree with the model.
void warn_of_other_place(const ModelScene& scene, const KittiSequence& sequence,
                         const BeamAccuracy& all, ProgressSink& progress) {
  constexpr double kMaxNoHit = 0.5, kMinWithin = 0.4, kBound_m = 0.50;
  const auto within = all.within.find(kBound_m);
  if (all.rays == 0 || within == all.within.end()) return;
  if (all.no_hit <= kMaxNoHit && within->second >= kMinWithin) return;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                ": the model does not explain its beams: %.0f %% hit nothing, %.0f %% end within "
                "50 cm of the measured point; ",
                100 * all.no_hit, 100 * within->second);
  progress.warn(sequence.folder.string() + text.data() + Places(scene, sequence).text() +
                kOtherPlace);
}

}  // namespace

namespace {

/// The sensor of a rig that `topic` names.
KittiSequence open_sensor(const HeldOutScans& scans, Session& session) {
  const Rig rig = read_rig(scans.sequence);
  require_no_settings(rig, scans);
  if (!scans.motion.empty())
    throw Error(ErrorKind::usage, "`motion` is for raw scans of a sequence, not for a rig");
  const std::size_t sensor = rig.sensors.size() == 1 ? 0 : rig.index_of(scans.topic);
  return open_rig_sensor(rig.sensors[sensor], session.executor, session.progress);
}

}  // namespace

KittiSequence open_held_out(const HeldOutScans& scans, Session& session) {
  if (is_rig(scans.sequence)) return with_range(open_sensor(scans, session), scans.scans);
  const bool is_drive = !scans.trajectory.empty() || is_self_contained_drive(scans.sequence);
  if (!is_drive && (!scans.topic.empty() || !scans.poses_topic.empty()))
    throw Error(ErrorKind::usage,
                "`topic` and `poses_topic` are for a recording, a packet capture or a data set");
  if (!is_drive && !scans.scene.empty())
    throw Error(ErrorKind::usage, "`scene` is for a data root of nuScenes");
  if (!is_capture(scans.sequence) && !is_recording(scans.sequence) && !scans.packet_sensor.empty())
    throw Error(ErrorKind::usage, "`packet_sensor` is for a packet capture or a recording");
  const bool states_frames = scans.mount || scans.time_offset_s || !scans.scan_times.empty() ||
                             !(scans.mount_rotation_deg == Vec3d{}) ||
                             scans.points_in != PointsIn::found ||
                             scans.sweep_points != SweepPoints::found;
  if (!is_drive && states_frames)
    throw Error(ErrorKind::usage,
                "`mount`, `mount_rotation`, `time_offset`, `points_in`, `sweep_points` and "
                "`scan_times` are for a folder of scans with a `trajectory`");
  if (is_drive) return with_range(open_frames(scans, session), scans.scans);
  KittiSequence all = open_kitti_sequence(resolve_cloud_input(scans.sequence));
  all.facts.unchecked = verify_poses(all, session.executor);
  if (!scans.beams_from_poses) all.beams = recognize_beams(all, session.executor);
  if (!scans.motion.empty()) {
    if (!all.beams.sweeps_m.empty())
      throw Error(ErrorKind::usage, "`motion` is for raw scans; those of " + all.folder.string() +
                                        " are motion-compensated");
    set_raw_motions(all.beams, all.trajectory, load_trajectory(scans.motion));
  }
  add_boxes(scans, {}, all, session.executor, session.progress);
  return with_range(all, scans.scans);
}

HeldOutPoses calibrate_held_out(const ModelScene& scene, KittiSequence& sequence,
                                ProgressSink& progress) {
  const SplatModel* model = scene.splats();
  if (model == nullptr || model->calibration.empty()) return HeldOutPoses::as_given;
  if (apply(model->calibration, sequence)) return HeldOutPoses::interpolated;
  progress.warn(not_of_calibrated_drive(sequence.folder) + "; their poses are used as given");
  return HeldOutPoses::not_covered;
}

std::string not_of_calibrated_drive(const std::filesystem::path& folder) {
  return folder.string() +
         ": its scans are not of the drive that the model was calibrated with (by their times and "
         "places)";
}

std::optional<std::size_t> scans_of_model(const ModelScene& scene, const KittiSequence& given) {
  const SplatModel* model = scene.splats();
  if (model == nullptr || model->calibration.poses.empty()) return {};
  // Both come from one file, but models store times and positions as text.
  constexpr double kSameTime_s = 1e-4, kSamePlace_m = 1e-3;
  const auto is_of_model = [&](const TimedPose& pose) {
    return std::ranges::any_of(model->calibration.poses, [&](const PoseCorrection& of_model) {
      return std::fabs(of_model.time_s - pose.time_s) < kSameTime_s &&
             length(of_model.position - pose.world_from_sensor.translation) < kSamePlace_m;
    });
  };
  return static_cast<std::size_t>(std::ranges::count_if(given.trajectory, is_of_model));
}

HeldOutResult evaluate_resimulation(const ModelScene& scene, KittiSequence& sequence,
                                    const std::string& labels, const ResimulateOptions& options,
                                    const HeldOutExtras& extras, Session& session) {
  const LabelScheme scheme = load_label_scheme(labels);
  const auto cast = [&](const KittiSequence& scans, KeepBeams keep = KeepBeams::no) {
    return resimulate({scene.tracer(), scene.attributes(), scene.origin(), scene.world()}, scans,
                      scheme, options, session.executor, session.progress, keep);
  };
  require_same_place(scene, sequence);
  HeldOutResult result;
  if (extras.all_poses) result.with_given = cast(sequence);
  const std::optional<std::size_t> of_model = scans_of_model(scene, sequence);
  result.poses = calibrate_held_out(scene, sequence, session.progress);
  static_cast<ResimulateResult&>(result) = cast(sequence, extras.keep);
  warn_of_other_place(scene, sequence, result.all, session.progress);
  result.empty = cast_empty_beams(scene.tracer(), scene.origin(), sequence, session.executor);
  result.returns = beam_returns(result.all, result.empty);
  result.upward_returns = beam_returns(result.upward, result.empty);
  if (extras.protocol == HeldOutProtocol::lidar4d)
    result.lidar4d = evaluate_lidar4d(scene, sequence, of_model, session);
  if (extras.all_poses) {
    KittiSequence registered = sequence;
    register_scans(scene.tracer(), scene.view(), scene.origin(), registered, scheme, options,
                   session.executor, session.progress);
    result.registered = cast(registered);
  }
  return result;
}

HeldOutResult evaluate_resimulation(const ResimulateJob& job, Session& session) {
  require_input(job.model);
  if (!job.picture.empty()) check_output_file(job.picture);
  if (!job.errors.empty()) check_output_file(job.errors);
  load_label_scheme(job.labels);  // report its errors before long work
  KittiSequence sequence = open_held_out(job, session);
  if (sequence.labels.empty() && job.options.drop_movable) {
    throw Error(ErrorKind::usage,
                "`drop_movable` has no effect: " + sequence.folder.string() + " has no labels");
  }
  const ModelScene scene(job.model, "", session, WorldFiles::taken);
  HeldOutExtras extras = job.extras;
  if (!job.picture.empty() || !job.errors.empty()) extras.keep = KeepBeams::yes;
  HeldOutResult result =
      evaluate_resimulation(scene, sequence, job.labels, job.options, extras, session);
  if (!job.picture.empty())
    write_beam_picture(job, result.errors[sequence.scans.size() / 2], session);
  if (!job.errors.empty())
    write_error_points(job.errors, beam_points(std::move(result.errors), sequence.trajectory,
                                               scene.view().primitive_count()));
  return result;
}

namespace {

nlohmann::ordered_json returns_json(const BeamReturns& returns) {
  return {{"returned_beams", returns.returned},
          {"holes", finite_or_null(returns.holes)},
          {"empty_beams", returns.empty},
          {"ghosts", finite_or_null(returns.ghosts)},
          {"precision", finite_or_null(returns.precision)},
          {"recall", finite_or_null(returns.recall)},
          {"f1", finite_or_null(returns.f1)}};
}

nlohmann::ordered_json error_json(const ImageError& error) {
  return {{"rmse", error.rmse},
          {"medae", error.medae},
          {"ssim", finite_or_null(error.ssim)},
          {"psnr_db", finite_or_null(error.psnr_db)}};
}

nlohmann::ordered_json layout_json(const PanoramaLayout& layout) {
  return {{"rows", layout.rows},
          {"columns", layout.columns},
          {"top_deg", layout.top_rad / kDegree},
          {"span_deg", layout.span_rad / kDegree},
          {"max_range_m", layout.max_range_m}};
}

}  // namespace

nlohmann::ordered_json to_json(const BeamAccuracy& accuracy) {
  nlohmann::ordered_json json;
  json["rays"] = accuracy.rays;
  json["no_hit"] = accuracy.no_hit;
  json["early_50cm"] = accuracy.early_50cm;
  json["late_50cm"] = accuracy.late_50cm;
  json["within"] = json_by_bound(accuracy.within);
  json["range_error_m"] = {{"median", accuracy.median_m}, {"mae", accuracy.mae_m},
                           {"rmse", accuracy.rmse_m},     {"p90", accuracy.p90_m},
                           {"bias", accuracy.bias_m},     {"spread", accuracy.spread_m}};
  return json;
}

nlohmann::ordered_json to_json(const ResimulateResult& result) {
  nlohmann::ordered_json json = to_json(result.all);
  json.update(to_json(result.clouds));
  json["beams"] = result.beams;
  json["intensity"] = nullptr;
  if (result.intensities)
    json["intensity"] = {
        {"beams", result.intensities->beams},
        {"rmse_after_fit", finite_or_null(result.intensities->rmse_after_fit)},
        {"rank_correlation", finite_or_null(result.intensities->rank_correlation)}};
  const auto add = [&](const char* key, const auto& parts) {
    json[key] = nlohmann::ordered_json::object();
    for (const auto& [name, accuracy] : parts) json[key][name] = to_json(accuracy);
  };
  add("by_range", result.by_range);
  add("by_incidence", result.by_incidence);
  add("by_surroundings", result.by_surroundings);
  add("by_motion", result.by_motion);
  add("by_object", result.by_object);
  add("by_class", result.by_class);
  add("by_elevation", result.by_elevation);
  return json;
}

nlohmann::ordered_json to_json(const Lidar4dEvaluation& result) {
  nlohmann::ordered_json json = {{"protocol", "LiDAR4D (CVPR 2024)"},
                                 {"comparable", kLidar4dComparable},
                                 {"differs", kLidar4dDiffers},
                                 {"scans", result.scans},
                                 {"scans_of_model", nullptr},
                                 {"range_image", layout_json(result.layout)},
                                 {"depth_m", error_json(result.depth)},
                                 {"intensity", nullptr},
                                 {"intensity_scale", nullptr},
                                 {"ray_drop",
                                  {{"rmse", result.drop.rmse},
                                   {"accuracy", result.drop.accuracy},
                                   {"f_score", result.drop.f_score}}},
                                 {"points",
                                  {{"chamfer_m2", finite_or_null(result.chamfer_m2)},
                                   {"f_score", finite_or_null(result.f_score_224mm)},
                                   {"f_score_5cm", finite_or_null(result.f_score_5cm)}}}};
  if (result.scans_of_model) json["scans_of_model"] = *result.scans_of_model;
  if (result.intensity) {
    json["intensity"] = error_json(*result.intensity);
    json["intensity_scale"] = result.intensity_scale;
  }
  return json;
}

nlohmann::ordered_json to_json(const HeldOutResult& result) {
  nlohmann::ordered_json json = to_json(static_cast<const ResimulateResult&>(result));
  json["poses"] = word_of(result.poses, words_of(result.poses));
  json["empty_beams"] = {{"beams", result.empty.beams}, {"ghosts", nullptr}, {"reach_m", nullptr}};
  if (result.empty.beams > 0) {
    json["empty_beams"]["ghosts"] = result.empty.ghosts;
    json["empty_beams"]["reach_m"] = result.empty.reach_m;
  }
  json["returns"] = returns_json(result.returns);
  json["returns"]["upward"] = returns_json(result.upward_returns);
  if (result.with_given) json["as_given"] = to_json(*result.with_given);
  if (result.lidar4d) json["lidar4d"] = to_json(*result.lidar4d);
  if (result.registered) json["registered"] = to_json(*result.registered);
  return json;
}

}  // namespace adasplats
