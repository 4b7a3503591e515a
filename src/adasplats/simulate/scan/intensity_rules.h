// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/host_device.h"
#include "adasplats/sensors/calibrated_sensor.h"
#include "adasplats/splats/reflectance/response_tables.h"

namespace adasplats {

/// SensorIntensity for CPU and GPU: plain values and pointers, of the host or of a device.
struct IntensityRules {
  bool on = false;
  float step = 0, highest = 0;
  std::uint32_t rings = 0, ring_nodes = 0, level_count = 0;
  const float* ring_expected = nullptr;
  const float* ring_level = nullptr;
  const float* levels = nullptr;
  const float* zero_share = nullptr;
  const float* reported = nullptr;
};

/// Views the tables of a calibrated sensor, which must outlive the rules.
inline IntensityRules intensity_rules(const SensorIntensity& unit) {
  IntensityRules rules;
  rules.on = true;
  rules.step = static_cast<float>(unit.step);
  rules.highest = static_cast<float>(unit.highest);
  rules.ring_nodes = static_cast<std::uint32_t>(unit.ring_nodes);
  if (unit.ring_nodes > 0)
    rules.rings = static_cast<std::uint32_t>(unit.ring_expected.size() / unit.ring_nodes);
  rules.ring_expected = unit.ring_expected.data();
  rules.ring_level = unit.ring_level.data();
  rules.levels = unit.levels.data();
  rules.level_count = static_cast<std::uint32_t>(unit.levels.size());
  rules.zero_share = unit.zero_share.data();
  rules.reported = unit.reported.data();
  return rules;
}

/// Rounds to a multiple of the step, at most the maximum.
ADASPLATS_HD inline float converted(const IntensityRules& rules, float intensity) {
  if (!rules.on) return intensity;
  float value = intensity < rules.highest ? intensity : rules.highest;
  if (rules.step > 0) value = rules.step * std::round(value / rules.step);
  return value > 0 ? value : 0.0F;
}

/// Position of a value among ascending nodes.
struct NodePlace {
  std::uint32_t below = 0;
  float share = 0;  ///< of the way to the next
};

ADASPLATS_HD inline NodePlace place_in(const float* nodes, std::uint32_t count, float value) {
  NodePlace place;
  if (count < 2 || !(value > nodes[0])) return place;
  // By halves, without branches that depend on the value.
  std::uint32_t step = 1;
  while (2 * step < count) step *= 2;
  for (; step > 0; step /= 2) {
    const std::uint32_t next = place.below + step;
    if (next + 1 < count && nodes[next] <= value) place.below = next;
  }
  const float low = nodes[place.below], high = nodes[place.below + 1];
  const float share = (value - low) / (high - low);
  place.share = share < 1.0F ? share : 1.0F;
  return place;
}

/// What a laser makes of the intensity that a model expects.
ADASPLATS_HD inline float level_of(const IntensityRules& rules, std::uint32_t ring,
                                   float expected) {
  if (ring >= rules.rings) return expected;
  const std::size_t first = static_cast<std::size_t>(ring) * rules.ring_nodes;
  return gain_of({rules.ring_expected + first, rules.ring_level + first, rules.ring_nodes},
                 expected);
}

/// Shares for which SensorIntensity::reported holds: finer at both ends.
ADASPLATS_HD inline float texture_node(std::uint32_t k) {
  const float nodes[kTextureNodes] = {0,     0.01F, 0.03F, 0.07F, 0.15F, 0.25F, 0.35F, 0.5F,
                                      0.65F, 0.75F, 0.85F, 0.93F, 0.97F, 0.99F, 1};
  return nodes[k];
}

/// Of the beams that do not report zero, before the converter's steps: above which a share of them
/// reports less.
ADASPLATS_HD inline float textured(const IntensityRules& rules, float level, double share) {
  const NodePlace row = place_in(rules.levels, rules.level_count, level);
  constexpr auto kNodes = static_cast<std::uint32_t>(kTextureNodes);
  float nodes[kTextureNodes];  // NOLINT: filled here
  for (std::uint32_t k = 0; k < kNodes; ++k) nodes[k] = texture_node(k);
  const NodePlace column = place_in(nodes, kNodes, static_cast<float>(share));
  const float* const low = rules.reported + static_cast<std::size_t>(row.below) * kNodes;
  const float* const high = rules.level_count > 1 ? low + kNodes : low;
  const std::uint32_t k = column.below;
  const float at_low = low[k] + column.share * (low[k + 1] - low[k]);
  const float at_high = high[k] + column.share * (high[k + 1] - high[k]);
  return at_low + row.share * (at_high - at_low);
}

/// Where a beam lies among all of which the same is expected.
struct IntensityShares {
  double zero = 0;   ///< of those that report zero: that do so earlier
  double below = 0;  ///< of the others: that report less
};

/// The intensity that a calibrated sensor reports where a model expects `expected`.
ADASPLATS_HD inline float unit_intensity(const IntensityRules& rules, std::uint32_t ring,
                                         float expected, const IntensityShares& shares) {
  const float level = level_of(rules, ring, expected);
  const GainTable zeros{rules.levels, rules.zero_share, rules.level_count};
  if (shares.zero < static_cast<double>(gain_of(zeros, level))) return 0;
  const float value = converted(rules, textured(rules, level, shares.below));
  return value > rules.step ? value : rules.step;
}

}  // namespace adasplats
