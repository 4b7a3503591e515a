// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// The beams that a rotating sensor fired during one measured scan, also those that found nothing:
/// files of points leave them out. Ring by ring, by column; all arrays have the same size.
struct BeamGrid {
  /// Sensor frame. Columns count clockwise seen from above, from the rear; times are shares of the
  /// revolution (ScanBeams' rule) over the sensor's rotation rate.
  std::vector<Firing> beams;
  std::vector<float> ranges_m;     ///< from the beam's origin; NaN: nothing came back
  std::vector<float> intensities;  ///< NaN likewise
  std::size_t columns = 0;         ///< firings a laser
  std::size_t points = 0;          ///< of the scan that are in the grid
  std::size_t doubled = 0;         ///< points left out: another one had the place
  std::size_t outside = 0;         ///< points left out: on no beam's cone or on no firing

  std::size_t size() const { return beams.size(); }
  bool returned(std::size_t i) const { return ranges_m[i] == ranges_m[i]; }
  std::size_t empty() const { return size() - points; }
};

/// Finds the grid of firings that the points of `scan` lie on. Takes from `sensor` the elevations
/// of the beams, the heights that they leave at and the rotation rate. What the encoder said when
/// a laser fired is a multiple of 0.09 degrees (HDL-64E S2 user's manual, "angular resolution
/// (azimuth)"), so that the azimuths of a ring lie on a lattice; where on it and how far beside the
/// axis its laser sits is found from the points. All lasers fire in one rhythm (one or two steps
/// apart, up to the sensor's clock), so a firing is where any ring has a point once the rings are
/// turned onto each other.
/// For points as they were measured: motion compensation bends the lattice. Rings with fewer than
/// 100 points are left out: nothing says where their beams went. Errors: usage (no elevations),
/// data (fewer than 8 rings on such a lattice).
BeamGrid find_beam_grid(const KittiScan& scan, const LidarModel& sensor);

}  // namespace adasplats
