// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/maths/elementary.h"
#include "adasplats/simulate/scan/edge_runs.h"

namespace adasplats {

inline constexpr int kDropFeatures = 8;

/// A logistic model of lost echoes, for CPU and GPU: RayDropModel without blocked directions.
struct DropRules {
  bool on = false;
  double weights[kDropFeatures] = {};
  double usual_reflectance = 0.3;
  EdgeRunRules edges;
};

struct DropFeatures {
  double of[kDropFeatures];
};

/// 1, r, r^2, log(r), 1 - cos, (1 - cos)^2, log(reflectance), r * log(reflectance), r in units of
/// 10 m. A reflectance that is not finite is the usual one.
ADASPLATS_HD inline DropFeatures drop_features(float range_m, float cos_incidence,
                                               float reflectance, double usual_reflectance) {
  constexpr double kLeastRange = 0.01, kDimmest = 0.005;  // logarithms are finite
  const double tens = static_cast<double>(range_m) / 10;
  const double range = tens > kLeastRange ? tens : kLeastRange;
  const auto cosine = static_cast<double>(cos_incidence);
  const double slant = 1 - (cosine < 0.0 ? 0.0 : cosine > 1.0 ? 1.0 : cosine);
  const bool is_finite = reflectance - reflectance == 0.0F;
  const double known = is_finite ? static_cast<double>(reflectance) : usual_reflectance;
  const double dim = log_of(known > kDimmest ? known : kDimmest);
  return {{1, range, range * range, log_of(range), slant, slant * slant, dim, range * dim}};
}

/// How likely an echo is lost, 0..1.
ADASPLATS_HD inline double drop_chance(const DropRules& rules, float range_m, float cos_incidence,
                                       float reflectance) {
  const DropFeatures features =
      drop_features(range_m, cos_incidence, reflectance, rules.usual_reflectance);
  double sum = 0;
  for (int k = 0; k < kDropFeatures; ++k) sum += rules.weights[k] * features.of[k];
  return 1 / (1 + exp_of(-sum));
}

}  // namespace adasplats
