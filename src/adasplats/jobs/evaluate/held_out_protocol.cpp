// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/held_out_protocol.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/core/constants.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

/// Null of what is not known or infinite.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json error_json(const ImageError& error) {
  return {{"rmse", error.rmse},
          {"medae", error.medae},
          {"ssim", finite(error.ssim)},
          {"psnr_db", finite(error.psnr_db)}};
}

Json layout_json(const PanoramaLayout& layout) {
  return {{"rows", layout.rows},
          {"columns", layout.columns},
          {"top_deg", layout.top_rad / kDegree},
          {"span_deg", layout.span_rad / kDegree},
          {"max_range_m", layout.max_range_m}};
}

}  // namespace

std::optional<std::size_t> scans_of_model(const ModelScene& scene, const KittiSequence& given) {
  const SplatModel* model = scene.splats();
  if (model == nullptr || model->calibration.poses.empty()) return {};
  // Both come from one file; models keep times and positions as text.
  constexpr double kSameTime_s = 1e-4, kSamePlace_m = 1e-3;
  const auto is_of_model = [&](const TimedPose& pose) {
    return std::ranges::any_of(model->calibration.poses, [&](const PoseCorrection& of_model) {
      return std::fabs(of_model.time_s - pose.time_s) < kSameTime_s &&
             length(of_model.position - pose.world_from_sensor.translation) < kSamePlace_m;
    });
  };
  return static_cast<std::size_t>(std::ranges::count_if(given.trajectory, is_of_model));
}

Lidar4dEvaluation evaluate_lidar4d(const ModelScene& scene, const KittiSequence& sequence,
                                   std::optional<std::size_t> of_model, Session& session) {
  if (of_model.value_or(0) > 0)
    session.progress.warn("the model was made of " + std::to_string(*of_model) + " of the " +
                          std::to_string(sequence.scans.size()) +
                          " scans that it is compared with: not a held-out figure");
  Lidar4dEvaluation result{evaluate_lidar4d(scene.tracer(), scene.attributes(), scene.origin(),
                                            sequence, session.executor, session.progress),
                           of_model};
  return result;
}

Json to_json(const Lidar4dEvaluation& result) {
  Json json = {{"protocol", "LiDAR4D (CVPR 2024)"},
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
                {{"chamfer_m2", finite(result.chamfer_m2)},
                 {"f_score", finite(result.f_score_224mm)},
                 {"f_score_5cm", finite(result.f_score_5cm)}}}};
  if (result.scans_of_model) json["scans_of_model"] = *result.scans_of_model;
  if (result.intensity) {
    json["intensity"] = error_json(*result.intensity);
    json["intensity_scale"] = result.intensity_scale;
  }
  return json;
}

}  // namespace adasplats
