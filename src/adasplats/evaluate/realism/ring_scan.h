// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// The returns of one scan by ring, in the order in which the sensor turned. Derived from the
/// points alone, so measured and simulated scans are treated alike.
struct RingScan {
  std::vector<std::size_t> begins;  ///< first return of each ring, topmost first, and their number
  std::vector<float> azimuths_rad;  ///< clockwise seen from above, from the rear, 0 to 2 pi;
                                    ///< ascending within a ring
  std::vector<float> ranges_m;      ///< from the origin of the beam
  std::vector<float> intensities;   ///< NaN: unknown
  std::vector<Vec3f> directions;    ///< of the beam, unit, sensor's axes
  /// Beams of the same ring without return, between a return and the next: count_missing().
  std::vector<std::uint32_t> missing;

  std::size_t rings() const { return begins.empty() ? 0 : begins.size() - 1; }
  std::size_t size() const { return ranges_m.size(); }
};

/// Arranges a scan of a sequence with a recognised sensor (ScanBeams::sensor): rings are its
/// lasers, and the motion of the sensor is removed from directions of compensated points.
/// `heights_m`: height of each laser above the sensor's origin, one per ring; origins in scans
/// (KittiScan::origins) are those of the sensor, in sequences those of the laser. Points that are
/// not finite, at the origin or of no laser are left out.
RingScan arrange_in_rings(const KittiSequence& sequence, std::size_t index, const KittiScan& scan,
                          std::span<const double> heights_m);

/// Azimuth between a ring's firings: the mean of the gaps between neighbouring returns that are 0.4
/// to 1.4 times the median gap. 0.4, because an encoder reports steps that alternate between one
/// and two of its own (HDL-64E: 0.09 degrees). 0 if it cannot be estimated.
double azimuth_step_rad(const RingScan& scan);

/// Fills `missing`: a gap of n steps, rounded, contains n - 1 beams without return. If encoders
/// round by less than a step, counts up to 6 are exact.
void count_missing(RingScan& scan, double step_rad);

/// Rings that 'scan unfolding' finds in the order of a file (Triess et al. 2020, "Scan-based
/// semantic segmentation of LiDAR point clouds"): counter-clockwise from ahead, a ring ends where
/// the azimuth falls from the last fifth of a turn to the first.
std::size_t unfolded_rings(std::span<const Vec3f> positions);

}  // namespace adasplats
