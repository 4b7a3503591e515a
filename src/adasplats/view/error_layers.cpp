// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/error_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace adasplats {
namespace {

constexpr std::array<const char*, 4> kParts = {"early", "late", "ghosts", "holes"};
constexpr std::size_t kNoPart = kParts.size();

std::size_t part_of(float error_m, const ErrorLimits& limits) {
  if (std::isnan(error_m)) return 3;
  if (error_m < -limits.ghost_m) return 2;
  if (error_m > limits.tolerance_m) return 1;
  return error_m < -limits.tolerance_m ? 0 : kNoPart;
}

/// The points of the given rows.
PointCloud chosen_rows(const PointCloud& cloud, std::span<const std::uint32_t> rows) {
  PointCloud chosen;
  chosen.origin = cloud.origin;
  for (const std::uint32_t i : rows) {
    chosen.positions.push_back(cloud.positions[i]);
    if (!cloud.classes.empty()) chosen.classes.push_back(cloud.classes[i]);
    if (!cloud.intensities.empty()) chosen.intensities.push_back(cloud.intensities[i]);
  }
  return chosen;
}

}  // namespace

std::vector<ViewLayer> error_part_layers(const PointCloud& cloud, std::span<const float> errors_m,
                                         const ErrorLimits& limits, Vec3d origin,
                                         const Executor& executor) {
  std::vector<ViewLayer> layers;
  if (std::ranges::none_of(errors_m, [](float error_m) { return error_m < 0; })) return layers;
  std::array<std::vector<std::uint32_t>, kParts.size()> rows;
  for (std::size_t i = 0; i < errors_m.size(); ++i)
    if (const std::size_t part = part_of(errors_m[i], limits); part != kNoPart)
      rows[part].push_back(static_cast<std::uint32_t>(i));
  for (std::size_t part = 0; part < rows.size(); ++part) {
    if (rows[part].empty()) continue;
    std::vector<float> chosen_m;
    for (const std::uint32_t i : rows[part]) chosen_m.push_back(errors_m[i]);
    ViewLayer layer =
        point_layer(kParts[part], chosen_rows(cloud, rows[part]), chosen_m, origin, executor);
    layer.part = kParts[part];
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace adasplats
