// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/cloud/load/cloud_part.h"

namespace adasplats {

/// What place_by_times() did.
struct PlacedByTimes {
  TimedOrigins origins;
  std::vector<std::uint8_t> parts;  ///< 1 for those whose points have origins of it
  Trajectory scan_poses;            ///< of the scans that it cut these points into
};

/// Gives files of points with times, where they have no sensor positions, those of the trajectory
/// of `options` at these times (CloudPart::world_sensors), and numbers of scans behind those of
/// sequences. Nothing is done where the trajectory has no times or all points have the same one (a
/// LAS without has zeros). Which clocks they are of is found: what covers all times, and where that
/// is several, what the points' own sweeps say (SweepView); who has `time_offset_s` states it.
/// Errors: data, with figures, for times that the trajectory does not cover but for the distance
/// of its poses, for those in its gaps, for clocks that are not clear, and for a trajectory that
/// the points do not fit (but for `trust_origins`).
std::optional<PlacedByTimes> place_by_times(std::span<CloudPart> parts, const LoadOptions& options,
                                            const Executor& executor, ProgressSink& progress);

/// Takes the poses of all scans by their numbers: those of sequences, then those of points with
/// times. None where points of one input have none.
Trajectory scan_poses_of(std::span<CloudPart> parts, const std::optional<PlacedByTimes>& placed);

/// Errors: usage for a mount or a time offset that nothing takes.
void require_used(const LoadOptions& options, bool takes_mount, bool takes_offset);

}  // namespace adasplats
