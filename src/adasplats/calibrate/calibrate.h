// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/calibrate/calibration_steps.h"
#include "adasplats/calibrate/map_alignment.h"
#include "adasplats/calibrate/mount.h"
#include "adasplats/calibrate/scan_planes.h"
#include "adasplats/calibrate/windows_report.h"
#include "adasplats/cloud/sequence/calibration.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/setting.h"

namespace adasplats {

struct CalibrateOptions {
  bool poses = true;       ///< one correction a scan
  bool ranges = true;      ///< one offset a laser
  bool elevations = true;  ///< one offset a laser
  /// One correction for all scans, estimated before those of single scans, if it exceeds their
  /// range.
  bool mount_correction = true;
  int rounds = 5;  ///< each finds the planes again...
  int steps = 2;   ///< ...and makes this number of Gauss-Newton steps
  // In the first and in the last round:
  /// Maximum thickness (standard deviation) of a plane.
  double first_flatness_m = 0.25, last_flatness_m = 0.05;
  /// Width of the robust weight of residuals.
  double first_width_m = 0.15, last_width_m = 0.03;
  double max_weight = 200;       ///< of a plane, in points: near ground must not outweigh facades
  std::size_t max_points = 400;  ///< points used per plane
  std::size_t points_a_scan = 40'000;  ///< points used per scan, on average, in...
  int fine_rounds = 2;                 ///< ...the last rounds; the others use one in
  std::size_t coarse_stride = 5;       ///< odd: the points of a laser can be a power of two apart
  double tolerance = 1e-3;             ///< of the conjugate gradients of a step, and...
  int max_iterations = 200;            ///< ...their maximum number of iterations
  /// Trust in the given values: standard deviations of weak priors, relative to residuals of
  /// `residual_sigma_m`. They constrain what the planes do not.
  double residual_sigma_m = 0.02;
  double rotation_sigma_rad = 0.01, translation_sigma_m = 0.3;
  double range_sigma_m = 0.05, elevation_sigma_rad = 0.001;
  double range_share = 0, elevation_share = 0.05;
  /// Nothing is applied if there are fewer planes, if less than this share of their weight
  /// constrains the poses along some direction, or if the residual of held-out points does not fall
  /// below this share.
  /// Scans from this number on are a map: their poses stay, and their points are not held out.
  std::size_t free_scans = std::numeric_limits<std::size_t>::max();
  bool azimuths = false;        ///< one offset a laser, for lasers that are cells of directions
  double range_mean_share = 0;  ///< pulls ranges towards their mean, as range_share towards zero
  std::size_t min_planes = 100;
  double min_share = 0.002, min_gain = 0.98;
  ScanPlaneOptions planes;  ///< except the flatness
  MountOptions mount;
};

/// The settings for users.
template <class Visit>
void visit_settings(CalibrateOptions& calibrate, Visit&& visit) {
  visit(Setting{.name = "poses",
                .help = "Estimate a correction of the pose of every scan",
                .basic = true},
        calibrate.poses);
  visit(Setting{.name = "ranges",
                .help = "Estimate a range offset for every laser of a recognised sensor",
                .basic = true},
        calibrate.ranges);
  visit(Setting{.name = "elevations",
                .help = "Estimate an elevation offset for every laser of a recognised sensor",
                .basic = true},
        calibrate.elevations);
  visit(Setting{.name = "mount_correction",
                .help = "Estimate a correction of the sensor mount (boresight and lever arm), "
                        "common to all scans",
                .basic = true},
        calibrate.mount_correction);
}

/// Histogram of the distances of points from planes.
struct ResidualCounts {
  static constexpr double kBin_m = 0.0025;
  std::array<std::size_t, 41> counts{};  ///< bins from 0 on; the last one has no upper limit
};

/// Result for the mount.
struct MountReport {
  MountEstimate found;
  /// Mean distance (at most 0.25 m) of held-out points from the planes through the others, m, with
  /// the given and with the corrected mount; over the planes of either. 0: no such planes.
  double given_m = 0, mounted_m = 0;
  std::string objection;      ///< why it is not applied; empty if it is
  std::string alone_because;  ///< why only the mount is applied; empty if poses or lasers are, too
};

struct CalibrationReport {
  std::size_t planes = 0;  ///< of the last round
  std::size_t points = 0;  ///< on these planes
  /// Median distance of held-out points from the planes through the others, m; with the given
  /// values and with the calibration.
  double given_m = 0, calibrated_m = 0;
  ResidualCounts given, calibrated;  ///< of the same points
  double weakest_share = 0;          ///< share of the planes' weight along...
  Vec3d weakest;                     ///< ...the direction in which they constrain the poses least
  std::string objection;             ///< why nothing is applied; empty if the evidence is clear
  std::optional<MountReport> mount;  ///< nothing if not requested
  std::optional<WindowsReport> windows;   ///< nothing if all scans were solved at once
  std::string sensor;                     ///< its name in the rig; empty: no rig
  std::optional<MapAlignment> aligned;    ///< mount and clock of a sensor of a rig
  std::vector<CalibrationReport> others;  ///< of the other sensors of the rig
};

/// Estimates the errors of a recording from planes that several of its scans saw. The absolute
/// position of the scene is not observable, so a rigid motion aligns the corrected poses to the
/// given ones. Every eighth point is held out for validation: if the held-out points are not closer
/// to the planes through the others, or nothing can be estimated, the calibration is empty and the
/// report gives the reason.
std::pair<Calibration, CalibrationReport> calibrate(const PointCloud& cloud,
                                                    const CalibrateOptions& options,
                                                    const Executor& executor);

/// The same with the steps of any device; the executor runs the search for the mount, which stays
/// on the CPU.
std::pair<Calibration, CalibrationReport> calibrate(const PointCloud& cloud,
                                                    const CalibrateOptions& options,
                                                    CalibrationSteps& steps,
                                                    const Executor& executor);

}  // namespace adasplats
