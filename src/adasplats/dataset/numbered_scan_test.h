// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/maths/random.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

/// A scan with all attributes, different for each number, of a sensor that moves for a tenth of a
/// second.
inline Scan scan_number(std::uint64_t number, std::size_t points) {
  Random random(11, 0, number);
  Scan scan;
  scan.time_s = 0.1 * static_cast<double>(number) + 1.0 / 3;
  scan.world_from_sensor = {
      rotation_from_yaw_pitch_roll(random.uniform(-3, 3), random.uniform(-1, 1),
                                   random.uniform(-3, 3)),
      {448262 + random.uniform(), 5411932 + random.uniform(), random.uniform(-50, 50)}};
  scan.duration_s = 0.1;
  for (const double ahead_m : {-0.5, 0.0, 0.5}) {
    scan.knots.push_back(scan.world_from_sensor);
    scan.knots.back().translation.x += ahead_m;
  }
  scan.rays = 2 * points;
  for (std::size_t i = 0; i < points; ++i) {
    const Vec3d p{random.uniform(-90, 90), random.uniform(-90, 90), random.uniform(-3, 9)};
    scan.positions.push_back(vec_cast<float>(p));
    scan.ranges_m.push_back(length(scan.positions.back()));
    scan.intensities.push_back(static_cast<float>(random.uniform()));
    scan.classes.push_back(static_cast<std::uint16_t>(random.next_bits()));
    scan.instances.push_back(static_cast<std::uint16_t>(random.next_bits()));
    scan.rings.push_back(static_cast<std::uint16_t>(i % 64));
    scan.columns.push_back(static_cast<std::uint32_t>(i / 64));
    scan.times_s.push_back(0.001F * static_cast<float>(i));
  }
  return scan;
}

}  // namespace adasplats
