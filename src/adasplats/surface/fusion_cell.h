// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Cells of a grid on either side of zero: 21 bits an axis. Points beyond share the last ones.
inline constexpr double kMaxFusionCells = 1048575;

/// Which cell of a grid of side `cell_m` a coordinate lies in.
ADASPLATS_HD inline std::uint64_t fusion_axis_key(float value, double cell_m) {
  constexpr double kMost = kMaxFusionCells;
  const double cell = std::floor(static_cast<double>(value) / cell_m);
  return static_cast<std::uint64_t>(std::clamp(cell, -kMost, kMost) + kMost);
}

ADASPLATS_HD inline std::uint64_t fusion_key(Vec3f point, double cell_m) {
  return fusion_axis_key(point.x, cell_m) << 42 | fusion_axis_key(point.y, cell_m) << 21 |
         fusion_axis_key(point.z, cell_m);
}

/// Mean of points[i] for i of `members`, added in their order.
ADASPLATS_HD inline Vec3f mean_position(const Vec3f* points,
                                        std::span<const std::uint32_t> members) {
  Vec3d sum;
  for (const std::uint32_t i : members) sum = sum + vec_cast<double>(points[i]);
  return vec_cast<float>(sum / static_cast<double>(members.size()));
}

}  // namespace adasplats
