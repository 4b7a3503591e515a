// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/sequence/calibration.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Options of the mount search. A rotation is measured by the displacement it causes at `range_m`.
struct MountOptions {
  double range_m = 20;
  /// Planes are searched in windows of neighbouring scans. A window is so short that a mount error
  /// of `first_error_rad` (plus the lever arm error that equals it at 6 m) displaces its scans by
  /// at most `capture_m` relative to each other. The assumed error is halved until one window
  /// covers the whole drive.
  double first_error_rad = 0.13, capture_m = 0.3;
  double arm_of_error_m = 6;
  std::size_t points_a_scan = 3000;  ///< used by the search, on average; the refinement uses all
  int refining_rounds = 4;
  double first_flatness_m = 0.25, last_flatness_m = 0.05;
  double first_width_m = 0.15, last_width_m = 0.03;
  double max_weight = 200;       ///< of a plane, in points
  std::size_t max_points = 400;  ///< used per plane
  /// A direction is not observed if the planes constrain it with less than this share of their
  /// weight, or if its standard deviation exceeds this limit.
  double min_share = 0.002, max_sd_m = 0.02;
  /// Nothing is estimated from fewer scans: the standard deviations of six unknowns are estimated
  /// from the disagreement of at least twice as many parts of the drive.
  std::size_t min_planes = 100, min_scans = 12;
  /// Smaller errors are left to the corrections of single poses: half of the errors that these
  /// still find. A correction must also exceed this multiple of its standard deviation.
  double min_rotation_rad = 0.0044, min_shift_m = 0.1, min_deviations = 5;
  /// The residual of held-out points must fall below this share.
  double min_gain = 0.9;
};

/// A direction in the space of mount errors, along the axes of the given sensor frame: a rotation
/// (by its displacement at MountOptions::range_m) and a shift, together of length 1.
struct MountDirection {
  std::string name;  ///< main component, such as "yaw" or "lever arm along z"
  Vec3d turning, shifting;
};

struct MountEstimate {
  MountCorrection mount;                     ///< zero along `not_observed`
  Vec3d rotation_sd_rad, shift_sd_m;         ///< of the observed part
  std::vector<MountDirection> not_observed;  ///< left as given
  /// Largest ratio of correction to standard deviation over the observed directions.
  double deviations = 0;
  std::size_t planes = 0;  ///< used for the estimate
};

/// Points for estimate_mount().
struct MountPoints {
  std::vector<Vec3d> in_sensor;      ///< in the frame of the scan's given pose
  std::vector<std::uint32_t> scans;  ///< ascending
};

/// Finds a large mount error: the windows of scans grow as the estimate improves. `poses`: given
/// poses of the scans. Standard deviations come from the disagreement between parts of the drive,
/// so they include the effect of pose errors.
MountEstimate search_mount(const MountPoints& points, std::span<const TimedPose> poses,
                           const MountOptions& options, const Executor& executor);

/// Refines a good estimate. The result is zero along the directions that `start` or these points do
/// not observe.
MountEstimate refine_mount(const MountPoints& points, std::span<const TimedPose> poses,
                           const MountEstimate& start, const MountOptions& options,
                           const Executor& executor);

}  // namespace adasplats
