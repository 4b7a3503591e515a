// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/maths/elementary.h"
#include "adasplats/sensors/ray_drop_model.h"
#include "adasplats/simulate/scan/edge_runs.h"

namespace adasplats {

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

/// Inputs of the features, bounded so that logarithms are finite.
struct DropConditions {
  double range = 0;        ///< in units of 10 m
  double slant = 0;        ///< 1 - cos of the incidence
  double reflectance = 0;  ///< the usual one if not finite
};

ADASPLATS_HD inline DropConditions drop_conditions(float range_m, float cos_incidence,
                                                   float reflectance, double usual_reflectance) {
  constexpr double kMinRange = 0.01, kDimmest = 0.005;
  const double tens = static_cast<double>(range_m) / 10;
  const auto cosine = static_cast<double>(cos_incidence);
  const bool is_finite = reflectance - reflectance == 0.0F;
  const double known = is_finite ? static_cast<double>(reflectance) : usual_reflectance;
  return {tens > kMinRange ? tens : kMinRange,
          1 - (cosine < 0.0   ? 0.0
               : cosine > 1.0 ? 1.0
                              : cosine),
          known > kDimmest ? known : kDimmest};
}

/// 1, r, r^2, log(r), 1 - cos, (1 - cos)^2, log(reflectance), r * log(reflectance), r in units of
/// 10 m, with these logarithms.
ADASPLATS_HD inline DropFeatures drop_features(const DropConditions& echo, double log_range,
                                               double log_reflectance) {
  return {{1, echo.range, echo.range * echo.range, log_range, echo.slant, echo.slant * echo.slant,
           log_reflectance, echo.range * log_reflectance}};
}

ADASPLATS_HD inline DropFeatures drop_features(const DropConditions& echo) {
  return drop_features(echo, log_of(echo.range), log_of(echo.reflectance));
}

ADASPLATS_HD inline double drop_logit(const DropRules& rules, const DropFeatures& features) {
  double sum = 0;
  for (int k = 0; k < kDropFeatures; ++k) sum += rules.weights[k] * features.of[k];
  return sum;
}

/// Probability that an echo is lost, 0..1. `drop_log_odds`: of the splat, on top of the sensor's.
ADASPLATS_HD inline double drop_chance(const DropRules& rules, float range_m, float cos_incidence,
                                       float reflectance, float drop_log_odds) {
  const DropConditions echo =
      drop_conditions(range_m, cos_incidence, reflectance, rules.usual_reflectance);
  const double logit = drop_logit(rules, drop_features(echo)) + static_cast<double>(drop_log_odds);
  return 1 / (1 + exp_of(-logit));
}

/// Whether `drawn` is below drop_chance(). A bound decides most beams without logarithms and
/// exponentials.
ADASPLATS_HD inline bool is_lost(const DropRules& rules, float range_m, float cos_incidence,
                                 float reflectance, float drop_log_odds, double drawn) {
  const DropConditions echo =
      drop_conditions(range_m, cos_incidence, reflectance, rules.usual_reflectance);
  const double of_range = rules.weights[3];
  const double of_reflectance = rules.weights[6] + echo.range * rules.weights[7];
  const auto of_splat = static_cast<double>(drop_log_odds);
  const double most =
      of_splat +
      drop_logit(rules,
                 drop_features(echo, log_floor_of(echo.range), log_floor_of(echo.reflectance))) +
      kLogFloorError *
          ((of_range > 0 ? of_range : 0.0) + (of_reflectance > 0 ? of_reflectance : 0.0));
  // 1 + exp(x) is more than 2 + x + x^2 / 2 + x^3 / 6.
  const double x = -most;
  if (x > 0 && drawn * (2 + x * (1 + x * (0.5 + x * (1.0 / 6)))) >= 1) return false;
  return drawn < 1 / (1 + exp_of(-(drop_logit(rules, drop_features(echo)) + of_splat)));
}

}  // namespace adasplats
