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

/// Data of a packet in addition to the scan.
struct ScanPacketHead {
  std::uint32_t number = 0;
  std::uint32_t rings = 0;    ///< rows of the sensor's range image
  std::uint32_t columns = 0;  ///< columns of that image
  bool moved = false;         ///< whether the sensor moved during the scan
  double seconds = 0;         ///< duration of the simulation; 0: recorded
  double max_range_m = 0;
  float full_intensity = 1;  ///< sent as 1; higher ones are clamped
  Vec3d local_origin;        ///< origin of the page's positions in world coordinates
};

/// A scan in the format of the page (docs/viewer_protocol.md, "A scan packet"): 80 bytes plus 24
/// per point. Missing attributes are 0. Errors: std::logic_error if the size of an attribute
/// differs from the number of points.
std::shared_ptr<const std::string> scan_packet(const Scan& scan, const ScanPacketHead& head);

/// A packet of a recorded scan, which has no rings and columns. They are computed from the
/// directions for a range image: `head.rings` rows over the middle 99 % of the elevations, topmost
/// first, and `head.columns` steps of azimuth, clockwise from the rear; directions beyond are in
/// the outermost rows. With 0 rings or columns all are 0. Skips points that are not finite. Errors:
/// as scan_packet().
std::shared_ptr<const std::string> recorded_scan_packet(const KittiScan& scan,
                                                        const RigidTransform& world_from_sensor,
                                                        const ScanPacketHead& head);

/// The full scale of intensities: the smallest of 1, 255 and 65535 that no finite value exceeds, or
/// else the largest value.
float full_intensity_of(std::span<const float> intensities);

}  // namespace adasplats
