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

/// How the mount is searched for. A rotation counts as what it moves at `range_m`.
struct MountOptions {
  double range_m = 20;
  /// Planes are looked for in windows of neighbouring scans that a mount so wrong leaves within
  /// `capture_m` of one another, first for `first_error_rad` (and what it is at 6 m as a lever
  /// arm), then for half of it, and so on until a window holds the whole drive.
  double first_error_rad = 0.13, capture_m = 0.3;
  double arm_of_error_m = 6;
  std::size_t points_a_scan = 3000;  ///< that the search takes, in the mean; refining takes all
  int refining_rounds = 4;
  double first_flatness_m = 0.25, last_flatness_m = 0.05;
  double first_width_m = 0.15, last_width_m = 0.03;
  double max_weight = 200;       ///< of a plane, in points
  std::size_t max_points = 400;  ///< of a plane that are looked at
  /// What the planes hold by less than this share of their weight, or to no better than this
  /// standard deviation, is not observed.
  double min_share = 0.002, max_sd_m = 0.02;
  /// With fewer scans nothing is estimated: deviations of six unknowns are told by the disagreement
  /// of twice as many parts or more.
  std::size_t min_planes = 100, min_scans = 12;
  /// What the poses of single scans make up for: half of what they are found from. And how often
  /// its standard deviation a correction has to be.
  double min_rotation_rad = 0.0044, min_shift_m = 0.1, min_deviations = 5;
  /// Share of the residual of points left out that has to be left at most.
  double min_gain = 0.9;
};

/// A direction in which a mount can be wrong: what it moves at MountOptions::range_m by turning and
/// by shifting, together of length 1, along the axes of the sensor as given.
struct MountDirection {
  std::string name;  ///< what it mostly is, as "yaw" or "lever arm along z"
  Vec3d turning, shifting;
};

struct MountEstimate {
  MountCorrection mount;                     ///< nothing along `not_observed`
  Vec3d rotation_sd_rad, shift_sd_m;         ///< of what is observed of it
  std::vector<MountDirection> not_observed;  ///< left as given
  double deviations = 0;                     ///< the most, of an observed direction
  std::size_t planes = 0;                    ///< that tell it
};

/// Points for estimate_mount().
struct MountPoints {
  std::vector<Vec3d> in_sensor;      ///< in the frame of the scan's given pose
  std::vector<std::uint32_t> scans;  ///< ascending
};

/// Finds a mount from far off: windows of scans grow as it gets better. `poses`: of the scans as
/// given. Standard deviations are told from how far parts of the drive disagree, so errors of poses
/// count as what they are.
MountEstimate search_mount(const MountPoints& points, std::span<const TimedPose> poses,
                           const MountOptions& options, const Executor& executor);

/// From nearby: nothing along what `start` does not observe, and what these points do not.
MountEstimate refine_mount(const MountPoints& points, std::span<const TimedPose> poses,
                           const MountEstimate& start, const MountOptions& options,
                           const Executor& executor);

}  // namespace adasplats
