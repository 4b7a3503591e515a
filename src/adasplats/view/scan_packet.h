// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

/// What a packet says besides the scan.
struct ScanPacketHead {
  std::uint32_t number = 0;
  std::uint32_t rings = 0;    ///< of the sensor, rows of its range image
  std::uint32_t columns = 0;  ///< of the sensor
  bool moved = false;         ///< the sensor, while it measured
  double seconds = 0;         ///< that the simulation took; 0: recorded
  double max_range_m = 0;
  float full_intensity = 1;  ///< reported as 1; what is above is clamped
  Vec3d local_origin;        ///< of the page's positions, world coordinates
};

/// A scan as the page reads it (docs/viewer_protocol.md, "A scan packet"): 80 bytes and 24 a point.
/// Attributes that the scan lacks are 0. Errors: std::logic_error where one that it has is of
/// another size than its points.
std::shared_ptr<const std::string> scan_packet(const Scan& scan, const ScanPacketHead& head);

/// The same of a recorded scan, which does not have rings and columns. Its points get those of
/// their direction, for a range image: `head.rings` rows over the middle 99 % of its elevations,
/// topmost first, and `head.columns` steps of azimuth, clockwise from the rear; what lies beyond is
/// in the outermost. 0 rings or columns: all 0. Points that are not finite are left out. Errors: as
/// scan_packet.
std::shared_ptr<const std::string> recorded_scan_packet(const KittiScan& scan,
                                                        const RigidTransform& world_from_sensor,
                                                        const ScanPacketHead& head);

/// What sensors call full: 1, 255 or 65535, the least that none of the finite values exceeds, or
/// else the greatest of them.
float full_intensity_of(std::span<const float> intensities);

}  // namespace adasplats
