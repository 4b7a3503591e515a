// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/elementary.h"
#include "adasplats/segment/network/network.h"

namespace adasplats {

/// Attributes of a cell for the network.
struct CellFacts {
  float height_m = 0;  ///< above the ground
  float intensity = 0;
  bool has_intensity = false;
};

ADASPLATS_HD inline float feature_of(PointFeature feature, const CellFacts& cell,
                                     float height_unit_m) {
  switch (feature) {
    case PointFeature::one: return 1;
    case PointFeature::height: return cell.height_m / height_unit_m;
    case PointFeature::intensity: return cell.intensity;
    case PointFeature::has_intensity: return cell.has_intensity ? 1.0F : 0.0F;
  }
  return 0;
}

/// A point's intensity divided by `full`, clamped to 0..1; 0 if it is unknown.
ADASPLATS_HD inline float intensity_share(float intensity, float full) {
  const float share = intensity / full;
  if (!(std::fabs(share) <= 3e38F)) return 0;
  return share < 0 ? 0.0F : (share > 1 ? 1.0F : share);
}

/// Index of the largest logit of a cell; the first of equal ones.
ADASPLATS_HD inline std::uint8_t class_of_logits(const float* logits, std::size_t classes) {
  std::size_t best = 0;
  for (std::size_t c = 1; c < classes; ++c)
    if (logits[best] < logits[c]) best = c;
  return static_cast<std::uint8_t>(best);
}

/// Probability of the class with the largest logit; 0 if the logits are not finite (weights that
/// overflow floats).
ADASPLATS_HD inline float confidence_of_logits(const float* logits, std::size_t classes,
                                               std::size_t best) {
  float sum = 0;
  for (std::size_t c = 0; c < classes; ++c) sum += exp_of_negative(logits[c] - logits[best]);
  return std::fabs(sum) <= 3e38F ? 1 / sum : 0;
}

/// Probability of class c, given that of the best class.
ADASPLATS_HD inline float probability_of_logits(const float* logits, std::size_t c,
                                                std::size_t best, float confidence) {
  return confidence > 0 ? confidence * exp_of_negative(logits[c] - logits[best]) : 0;
}

}  // namespace adasplats
