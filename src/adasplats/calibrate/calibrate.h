// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "adasplats/calibrate/calibration.h"
#include "adasplats/calibrate/calibration_steps.h"
#include "adasplats/calibrate/mount.h"
#include "adasplats/calibrate/scan_planes.h"
#include "adasplats/calibrate/windows_report.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/setting.h"

namespace adasplats {

struct CalibrateOptions {
  bool poses = true;       ///< one correction a scan
  bool ranges = true;      ///< one offset a laser
  bool elevations = true;  ///< one offset a laser
  /// One correction for all scans, before those of single ones, where it is more than these find.
  bool mount_correction = true;
  int rounds = 5;  ///< planes are found again in each...
  int steps = 2;   ///< ...and so many steps of Gauss-Newton are made
  /// Of the first and of the last round: most thickness of a plane, width of the residuals that
  /// count.
  double first_flatness_m = 0.25, last_flatness_m = 0.05;
  double first_width_m = 0.15, last_width_m = 0.03;
  double max_weight = 200;       ///< of a plane, in points: near ground must not outweigh facades
  std::size_t max_points = 400;  ///< of a plane that are looked at
  std::size_t points_a_scan = 40'000;  ///< that are looked at, in the mean, in...
  int fine_rounds = 2;                 ///< ...the last rounds; in the others, every so many-th:
  std::size_t coarse_stride = 5;       ///< odd, as points of a laser may lie a power of two apart
  double tolerance = 1e-3;             ///< of a step's conjugate gradients, and...
  int max_iterations = 200;            ///< ...their most
  /// How far the given values are believed: standard deviations of weak priors, beside residuals of
  /// `residual_sigma_m`. They hold what the planes do not.
  double residual_sigma_m = 0.02;
  double rotation_sigma_rad = 0.01, translation_sigma_m = 0.3;
  double range_sigma_m = 0.05, elevation_sigma_rad = 0.001;
  double range_share = 0, elevation_share = 0.05;
  /// Nothing is applied where planes are fewer, hold the poses along some direction by less than
  /// this share of their weight, or bring the residual of points left out not below this share.
  std::size_t min_planes = 100;
  double min_share = 0.002, min_gain = 0.98;
  ScanPlaneOptions planes;  ///< but for the flatness
  MountOptions mount;
};

/// What users choose of it.
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

/// How many points lie how far from planes.
struct ResidualCounts {
  static constexpr double kBin_m = 0.0025;
  std::array<std::size_t, 41> counts{};  ///< of bins from 0 on; the last one has all beyond
};

/// What was found of the mount.
struct MountReport {
  MountEstimate found;
  /// Mean distance of points that were left out from the planes of the others, m, as given and with
  /// it: of planes that either has, at most 0.25 m. 0: nothing to compare.
  double given_m = 0, mounted_m = 0;
  std::string objection;      ///< why it is not applied; empty: it is
  std::string alone_because;  ///< why nothing else is applied; empty: single poses or lasers are
};

struct CalibrationReport {
  std::size_t planes = 0;  ///< of the last round
  std::size_t points = 0;  ///< on these
  /// Median distance of points that were left out of the fit from the planes of the others, m; with
  /// the given values and with the calibration.
  double given_m = 0, calibrated_m = 0;
  ResidualCounts given, calibrated;  ///< of the same points
  double weakest_share = 0;          ///< of the planes' weight, along...
  Vec3d weakest;                     ///< ...the direction in which they hold the poses least
  std::string objection;             ///< why nothing is to be applied; empty: the evidence is clear
  std::optional<MountReport> mount;  ///< nothing: it was not asked for
  std::optional<WindowsReport> windows;  ///< nothing: all was solved at once
};

/// Estimates what a recording gets wrong from planes that its scans saw together. The corrected
/// poses are aligned to the given ones as a whole: nothing observes where the place is. Every
/// eighth point is left out of the fit, to judge it: where they do not lie better on the planes of
/// the others, or nothing can be estimated, the calibration is empty and the report says why.
std::pair<Calibration, CalibrationReport> calibrate(const PointCloud& cloud,
                                                    const CalibrateOptions& options,
                                                    const Executor& executor);

/// The same with the steps of some device; the executor does what is left on the CPU: the search
/// for the mount.
std::pair<Calibration, CalibrationReport> calibrate(const PointCloud& cloud,
                                                    const CalibrateOptions& options,
                                                    CalibrationSteps& steps,
                                                    const Executor& executor);

}  // namespace adasplats
