// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/ray_drop_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "adasplats/core/constants.h"

namespace adasplats {

bool RayDropModel::blocks(Vec3f direction) const {
  if (blocked.empty() || direction == Vec3f{}) return false;
  constexpr auto kHalfTurn = static_cast<float>(std::numbers::pi);
  constexpr double kMaxApart_rad = 0.3 * kDegree;  // beams of an HDL-64E are farther apart
  const auto elevation = static_cast<float>(
      std::atan2(static_cast<double>(direction.z),
                 std::hypot(static_cast<double>(direction.x), static_cast<double>(direction.y))));
  const auto below = [](const BlockedSector& sector, float value) {
    return sector.elevation_rad < value;
  };
  auto first = std::lower_bound(blocked.begin(), blocked.end(), elevation, below);
  if (first == blocked.end() ||
      (first != blocked.begin() &&
       elevation - std::prev(first)->elevation_rad < first->elevation_rad - elevation)) {
    first = std::lower_bound(blocked.begin(), first, std::prev(first)->elevation_rad, below);
  }
  const float nearest = first->elevation_rad;
  if (std::fabs(static_cast<double>(nearest - elevation)) > kMaxApart_rad) return false;
  const auto azimuth = static_cast<float>(
      std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x)));
  for (; first != blocked.end() && first->elevation_rad == nearest; ++first) {
    // Half a turn itself belongs to the sector that ends there.
    const bool before_end = azimuth < first->azimuth_end_rad || first->azimuth_end_rad >= kHalfTurn;
    if (azimuth >= first->azimuth_begin_rad && before_end) return true;
  }
  return false;
}

}  // namespace adasplats
