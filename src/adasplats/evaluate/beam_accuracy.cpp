// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "adasplats/core/constants.h"
#include "adasplats/evaluate/beam_accuracy_internal.h"

namespace adasplats {
namespace {

constexpr std::array<double, 4> kBounds_m = {0.02, 0.05, 0.10, 0.50};
constexpr double kFar_m = 0.5;

double ranked(std::vector<float>& values, std::size_t rank) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), nth, values.end());
  return static_cast<double>(*nth);
}

}  // namespace

double median_of(std::vector<float>& values) {
  const std::size_t middle = values.size() / 2;
  const double upper = ranked(values, middle);
  return values.size() % 2 == 1 ? upper : 0.5 * (upper + ranked(values, middle - 1));
}

double percentile_of(std::vector<float>& values, std::size_t percent) {
  const std::size_t reached = (percent * values.size() + 99) / 100;  // rounded up
  return ranked(values, reached - 1);
}

BeamAccuracy accuracy_of(const std::vector<float>& errors_m) {
  std::vector<float> sizes_m, signed_m;
  sizes_m.reserve(errors_m.size());
  signed_m.reserve(errors_m.size());
  std::array<std::size_t, kBounds_m.size()> within{};
  std::size_t early = 0;
  std::size_t late = 0;
  double sum = 0;
  double squares = 0;
  for (const float error_m : errors_m) {
    if (std::isnan(error_m)) continue;
    const double error = static_cast<double>(error_m);
    const double size = std::fabs(error);
    sizes_m.push_back(std::fabs(error_m));
    signed_m.push_back(error_m);
    sum += size;
    squares += error * error;
    if (error < -kFar_m) ++early;
    if (error > kFar_m) ++late;
    for (std::size_t k = 0; k < kBounds_m.size(); ++k) within[k] += size <= kBounds_m[k] ? 1 : 0;
  }
  const double rays = static_cast<double>(std::max<std::size_t>(errors_m.size(), 1));
  const double hits = static_cast<double>(sizes_m.size());
  BeamAccuracy result;
  result.rays = errors_m.size();
  result.no_hit = static_cast<double>(errors_m.size() - sizes_m.size()) / rays;
  result.early_50cm = static_cast<double>(early) / rays;
  result.late_50cm = static_cast<double>(late) / rays;
  for (std::size_t k = 0; k < kBounds_m.size(); ++k) {
    result.within[kBounds_m[k]] = static_cast<double>(within[k]) / rays;
  }
  if (sizes_m.empty()) {
    result.median_m = result.mae_m = result.rmse_m = result.p90_m = kNaN;
    result.bias_m = result.spread_m = kNaN;
    return result;
  }
  result.mae_m = sum / hits;
  result.rmse_m = std::sqrt(squares / hits);
  result.median_m = median_of(sizes_m);
  result.p90_m = percentile_of(sizes_m, 90);
  result.bias_m = median_of(signed_m);
  for (float& error_m : signed_m) {
    error_m = static_cast<float>(std::fabs(static_cast<double>(error_m) - result.bias_m));
  }
  result.spread_m = median_of(signed_m);
  return result;
}

}  // namespace adasplats
