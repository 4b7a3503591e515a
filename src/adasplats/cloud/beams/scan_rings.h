// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// When the points of a scan are taken for the rings of a sensor that turns.
struct ScanRingOptions {
  std::size_t min_points = 2000;  ///< of a scan; fewer say too little
  std::size_t min_rings = 8;      ///< of the sensor; fewer fit too much
  /// Of a scan's points those nearer to a ring than an eighth of the gap to the next one, where
  /// rings are found from directions alone; 0.25 by chance.
  double min_near = 0.8;
  double min_scans = 0.5;     ///< of the recording, on the rings; else there are none
  double most_unknown = 0.2;  ///< of a scan's points, without a laser though others have one
};

/// What the points of a scan say of the elevation of one ring.
struct RingSum {
  double elevations_rad = 0;  ///< added up, above the plane across the scan's axis
  std::size_t points = 0;

  double mean_rad() const { return elevations_rad / static_cast<double>(points); }
};

/// The points of one scan by the ring that measured them.
struct ScanRings {
  std::uint32_t scan = 0;
  Mat3d world_from_sensor;            ///< z is the axis that the sensor turned about
  std::vector<std::uint32_t> points;  ///< of the cloud, with known beams, ascending
  std::vector<std::uint16_t> rings;   ///< of each of them
  std::vector<RingSum> sums;          ///< by ring, as many as the recording has
};

struct RecordingRings {
  std::vector<double> elevations_rad;  ///< of the rings, mean of all points; NaN: without points
  std::vector<ScanRings> scans;        ///< by their numbers; those that are on the rings
};

/// The direction in which the beam of a point left its sensor, unit, world axes. Zero where the
/// point is where the sensor is.
Vec3d beam_direction(const PointCloud& cloud, std::size_t i);

/// How points lie on rings about the z axis, as seen from the origin.
struct RingPattern {
  std::size_t rings = 0;  ///< peaks of the histogram of elevations
  double near = 0;        ///< share of the points near a ring (ScanRingOptions::min_near)
  /// Share of the elevations, in steps of a degree, whose ranges differ by more than a tenth.
  double uneven = 0;
  double along = 0;  ///< share of the points whose nearest neighbour is at about their elevation
  /// How much farther the nearest neighbour above or below is than the one at the same elevation,
  /// median.
  double anisotropy = 0;
  /// Share of the points whose nearest neighbour at the same elevation is at the usual step of
  /// azimuth.
  double even = 0;
};

/// `points`: finite, none at the origin.
RingPattern ring_pattern(std::span<const Vec3d> points);

/// Finds the axis that the sensor turned about in every scan and the ring of every point. With
/// lasers and scan poses these say it (the sensor's z is its axis). Without, from directions alone:
/// - Neighbours of a ring are nearer than the next ring, so the way from a direction to its nearest
///   one is across the axis: the least eigenvector of all ways, reweighted (Cauchy), is the axis.
/// - Rings are peaks of the histogram of elevations about it, and the points of a ring lie in one
///   plane across the axis, which makes the axis exact.
/// The poses' axis and the world's vertical are tried where that fails. Nothing is found (no scans)
/// where points do not lie on rings, and without scan numbers or known beams. Time: a sort by scans
/// and a few passes over the points.
RecordingRings find_scan_rings(const PointCloud& cloud, const ScanRingOptions& options,
                               const Executor& executor);

}  // namespace adasplats
