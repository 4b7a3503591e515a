// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// A gain that is linear between nodes and constant outside, for CPU and GPU; without nodes 1.
struct GainTable {
  const float* nodes = nullptr;  ///< ascending
  const float* gains = nullptr;  ///< one a node
  std::uint32_t count = 0;
};

ADASPLATS_HD inline float gain_of(const GainTable& table, float value) {
  if (table.count == 0) return 1.0F;
  const std::uint32_t last = table.count - 1;
  const float first = table.nodes[0];
  if (last == 0 || !(value > first)) return table.gains[0];
  if (value >= table.nodes[last]) return table.gains[last];
  // Where nodes are equally far apart this is their place at once.
  const float place = (value - first) / (table.nodes[last] - first) * static_cast<float>(last);
  auto below = static_cast<std::uint32_t>(place);
  if (below >= last) below = last - 1;
  while (below > 0 && table.nodes[below] > value) --below;
  while (below + 1 < last && table.nodes[below + 1] <= value) ++below;
  const float low = table.nodes[below];
  const float share = (value - low) / (table.nodes[below + 1] - low);
  return table.gains[below] + share * (table.gains[below + 1] - table.gains[below]);
}

}  // namespace adasplats
