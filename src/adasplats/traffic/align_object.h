// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/executor.h"
#include "adasplats/traffic/recorded_object.h"

namespace adasplats {

/// The scans of rigid objects are registered to each other: boxes are off by some centimetres.
struct AlignOptions {
  int rounds = 6;
  std::size_t min_points = 30;  ///< scans with fewer are not moved
  double reach_m = 0.3;         ///< to corresponding points of other scans
  double error_m = 0.05;        ///< scale of the robust error
  /// Standard deviations of the boxes: prior of the corrections.
  double box_m = 0.3;
  double box_rad = 0.05;
};

struct AlignReport {
  std::size_t scans = 0;       ///< that were moved
  double median_shift_m = 0;   ///< of these
  double median_turn_rad = 0;  ///< absolute
};

/// Moves every scan of a rigid object by a shift and a turn about z to where its points fit those
/// of the other scans best: point to plane, with weights that decrease with distance
/// (Geman-McClure). The poses of `world_from_object` change with them: one at each moved scan, and
/// the corrected first and last one. Points stay where they were in the world at the time of their
/// scan. The same bytes for any number of threads.
AlignReport align_scans(RecordedObject& object, const AlignOptions& options,
                        const Executor& executor);

}  // namespace adasplats
