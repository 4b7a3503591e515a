// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/ground_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace adasplats {
namespace {

constexpr double kStep_m = 0.1;

std::uint64_t cell_of(double x, double y) {
  const auto part = [](double value) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(value)));
  };
  return (std::uint64_t{part(x)} << 32) | part(y);
}

}  // namespace

ScanHeights::ScanHeights(const KittiSequence& drive, std::size_t index, const KittiScan& scan) {
  constexpr double kReach_m = 100;
  const RigidTransform& world_from_sensor = drive.trajectory[index].world_from_sensor;
  std::vector<Step> steps;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Vec3d local = beam_of(drive, index, scan, i).end;
    if (!(dot(local, local) < kReach_m * kReach_m)) continue;
    const Vec3d point = world_from_sensor * local;
    const Step step = {cell_of(point.x, point.y),
                       static_cast<std::int32_t>(std::floor(point.z / kStep_m)), 1};
    // Consecutive points are often close to each other.
    if (!steps.empty() && steps.back().cell == step.cell && steps.back().height == step.height)
      ++steps.back().points;
    else
      steps.push_back(step);
  }
  std::ranges::sort(steps, {}, [](const Step& step) { return std::pair(step.cell, step.height); });
  for (const Step& step : steps) {
    if (!steps_.empty() && steps_.back().cell == step.cell && steps_.back().height == step.height)
      steps_.back().points += step.points;
    else
      steps_.push_back(step);
  }
}

void GroundHeights::add(const ScanHeights& scan) {
  Cell* cell = nullptr;
  for (std::size_t k = 0; k < scan.steps_.size(); ++k) {
    const ScanHeights::Step& step = scan.steps_[k];
    if (k == 0 || scan.steps_[k - 1].cell != step.cell) cell = &cells_[step.cell];
    const auto place = std::ranges::lower_bound(cell->heights, step.height, {},
                                                &std::pair<std::int32_t, std::uint32_t>::first);
    if (place != cell->heights.end() && place->first == step.height)
      place->second += step.points;
    else
      cell->heights.insert(place, {step.height, step.points});
    cell->points += step.points;
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
