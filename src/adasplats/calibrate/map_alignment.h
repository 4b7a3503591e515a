// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/sequence/calibration.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// Errors of mount and clock that align_with_map() finds, and how it finds them.
struct MapAlignmentOptions {
  double rotation_rad = 0.0873, shift_m = 0.5, clock_s = 0.05;  ///< largest expected errors
  std::size_t points = 20'000;                                  ///< used, of all scans
  double range_m = 0.1;  ///< largest expected common range offset; 0: none is estimated
  double near_m = 0.2;   ///< distance from a surface up to which a point counts as near
};

struct MapAlignment {
  MountCorrection mount;  ///< of the sensor, from the given one
  double clock_s = 0;     ///< to add to the times of its scans
  double range_m = 0;     ///< to add to all ranges
  /// Share of the points that are near surfaces of the map, of those in cells around it: with the
  /// given mount and clock, and with the found ones.
  double given_share = 0, share = 0;
  // Standard deviations, of refine_alignment(): the spread of estimates without one fifth of the
  // drive each, and the expected errors times the share that the surfaces leave to these.
  Vec3d rotation_sd_rad, shift_sd_m;  ///< about and along the axes of the sensor
  double clock_sd_s = 0;

  /// What the surfaces do not determine; it stays near the given values.
  std::vector<std::string> not_observed() const;

  /// Whether half of the points are near surfaces, by corrections up to twice the expected errors.
  bool fits(const MapAlignmentOptions& expected) const;
};

/// Finds the mount and the clock of a sensor whose scans see the surfaces of a map: point-to-plane
/// alignment of all scans at once with eight unknowns, from coarse cells to fine ones and from
/// several initial rotations. The clock and the directions that the surfaces do not constrain stay
/// near the given values (priors with the expected errors as standard deviations).
MapAlignment align_with_map(const PointCloud& sensor, const PointCloud& map,
                            const MapAlignmentOptions& options, const Executor& executor);

/// The same from a good estimate, with more points and with standard deviations: for a sensor whose
/// lasers are calibrated.
MapAlignment refine_alignment(const PointCloud& sensor, const PointCloud& map,
                              const MapAlignment& start, const MapAlignmentOptions& options,
                              const Executor& executor);

/// Moves the points and poses of a sensor to another mount and clock, and changes its ranges. Each
/// point has the pose of its own firing: the sensor moves on as between its scans.
void apply(const MapAlignment& alignment, PointCloud& sensor);

/// The mount of a sensor in the frame of another one, from their poses (at least one) at the same
/// times: robust over all of them.
RigidTransform mount_between(const Trajectory& first, const Trajectory& second);

}  // namespace adasplats
