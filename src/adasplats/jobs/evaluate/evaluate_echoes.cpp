// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_echoes.h"

#include <nlohmann/json.hpp>
#include <vector>

#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/evaluate/json_values.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

/// Measured scans of a sequence. In raw scans of an HDL-64E missing returns can be identified.
class EchoSequence {
 public:
  EchoSequence(const EchoInputs& inputs, const Executor& executor)
      : sequence_(open_kitti_sequence(resolve_cloud_input(inputs.sequence))),
        scans_(chosen_scans(inputs.scans, sequence_.scans.size(), sequence_.folder)),
        motion_(inputs.motion.empty() ? sequence_.trajectory : load_trajectory(inputs.motion)) {
    verify_poses(sequence_, executor);
    sequence_.beams = recognize_beams(sequence_, executor);
    if (has_empty_beams()) {
      set_raw_motions(sequence_.beams, sequence_.trajectory, motion_);
    } else if (!inputs.motion.empty()) {
      require_raw("`motion`");
    }
  }

  /// Applies the model's calibration (calibrate_held_out).
  void correct(const ModelScene& scene, bool own_motion, ProgressSink& progress) {
    calibrate_held_out(scene, sequence_, progress);
    if (own_motion) motion_ = sequence_.trajectory;
  }

  /// Motion compensation moves points off the grid of beams.
  bool has_empty_beams() const {
    return sequence_.beams.from_hdl64 && sequence_.beams.sweeps_m.empty();
  }
  void require_raw(const std::string& what) const {
    if (has_empty_beams()) return;
    throw Error(ErrorKind::usage,
                what + " needs raw scans of an HDL-64E; those of " + sequence_.folder.string() +
                    " are " +
                    (sequence_.beams.from_hdl64 ? "motion-compensated" : "of another sensor"));
  }

  const KittiSequence& sequence() const { return sequence_; }
  const std::vector<std::size_t>& scans() const { return scans_; }

  BeamEchoes beams(ModelScene& scene, const std::string& sensor_name, Session& session) const {
    const LidarModel sensor = load_lidar_model(sensor_name);
    const std::vector<ScanMotion> motions =
        moving_scans(sequence_.trajectory, motion_, 1 / sensor.rotation_hz);
    return collect_beam_echoes(echo_scene(scene), sequence_, scans_, sensor, motions,
                               session.executor, session.progress);
  }

  static EchoScene echo_scene(ModelScene& scene) {
    return {scene.tracer(), scene.attributes(), scene.origin()};
  }

 private:
  KittiSequence sequence_;
  std::vector<std::size_t> scans_;
  Trajectory motion_;
};

nlohmann::ordered_json to_json(const DropAccuracy& drop) {
  return {{"f1", finite_or_null(drop.f1())},
          {"precision", finite_or_null(drop.precision())},
          {"recall", finite_or_null(drop.recall())},
          {"beams", drop.beams},
          {"empty", drop.empty}};
}

}  // namespace

EchoResult evaluate_echoes(const EchoInputs& inputs, const std::filesystem::path& drop,
                           Session& session) {
  require_input(inputs.model);
  std::optional<RayDropModel> drop_model;
  if (!drop.empty()) drop_model = load_ray_drop(drop);
  EchoSequence measured(inputs, session.executor);
  if (drop_model) measured.require_raw("`drop`");
  if (inputs.sensor_is_asked) measured.require_raw("`sensor`");
  ModelScene scene(inputs.model, "", session);
  measured.correct(scene, inputs.motion.empty(), session.progress);
  EchoResult result;
  result.intensity = intensity_accuracy(EchoSequence::echo_scene(scene), measured.sequence(),
                                        measured.scans(), session.executor, session.progress);
  if (!measured.has_empty_beams()) return result;
  const BeamEchoes beams = measured.beams(scene, inputs.sensor, session);
  result.misses = drop_accuracy(beams, nullptr);
  if (!drop_model) return result;
  result.drop = drop_accuracy(beams, &*drop_model);
  result.unblocked = drop_accuracy(beams, &*drop_model, false);
  return result;
}

FitDropResult fit_drop(const EchoInputs& inputs, Session& session) {
  require_input(inputs.model);
  EchoSequence measured(inputs, session.executor);
  measured.require_raw("fit-drop");
  ModelScene scene(inputs.model, "", session);
  measured.correct(scene, inputs.motion.empty(), session.progress);
  const BeamEchoes beams = measured.beams(scene, inputs.sensor, session);
  FitDropResult result;
  result.model = fit_ray_drop(beams);
  result.model.fitted_to = inputs.sensor + ", " + std::to_string(measured.scans().size()) +
                           " scans of " + inputs.sequence.filename().string();
  result.scans = measured.scans().size();
  result.misses = drop_accuracy(beams, nullptr);
  result.drop = drop_accuracy(beams, &result.model);
  return result;
}

nlohmann::ordered_json to_json(const EchoResult& result) {
  nlohmann::ordered_json json;
  json["intensity"] = {{"rank_correlation", finite_or_null(result.intensity.rank_correlation)},
                       {"mae", result.intensity.mae},
                       {"rays", result.intensity.rays}};
  if (result.drop) json["drop"] = to_json(*result.drop);
  if (result.unblocked) json["drop_unblocked"] = to_json(*result.unblocked);
  if (result.misses) json["drop_misses_alone"] = to_json(*result.misses);
  return json;
}

nlohmann::ordered_json to_json(const FitDropResult& result) {
  nlohmann::ordered_json json;
  json["scans"] = result.scans;
  json["blocked_sectors"] = result.model.blocked.size();
  json["weights"] = result.model.weights;
  json["drop"] = to_json(result.drop);
  json["drop_misses_alone"] = to_json(result.misses);
  return json;
}

}  // namespace adasplats
