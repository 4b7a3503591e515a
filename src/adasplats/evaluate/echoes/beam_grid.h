// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// The beams that a rotating sensor fired during one measured scan, including those without return,
/// which point files leave out. Ring by ring, by column; all arrays have the same size.
struct BeamGrid {
  /// Sensor frame. Columns count clockwise seen from above, from the rear; times are shares of the
  /// revolution (ScanBeams' rule) over the sensor's rotation rate.
  std::vector<Firing> beams;
  std::vector<float> ranges_m;     ///< from the beam's origin; NaN: no return
  std::vector<float> intensities;  ///< NaN: no return
  std::size_t columns = 0;         ///< firings per laser
  std::size_t points = 0;          ///< points of the scan in the grid
  std::size_t doubled = 0;         ///< points left out: the cell had a point
  std::size_t outside = 0;         ///< points left out: not on a beam's cone or not on a firing

  std::size_t size() const { return beams.size(); }
  bool returned(std::size_t i) const { return ranges_m[i] == ranges_m[i]; }
  std::size_t empty() const { return size() - points; }
};

/// Finds the grid of firings that the points of `scan` are on. Uses the elevations of the beams,
/// their heights and the rotation rate of `sensor`. The encoder reports multiples of 0.09 degrees
/// when a laser fires (HDL-64E S2 user's manual, "angular resolution (azimuth)"), so the azimuths
/// of a ring form a lattice; its phase and the lateral offset of the laser from the axis are
/// estimated from the points. All lasers fire in the same rhythm (one or two steps apart, depending
/// on the sensor's clock), so after the rings are rotated onto each other, a firing is where any
/// ring has a point. Only for raw scans: motion compensation distorts the lattice. Rings with fewer
/// than 100 points are left out, because the directions of their beams are unknown. Errors: usage
/// (no elevations), data (fewer than 8 rings on such a lattice).
BeamGrid find_beam_grid(const KittiScan& scan, const LidarModel& sensor);

}  // namespace adasplats
