// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// How scans that are as they were measured lie on each other's walls.
struct SweepEvidence {
  std::size_t points = 0;  ///< on walls, of the later scans of the pairs
  double still_m = 0;  ///< median distance from the earlier scan's walls, were the sensor at rest
  double moved_m = 0;  ///< with the motion during each revolution taken out
  double reversed_m = 0;  ///< with its reverse

  /// Whether the motion is seen to be the right one. Poses of another place on the vehicle can make
  /// it seem so, too, but not bring walls onto each other.
  bool confirms() const;
  /// Whether the sensor is seen to have been at rest during each revolution, as simulated ones can.
  bool at_rest() const;
};

/// Judges the motions (ScanBeams::raw_motions) of up to four pairs of scans 3 to 15 m apart. Walls
/// are cubes of half a metre in which points lie on an upright plane: a motion along the road moves
/// those that it passes at another angle than before. No pairs, no walls: no points.
SweepEvidence weigh_sweeps(const KittiSequence& sequence, const ScanBeams& beams,
                           const Executor& executor);

}  // namespace adasplats
