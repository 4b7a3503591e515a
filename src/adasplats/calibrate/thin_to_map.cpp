// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/thin_to_map.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "adasplats/calibrate/cell_steps.h"

namespace adasplats {

PointCloud thinned_to_map(const PointCloud& points, const PointCloud& map) {
  constexpr double kCube_m = 0.4;
  constexpr std::uint32_t kLeast = 4;
  struct Counts {
    std::uint32_t points = 0, map = 0, seen = 0;
  };
  const auto in_map = [&](const PointCloud& cloud, std::size_t i) {
    return vec_cast<double>(cloud.positions[i]) + (cloud.origin - map.origin);
  };
  LowestCorner corner;
  for (std::size_t i = 0; i < points.size(); ++i) corner.low = min(corner.low, in_map(points, i));
  const auto cube_of = [&](const PointCloud& cloud, std::size_t i) {
    const Vec3d position = in_map(cloud, i);
    std::uint64_t key = 0;
    MakeCellKey{&position, corner.low, kCube_m, &key}(0);
    return key;
  };
  std::unordered_map<std::uint64_t, Counts> cubes;
  for (std::size_t i = 0; i < points.size(); ++i) ++cubes[cube_of(points, i)].points;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const auto cube = cubes.find(cube_of(map, i)); cube != cubes.end()) ++cube->second.map;
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Counts& cube = cubes[cube_of(points, i)];
    const std::uint32_t most = std::max(cube.map, kLeast);
    const std::uint32_t stride = (cube.points + most - 1) / most;
    if (cube.seen++ % stride == 0) kept.push_back(static_cast<std::uint32_t>(i));
  }
  return gather(points, kept);
}

}  // namespace adasplats
