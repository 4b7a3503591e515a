// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/calibration_text.h"

#include <algorithm>
#include <string>
#include <vector>

#include "adasplats/core/constants.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

/// "Mount corrected by 5.00 deg and 50.0 cm; not observed and left as given: yaw (about z)"
std::string mount_text(const MountEstimate& found) {
  std::string text = "Mount corrected by " + fixed(length(found.mount.rotation_rad) / kDegree, 2) +
                     " deg and " + centimetres(length(found.mount.shift_m));
  const std::string not_observed = not_observed_text(found);
  return not_observed.empty() ? text : text + "; not observed and unchanged: " + not_observed;
}

/// The corrections of single poses and lasers.
std::string rest_text(const CalibrationReport& report, const Calibration& calibration) {
  const CalibrationSizes sizes = sizes_of(calibration);
  std::string text = "Calibrated by " + grouped(report.planes) + " planes: poses by up to " +
                     centimetres(sizes.largest_shift_m) + " and " +
                     fixed(sizes.largest_rotation_rad / kDegree, 2) + " deg";
  if (!calibration.lasers.empty())
    text += ", lasers by " + centimetres(sizes.range_rms_m) + " and " +
            fixed(sizes.elevation_rms_rad / kDegree, 3) + " deg (RMS)";
  return text;
}

/// "12 windows of up to 200 scans; ..." and the windows without evidence, one per line.
std::string windows_text(const WindowsReport& report) {
  const PoseDisagreement& apart = report.overlaps;
  std::string text =
      grouped(report.windows.size()) + " windows of up to " + grouped(report.window_scans) +
      " scans; poses of overlapping windows differ by " + centimetres(apart.median_shift_m) +
      " and " + fixed(apart.median_rotation_rad / kDegree, 3) + " deg (median), " +
      centimetres(apart.largest_shift_m) + " and " +
      fixed(apart.largest_rotation_rad / kDegree, 3) + " deg (largest)";
  if (report.laser_windows > 0)
    text += "; lasers of " + grouped(report.laser_windows) + " windows differ by " +
            centimetres(report.range_disagreement_m) + " and " +
            fixed(report.elevation_disagreement_rad / kDegree, 3) + " deg from their mean (RMS)";
  text += "; " + std::string(kNotClosed) + "\n";
  for (const WindowReport& window : report.windows)
    if (!window.objection.empty())
      text += "Scans " + grouped(window.begin) + " to " + grouped(window.end - 1) +
              (window.drive > 0 ? " of drive " + grouped(window.drive) : std::string()) +
              ", not calibrated by themselves: " + window.objection + "\n";
  return text;
}

}  // namespace

std::string not_observed_text(const MountEstimate& found) {
  std::string text;
  for (const MountDirection& direction : found.not_observed)
    text += (text.empty() ? "" : ", ") + direction.name;
  return text;
}

namespace {

/// Of one sensor of a rig but the first.
std::string sensor_text(const CalibrationReport& report) {
  const MapAlignment& aligned = *report.aligned;
  const auto largest = [](Vec3d v) { return std::max({v.x, v.y, v.z}); };
  std::string text = report.sensor + ": mount turned by " +
                     fixed(length(aligned.mount.rotation_rad) / kDegree, 3) + " deg (sd " +
                     fixed(largest(aligned.rotation_sd_rad) / kDegree, 3) + ") and shifted by " +
                     centimetres(length(aligned.mount.shift_m)) + " (sd " +
                     centimetres(largest(aligned.shift_sd_m)) + "), clock " +
                     fixed(1e3 * aligned.clock_s, 1) + " ms (sd " +
                     fixed(1e3 * aligned.clock_sd_s, 1) + "); " + fixed(100 * aligned.share, 1) +
                     " % of its points are near surfaces of the sensors before it (" +
                     fixed(100 * aligned.given_share, 1) + " % as given)";
  const std::vector<std::string> not_observed = aligned.not_observed();
  for (const std::string& name : not_observed)
    text += (&name == &not_observed.front() ? "; not observed and unchanged: " : ", ") + name;
  if (!report.objection.empty())
    return text + "; poses and lasers as given: " + report.objection + "\n";
  return text + "; held-out points are " + centimetres(report.calibrated_m) + " from planes (" +
         centimetres(report.given_m) + " before)\n";
}

std::string first_text(const CalibrationReport& report, const Calibration& calibration) {
  const std::string windows = report.windows ? windows_text(*report.windows) : std::string();
  if (!report.objection.empty()) return "Nothing calibrated: " + report.objection + "\n" + windows;
  std::string text;
  const bool is_mounted = report.mount && report.mount->objection.empty();
  if (is_mounted) text = mount_text(report.mount->found) + ". ";
  text += is_mounted && !report.mount->alone_because.empty()
              ? "Nothing else was corrected: " + report.mount->alone_because
              : rest_text(report, calibration);
  return text + "; held-out points are " + centimetres(report.calibrated_m) + " from planes (" +
         centimetres(report.given_m) + " before); the scene as a whole stays at the given poses\n" +
         windows;
}

}  // namespace

std::string calibration_text(const CalibrationReport& report, const Calibration& calibration) {
  std::string text = first_text(report, calibration);
  if (!report.sensor.empty()) text = report.sensor + ": " + text;
  for (const CalibrationReport& other : report.others) text += sensor_text(other);
  return text;
}

}  // namespace adasplats::app
