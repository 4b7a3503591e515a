// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/ground_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adasplats {
namespace {

constexpr double kStep_m = 0.1;

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
    ++cell.heights[static_cast<std::int32_t>(std::floor(point.z / kStep_m))];
    ++cell.points;
  }
}

double GroundHeights::ground_of(const Cell& cell) {
  // Mirrors and noise have points below the ground.
  constexpr std::uint32_t kMinPoints = 5, kShare = 20;
  const std::uint32_t below = std::max(kMinPoints, cell.points / kShare);
  std::uint32_t count = 0;
  for (const auto& [step, points] : cell.heights) {
    count += points;
    if (count >= below) return (step + 0.5) * kStep_m;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double GroundHeights::at(double x, double y) const {
  for (const int reach : {0, 1, 2}) {
    double lowest = std::numeric_limits<double>::infinity();
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const auto found = cells_.find(cell_of(x + dx, y + dy));
        if (found == cells_.end()) continue;
        const double ground = ground_of(found->second);
        if (!std::isnan(ground)) lowest = std::min(lowest, ground);
      }
    }
    if (std::isfinite(lowest)) return lowest;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace adasplats
