// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/splat_colors.h"

#include <array>
#include <cstdint>
#include <stdexcept>

#include "adasplats/neighbors/point_index.h"

namespace adasplats {

std::vector<ColorBytes> colors_of_disks(std::span<const Disk> disks,
                                        std::span<const Vec3f> positions,
                                        std::span<const ColorBytes> colors,
                                        const Executor& executor) {
  if (colors.size() != positions.size())
    throw std::logic_error("colors_of_disks: one colour a point is needed");
  if (disks.empty() || positions.empty()) return {};
  std::vector<Vec3f> centers;
  centers.reserve(disks.size());
  for (const Disk& disk : disks) centers.push_back(disk.center);

  struct Sum {
    std::array<std::uint64_t, 3> of{};
    std::uint64_t points = 0;
  };
  std::vector<Sum> sums(disks.size());
  {
    const PointIndex index(centers, executor);
    const std::vector<Neighbor> nearest = index.nearest(positions, executor);
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      if (nearest[i].index == Neighbor::kNone) continue;
      const float radius = disks[nearest[i].index].radius;
      if (nearest[i].squared_distance > radius * radius) continue;
      Sum& sum = sums[nearest[i].index];
      for (std::size_t k = 0; k < 3; ++k) sum.of[k] += colors[i][k];
      ++sum.points;
    }
  }
  std::vector<Vec3f> bare;  // centres of disks without points
  for (std::size_t d = 0; d < disks.size(); ++d)
    if (sums[d].points == 0) bare.push_back(centers[d]);
  std::vector<Neighbor> nearest_points;
  if (!bare.empty()) nearest_points = PointIndex(positions, executor).nearest(bare, executor);

  std::vector<ColorBytes> result(disks.size());
  for (std::size_t d = 0, next_bare = 0; d < disks.size(); ++d) {
    const auto& [of, points] = sums[d];
    if (points > 0) {
      for (std::size_t k = 0; k < 3; ++k)
        result[d][k] = static_cast<std::uint8_t>((of[k] + points / 2) / points);
    } else if (const Neighbor& point = nearest_points[next_bare++];
               point.index != Neighbor::kNone) {
      result[d] = colors[point.index];
    }
  }
  return result;
}

}  // namespace adasplats
