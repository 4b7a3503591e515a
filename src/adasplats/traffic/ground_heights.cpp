// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/ground_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adasplats {
namespace {

std::pair<std::int32_t, std::int32_t> cell_of(double x, double y) {
  return {static_cast<std::int32_t>(std::floor(x)), static_cast<std::int32_t>(std::floor(y))};
}

}  // namespace

void GroundHeights::add(const KittiSequence& drive, std::size_t index, const KittiScan& scan) {
  constexpr double kReach_m = 100;
  const RigidTransform& world_from_sensor = drive.trajectory[index].world_from_sensor;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Vec3d local = beam_of(drive, index, scan, i).end;
    if (!(dot(local, local) < kReach_m * kReach_m)) continue;
    const Vec3d point = world_from_sensor * local;
    Cell& cell = cells_[cell_of(point.x, point.y)];
    const auto height = static_cast<float>(point.z);
    const std::size_t kept = std::min(cell.points++, kLowest);
    if (kept == kLowest && height >= cell.lowest[kLowest - 1]) continue;
    std::size_t k = kept == kLowest ? kLowest - 1 : kept;
    for (; k > 0 && cell.lowest[k - 1] > height; --k) cell.lowest[k] = cell.lowest[k - 1];
    cell.lowest[k] = height;
  }
}

double GroundHeights::at(double x, double y) const {
  for (const int reach : {0, 1, 2}) {
    double lowest = std::numeric_limits<double>::infinity();
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const auto found = cells_.find(cell_of(x + dx, y + dy));
        if (found == cells_.end() || found->second.points < kLowest) continue;
        lowest = std::min(lowest, static_cast<double>(found->second.lowest[kLowest - 1]));
      }
    }
    if (std::isfinite(lowest)) return lowest;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace adasplats
