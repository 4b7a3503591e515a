// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adasplats/cloud/beams/scan_rings.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// When a beam counts as one that was fired and returned nothing.
struct EmptyBeamOptions {
  ScanRingOptions rings;
  /// Of the gaps between neighbours of a ring those from 0.7 to 1.4 of their median: a scan below
  /// was thinned or put together from several. Of points that were kept at random with probability
  /// p, that is p at most: where it passes, 3 x 3 cells are empty by chance once in 50,000. KITTI's
  /// HDL-64E has 0.83, PandaSet's Pandar64 0.95.
  double min_regular = 0.7;
  std::size_t min_ring_points = 20;  ///< of a ring in a scan, to estimate its elevation there
  /// Azimuth to the point that gives a beam's origin, and how far the sensor may have moved between
  /// the points on both sides: either must hold, of points of its own ring both.
  double max_away_rad = 10 * kDegree;
  double max_moved_m = 0.1;
  /// z of the direction: lower beams may have met wet road, black paint or what is too far away.
  double min_up = 0.05;
  bool lost = false;  ///< also find all other beams without return (EmptyBeam::lost)
};

/// Finds the beams of a spinning sensor that returned nothing; files leave them out. Each is
/// evidence that the space along it is free, the sky above roof edges and tree crowns above all.
/// Rings: find_scan_rings(). In each the points are one step of azimuth apart (the median gap, the
/// same in all rings of a scan), and where there is none within 0.75 steps of a firing, that firing
/// returned nothing. Of these only what is sky rather than a dropout is kept: beams that go upwards
/// in the world (by 3 degrees), in connected regions of (ring, column) that hold three by three
/// empty cells. No evidence is: what lies beyond the field of view (azimuths without points in all
/// scans), a column without any point if some of its beams go down (they would have met the ground:
/// the column was not measured), rings that never have points, beams far from any point that could
/// give their origin. Call it before points are removed: where one was, its beam did return. Glass
/// and distant objects return nothing either. By scans; empty if the rings or the steps cannot be
/// determined. Time: a sort by scans and a few passes over the points.
///
/// Lost beams are those between neighbouring returns of a ring, as many as the gap has steps; it
/// may be at most twice `max_away_rad`. Left out are sectors of a degree of a ring in which most
/// beams are lost in three quarters of the scans: the vehicle blocks them. That needs three scans,
/// from places that are 6 m apart.
std::vector<EmptyBeam> find_empty_beams(const PointCloud& cloud, const EmptyBeamOptions& options,
                                        const Executor& executor);

}  // namespace adasplats
