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

/// The returns of one scan by the ring that measured them, in the order in which the sensor turned.
/// All that is known of it is in the points: measured and simulated scans are arranged alike.
struct RingScan {
  std::vector<std::size_t> begins;  ///< first return of each ring, topmost first, and their number
  std::vector<float> azimuths_rad;  ///< clockwise seen from above, from the rear, 0 to 2 pi;
                                    ///< ascending within a ring
  std::vector<float> ranges_m;      ///< from where the beam left
  std::vector<float> intensities;   ///< NaN: not known
  std::vector<Vec3f> directions;    ///< of the beam, unit, sensor's axes
  /// Beams of the same ring without return, between a return and the next: count_missing().
  std::vector<std::uint32_t> missing;

  std::size_t rings() const { return begins.empty() ? 0 : begins.size() - 1; }
  std::size_t size() const { return ranges_m.size(); }
};

/// Arranges a scan of a sequence whose sensor is recognised (ScanBeams::sensor): rings are its
/// lasers, and the motion of the sensor is taken out of directions where the points are
/// compensated for it. `heights_m`: where each laser leaves above the sensor's origin, one a ring;
/// scans that say where beams began (KittiScan::origins) mean the sensor, sequences the laser.
/// Points that are not finite, at the origin or of no laser are left out.
RingScan arrange_in_rings(const KittiSequence& sequence, std::size_t index, const KittiScan& scan,
                          std::span<const double> heights_m);

/// How far a ring's firings are apart: the mean of the gaps between neighbouring returns, of those
/// from 0.4 to 1.4 of the median gap. 0.4, because an encoder reports steps that alternate between
/// one and two of its own (HDL-64E: 0.09 degrees). 0 where nothing tells it.
double azimuth_step_rad(const RingScan& scan);

/// Fills `missing`: a gap of n steps, rounded, holds n - 1 beams without return. Encoders that
/// round by less than a step leave counts up to 6 exact.
void count_missing(RingScan& scan, double step_rad);

/// Rings that 'scan unfolding' finds in the order of a file (Triess et al. 2020, "Scan-based
/// semantic segmentation of LiDAR point clouds"): counter-clockwise from ahead, a ring ends where
/// the azimuth falls from the last fifth of a turn to the first.
std::size_t unfolded_rings(std::span<const Vec3f> positions);

}  // namespace adasplats
