// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/simulate/scan/beam_field.h"
#include "adasplats/splats/reflectance/response_gain.h"

namespace adasplats {

/// UnitIntensity for CPU and GPU: plain values and pointers, of the host or of a device.
struct IntensityRules {
  bool on = false;
  float step = 0, highest = 0;
  std::uint32_t rings = 0, ring_nodes = 0, level_count = 0;
  const float* ring_expected = nullptr;
  const float* ring_level = nullptr;
  const float* levels = nullptr;
  const float* zero_share = nullptr;
  const float* reported = nullptr;
  const float* ring_texture = nullptr;
  std::uint32_t ring_texture_count = 0;
  FieldWeights zero, texture;
  double unevenness = 0;
};

/// A multiple of the step, not above the highest.
ADASPLATS_HD inline float converted(const IntensityRules& rules, float intensity) {
  if (!rules.on) return intensity;
  float value = intensity < rules.highest ? intensity : rules.highest;
  if (rules.step > 0) value = rules.step * std::round(value / rules.step);
  return value > 0 ? value : 0.0F;
}

/// Where a value stands among ascending nodes.
struct NodePlace {
  std::uint32_t below = 0;
  float share = 0;  ///< of the way to the next
};

ADASPLATS_HD inline NodePlace place_in(const float* nodes, std::uint32_t count, float value) {
  NodePlace place;
  if (count < 2 || !(value > nodes[0])) return place;
  while (place.below + 2 < count && nodes[place.below + 1] <= value) ++place.below;
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

/// Values of the texture field for which UnitIntensity::reported holds.
ADASPLATS_HD inline float texture_node(std::uint32_t k) {
  const float nodes[kTextureNodes] = {-3,   -2,   -1.4F, -1, -0.7F, -0.4F, -0.2F, 0,
                                      0.2F, 0.4F, 0.7F,  1,  1.4F,  2,     3};
  return nodes[k];
}

/// Of the beams that do not report zero, before the converter's steps.
ADASPLATS_HD inline float textured(const IntensityRules& rules, float level, double texture) {
  const NodePlace row = place_in(rules.levels, rules.level_count, level);
  constexpr auto kNodes = static_cast<std::uint32_t>(kTextureNodes);
  float nodes[kTextureNodes];  // NOLINT: filled here
  for (std::uint32_t k = 0; k < kNodes; ++k) nodes[k] = texture_node(k);
  const NodePlace column = place_in(nodes, kNodes, static_cast<float>(texture));
  const float* const low = rules.reported + static_cast<std::size_t>(row.below) * kNodes;
  const float* const high = rules.level_count > 1 ? low + kNodes : low;
  const std::uint32_t k = column.below;
  const float at_low = low[k] + column.share * (low[k + 1] - low[k]);
  const float at_high = high[k] + column.share * (high[k + 1] - high[k]);
  return at_low + row.share * (at_high - at_low);
}

/// The texture field of a beam of a ring.
ADASPLATS_HD inline double texture_of(const IntensityRules& rules, std::uint32_t ring,
                                      const BeamFieldParts& fields) {
  const double amplitude =
      ring < rules.ring_texture_count ? static_cast<double>(rules.ring_texture[ring]) : 1.0;
  return texture_value(fields, rules.texture, rules.unevenness, amplitude);
}

/// What a unit reports where a model expects `expected`.
ADASPLATS_HD inline float unit_intensity(const IntensityRules& rules, std::uint32_t ring,
                                         float expected, const BeamFieldParts& fields) {
  const float level = level_of(rules, ring, expected);
  const GainTable zeros{rules.levels, rules.zero_share, rules.level_count};
  const double zero = field_value(fields, BeamField::zero, rules.zero);
  if (normal_share(zero) < static_cast<double>(gain_of(zeros, level))) return 0;
  const float value = converted(rules, textured(rules, level, texture_of(rules, ring, fields)));
  return value > rules.step ? value : rules.step;
}

}  // namespace adasplats
