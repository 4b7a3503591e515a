// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/cloud/load/cloud_part.h"

namespace adasplats {

/// The result of place_by_times().
struct PlacedByTimes {
  TimedOrigins origins;
  std::vector<std::uint8_t> parts;  ///< 1 for parts with origins from it
  Trajectory scan_poses;            ///< of the scans that it cut the points into
};

/// Gives points with times but without sensor positions the positions of the trajectory of
/// `options` at these times (CloudPart::world_sensors), and scan numbers after those of sequences.
/// Does nothing if the trajectory has no times or all points have the same one (a LAS without times
/// has zeros). The clocks are inferred: those that cover all times, and of several the one that the
/// sweeps fit best (SweepView); `time_offset_s` overrides this. Errors: data, with figures, for
/// times outside the trajectory (beyond one pose step) or in its gaps, for ambiguous clocks, and
/// for a trajectory that does not fit the points (unless `trust_origins`).
std::optional<PlacedByTimes> place_by_times(std::span<CloudPart> parts, const LoadOptions& options,
                                            const Executor& executor, ProgressSink& progress);

/// Moves the poses of all scans out of the parts, by number: those of sequences, then those of
/// points with times. Empty if an input with points has none.
Trajectory scan_poses_of(std::span<CloudPart> parts, const std::optional<PlacedByTimes>& placed);

/// Errors: usage for a mount or a time offset that no input uses.
void require_options_used(const LoadOptions& options, bool uses_mount, bool uses_offset);

}  // namespace adasplats
