// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/no_returns.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// "12.3".
std::string decimetres(double metres) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f", metres);
  return text.data();
}

}  // namespace

void throw_no_returns(std::size_t rays, const ScanScene& scene, std::span<const ScanMotion> scans,
                      const LidarModel& sensor, const std::string& question) {
  const auto [low, high] = scene.middle_box();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const ScanMotion& scan : scans) {
    const Vec3d at = scan.reference.world_from_sensor.translation;
    nearest_m = std::min(nearest_m, length(max(max(low - at, at - high), Vec3d{})));
  }
  throw Error(ErrorKind::data, "no returns: none of " + std::to_string(rays) + " rays in " +
                                   std::to_string(scans.size()) +
                                   " scans met anything; the sensor was " + decimetres(nearest_m) +
                                   " m from the model's box at its nearest and sees " +
                                   decimetres(sensor.min_range_m) + " to " +
                                   decimetres(sensor.max_range_m) + " m (" + question + ")");
}

}  // namespace adasplats
