// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/intensity_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace adasplats {
namespace {

/// Ranks from 0; equal values share the mean of theirs.
std::vector<double> ranks_of(std::span<const float> values) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double shared = 0.5 * static_cast<double>(begin + end - 1);
    for (std::size_t k = begin; k < end; ++k) ranks[order[k]] = shared;
  }
  return ranks;
}

/// Sums of the deviations of two lists from the given middles.
struct Deviations {
  double ab = 0, aa = 0, bb = 0;
};

template <class A, class B>
Deviations deviations(const A& a, const B& b, double middle_a, double middle_b) {
  Deviations sums;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double from_a = a[i] - middle_a, from_b = b[i] - middle_b;
    sums.ab += from_a * from_b;
    sums.aa += from_a * from_a;
    sums.bb += from_b * from_b;
  }
  return sums;
}

double mean_of(std::span<const float> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

double rank_correlation(std::span<const float> a, std::span<const float> b) {
  if (a.size() != b.size()) throw std::logic_error("rank_correlation: sizes differ");
  const double middle = 0.5 * (static_cast<double>(a.size()) - 1);
  const Deviations sums = deviations(ranks_of(a), ranks_of(b), middle, middle);
  return sums.aa > 0 && sums.bb > 0 ? sums.ab / std::sqrt(sums.aa * sums.bb)
                                    : std::numeric_limits<double>::quiet_NaN();
}

float cos_incidence(const SceneView& view, Vec3f direction, std::uint32_t primitive) {
  return std::min(std::fabs(dot(direction, view.unit_normal(primitive))), 1.0F);
}

float expected_intensity(const PrimitiveAttributes& scene, const Ray& ray, const Hit& hit) {
  if (hit.primitive >= scene.intensities.size()) return std::numeric_limits<float>::quiet_NaN();
  const float reflectance = scene.intensities[hit.primitive];
  if (scene.response == nullptr) return reflectance;
  return reflectance *
         scene.response->gain(hit.t, cos_incidence(scene.view, ray.direction, hit.primitive));
}

double full_scale_of(std::span<const float> measured) {
  return !measured.empty() && std::ranges::max(measured) > 1 ? 255 : 1;
}

IntensityAgreement intensity_agreement(std::span<const float> predicted,
                                       std::span<const float> measured) {
  IntensityAgreement result;
  result.beams = predicted.size();
  result.rank_correlation = rank_correlation(predicted, measured);
  result.rmse_after_fit = std::numeric_limits<double>::quiet_NaN();
  if (measured.empty()) return result;
  const Deviations sums = deviations(predicted, measured, mean_of(predicted), mean_of(measured));
  const double explained = sums.aa > 0 ? sums.ab * sums.ab / sums.aa : 0;
  result.rmse_after_fit =
      std::sqrt(std::max(sums.bb - explained, 0.0) / static_cast<double>(result.beams)) /
      full_scale_of(measured);
  return result;
}

}  // namespace adasplats
