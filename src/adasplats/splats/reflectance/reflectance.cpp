// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/reflectance/reflectance.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace adasplats {
namespace {

float table_value(std::span<const float> nodes, std::span<const float> values, float at) {
  if (values.size() < 2 || nodes.size() != values.size()) return values.empty() ? 1.0F : values[0];
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, at);
  const auto below = static_cast<std::size_t>(above - nodes.begin()) - 1;
  const float share = (at - nodes[below]) / (nodes[below + 1] - nodes[below]);
  return values[below] + std::clamp(share, 0.0F, 1.0F) * (values[below + 1] - values[below]);
}

}  // namespace

float IntensityResponse::gain(float range_m, float cos_incidence) const {
  return table_value(ranges_m, range_gains, range_m) *
         table_value(cos_incidences, incidence_gains, cos_incidence);
}

}  // namespace adasplats
