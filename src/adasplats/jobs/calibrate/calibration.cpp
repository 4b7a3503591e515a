// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/calibrate/calibration.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/yaw_pitch_roll.h"
#include "adasplats/gpu/base/engines.h"

namespace adasplats {

CalibrateCloud calibrate_on(Session& session) {
  return [&session](const PointCloud& cloud, const CalibrateOptions& options) {
    std::pair<Calibration, CalibrationReport> result;
    const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
      const auto steps = make_cuda_calibration_steps(session.device.gpu_numbers().front());
      result = calibrate(cloud, options, *steps, session.executor);
    });
    return on_gpu ? result : calibrate(cloud, options, session.executor);
  };
}

namespace {

using MountJson = nlohmann::ordered_json;

MountJson mount_json(const MountReport& report) {
  const MountEstimate& found = report.found;
  MountJson json;
  json["applied"] = report.objection.empty();
  if (!report.objection.empty()) json["objection"] = report.objection;
  if (!report.alone_because.empty()) json["alone_because"] = report.alone_because;
  if (found.planes == 0) return json;
  json["planes"] = found.planes;
  const Vec3d turn_deg = yaw_pitch_roll_deg(found.mount.given_from_mounted().rotation);
  json["yaw_pitch_roll_deg"] = {turn_deg.x, turn_deg.y, turn_deg.z};
  const Vec3d shift = found.mount.shift_m, turn_sd = found.rotation_sd_rad;
  json["shift_m"] = {shift.x, shift.y, shift.z};
  json["yaw_pitch_roll_sd_deg"] = {turn_sd.z / kDegree, turn_sd.y / kDegree, turn_sd.x / kDegree};
  json["shift_sd_m"] = {found.shift_sd_m.x, found.shift_sd_m.y, found.shift_sd_m.z};
  json["not_observed"] = MountJson::array();
  for (const MountDirection& out : found.not_observed)
    json["not_observed"].push_back(
        {{"name", out.name},
         {"turning", {out.turning.x, out.turning.y, out.turning.z}},
         {"shifting", {out.shifting.x, out.shifting.y, out.shifting.z}}});
  if (report.given_m > 0) {
    json["residual_given_m"] = report.given_m;
    json["residual_mounted_m"] = report.mounted_m;
  }
  return json;
}

MountJson disagreement_json(const PoseDisagreement& apart) {
  return {{"scans", apart.scans},
          {"median_shift_m", apart.median_shift_m},
          {"largest_shift_m", apart.largest_shift_m},
          {"median_rotation_rad", apart.median_rotation_rad},
          {"largest_rotation_rad", apart.largest_rotation_rad}};
}

MountJson window_json(const WindowReport& window) {
  MountJson json = {{"drive", window.drive},
                    {"scans", {window.begin, window.end}},
                    {"applied", window.objection.empty()}};
  if (!window.objection.empty()) json["objection"] = window.objection;
  json["planes"] = window.planes;
  json["residual_given_m"] = window.given_m;
  json["residual_common_m"] = window.common_m;
  json["residual_calibrated_m"] = window.calibrated_m;
  json["weakest_share"] = window.weakest_share;
  json["tells_lasers"] = window.constrains_lasers;
  if (window.overlap.scans > 0) json["overlap"] = disagreement_json(window.overlap);
  return json;
}

MountJson windows_json(const WindowsReport& report) {
  MountJson json = {{"count", report.windows.size()},
                    {"window_scans", report.window_scans},
                    {"without_evidence", report.without_evidence()},
                    {"overlaps", disagreement_json(report.overlaps)},
                    {"laser_windows", report.laser_windows},
                    {"range_disagreement_m", report.range_disagreement_m},
                    {"elevation_disagreement_rad", report.elevation_disagreement_rad},
                    {"mount_windows", report.mount_windows}};
  if (report.mount_windows > 0) {
    json["mount_disagreement_rad"] = report.mount_disagreement_rad;
    json["mount_disagreement_m"] = report.mount_disagreement_m;
  }
  json["not_done"] = kNotClosed;
  json["each"] = MountJson::array();
  for (const WindowReport& window : report.windows) json["each"].push_back(window_json(window));
  return json;
}

}  // namespace

nlohmann::ordered_json calibration_json(const CalibrationReport& report,
                                        const Calibration& calibration) {
  const CalibrationSizes sizes = sizes_of(calibration);
  nlohmann::ordered_json json;
  json["applied"] = !calibration.empty();
  if (!report.objection.empty()) json["objection"] = report.objection;
  json["planes"] = report.planes;
  json["residual_given_m"] = report.given_m;
  json["residual_calibrated_m"] = report.calibrated_m;
  json["weakest_share"] = report.weakest_share;
  json["largest_rotation_rad"] = sizes.largest_rotation_rad;
  json["largest_shift_m"] = sizes.largest_shift_m;
  json["smooth_s"] = calibration.smooth_s;
  json["range_offset_rms_m"] = sizes.range_rms_m;
  json["elevation_offset_rms_rad"] = sizes.elevation_rms_rad;
  if (report.mount) json["mount"] = mount_json(*report.mount);
  if (report.windows) json["windows"] = windows_json(*report.windows);
  return json;
}

}  // namespace adasplats
