// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/register_scans.h"
#include "adasplats/io/packets/capture_reader.h"
#include "adasplats/jobs/provenance/metrics_json.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

KittiSequence with_scans(KittiSequence all, const ScanRange& range) {
  KittiSequence chosen;
  chosen.folder = all.folder;
  chosen.beams.from_hdl64 = all.beams.from_hdl64;
  chosen.beams.recognised = all.beams.recognised;
  chosen.reader = all.reader;
  chosen.facts = all.facts;
  for (const std::size_t i : chosen_scans(range, all.scans.size(), all.folder)) {
    chosen.scans.push_back(all.scans[i]);
    if (!all.labels.empty()) chosen.labels.push_back(all.labels[i]);
    chosen.trajectory.push_back(all.trajectory[i]);
    if (!all.beams.sweeps_m.empty()) chosen.beams.sweeps_m.push_back(all.beams.sweeps_m[i]);
    if (!all.beams.raw_motions.empty())
      chosen.beams.raw_motions.push_back(all.beams.raw_motions[i]);
  }
  return chosen;
}

/// A folder of scans with a trajectory. Their classes are of no known scheme, so none take part.
KittiSequence open_frames(const HeldOutScans& scans, Session& session) {
  if (!scans.motion.empty())
    throw Error(ErrorKind::usage,
                "`motion` is for raw scans of a sequence; these have a trajectory");
  if (is_kitti_sequence(scans.sequence))
    throw Error(ErrorKind::usage, scans.sequence.string() +
                                      ": has poses of its own; `trajectory` is for a folder of "
                                      "scans, one a file");
  FrameDrive given = drive_of(scans.sequence, scans);
  given.with_classes = false;
  auto drive = open_frame_drive(given, session.executor, session.progress);
  if (!drive)
    throw Error(ErrorKind::data, scans.sequence.string() +
                                     ": where its beams began is not known: it is no folder of "
                                     "scans with a pose each, nor of points with times of a sensor "
                                     "that is recognised, so they cannot be cast again");
  return std::move(*drive);
}

}  // namespace

KittiSequence open_held_out(const HeldOutScans& scans, Session& session) {
  const bool is_drive = !scans.trajectory.empty() || is_drive_by_itself(scans.sequence);
  if (!is_drive && (!scans.topic.empty() || !scans.poses_topic.empty()))
    throw Error(ErrorKind::usage, "`topic` and `poses_topic` are for a recording (MCAP, ROS bag)");
  if (!is_drive && !scans.scene.empty())
    throw Error(ErrorKind::usage, "`scene` is for a data root of nuScenes");
  if (!is_capture(scans.sequence) && !scans.packets_of.empty())
    throw Error(ErrorKind::usage, "`packets_of` is for a capture of packets (.pcap, .pcapng)");
  if (!is_drive && !scans.boxes.empty())
    throw Error(ErrorKind::usage, "`boxes` are for scans with times and a `trajectory`");
  const bool states_frames = scans.mount || scans.time_offset_s || !scans.scan_times.empty() ||
                             !(scans.mount_rotation_deg == Vec3d{}) ||
                             scans.points_in != PointsIn::found ||
                             scans.sweep_points != SweepPoints::found;
  if (!is_drive && states_frames)
    throw Error(ErrorKind::usage,
                "`mount`, `mount_rotation`, `time_offset`, `points_in`, `sweep_points` and "
                "`scan_times` are for a folder of scans with a `trajectory`");
  if (is_drive) return with_scans(open_frames(scans, session), scans.scans);
  KittiSequence all = open_kitti_sequence(resolve_cloud_input(scans.sequence));
  all.facts.unchecked = require_poses_that_fit(all, session.executor);
  if (!scans.beams_from_poses) all.beams = recognize_beams(all, session.executor);
  if (!scans.motion.empty()) {
    if (!all.beams.sweeps_m.empty())
      throw Error(ErrorKind::usage, "`motion` is for scans as they were measured; those of " +
                                        all.folder.string() + " are motion-compensated");
    set_raw_motions(all.beams, all.trajectory, load_trajectory(scans.motion));
  }
  return with_scans(std::move(all), scans.scans);
}

HeldOutPoses calibrate_held_out(const ModelScene& scene, KittiSequence& sequence,
                                ProgressSink& progress) {
  const SplatModel* model = scene.splats();
  if (model == nullptr || model->calibration.empty()) return HeldOutPoses::as_given;
  if (apply(model->calibration, sequence)) return HeldOutPoses::interpolated;
  progress.warn(not_of_calibrated_drive(sequence.folder) + ", so their poses are taken as given");
  return HeldOutPoses::not_covered;
}

std::string not_of_calibrated_drive(const std::filesystem::path& folder) {
  return folder.string() +
         ": its scans are not of the drive that the model was calibrated with (by their times and "
         "places)";
}

HeldOutResult evaluate_resimulation(const ModelScene& scene, KittiSequence& sequence,
                                    const std::string& labels, const ResimulateOptions& options,
                                    const HeldOutExtras& extras, Session& session) {
  const LabelScheme scheme = load_label_scheme(labels);
  const auto cast = [&](const KittiSequence& scans, KeepBeams keep = KeepBeams::no) {
    return resimulate(scene.tracer(), scene.view(), scene.origin(), scans, scheme, options,
                      session.executor, session.progress, keep);
  };
  HeldOutResult result;
  if (extras.all_poses) result.with_given = cast(sequence);
  const std::optional<std::size_t> of_model = scans_of_model(scene, sequence);
  result.poses = calibrate_held_out(scene, sequence, session.progress);
  static_cast<ResimulateResult&>(result) = cast(sequence, extras.keep);
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

namespace {

/// Null of what is not known.
nlohmann::ordered_json known(double value) {
  return std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
}

nlohmann::ordered_json returns_json(const BeamReturns& returns) {
  return {{"returned_beams", returns.returned},
          {"holes", known(returns.holes)},
          {"empty_beams", returns.empty},
          {"ghosts", known(returns.ghosts)},
          {"precision", known(returns.precision)},
          {"recall", known(returns.recall)},
          {"f1", known(returns.f1)}};
}

}  // namespace

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
