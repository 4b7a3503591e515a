// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/unit/field_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "adasplats/core/maths/elementary.h"
#include "adasplats/simulate/scan/beam_field.h"

namespace adasplats {
namespace {

constexpr std::size_t kMostPairs = 5000;  // whose expected events are summed

/// Thresholds of two beams.
struct ThresholdPair {
  double a, b;
};

/// How many of the pairs have both events, of all, with a correlation of 0 to 1: both are below
/// their thresholds in a common part, in which they do not depend on each other.
double both_share(std::span<const ThresholdPair> pairs, double correlation) {
  constexpr double kFrom = -5, kStep = 0.2;
  constexpr int kSteps = 51;
  const double common = std::sqrt(correlation), own = 1 / std::sqrt(1 - correlation);
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double at = kFrom + kStep * k;
    const double weight = kStep * 0.3989422804014327 * exp_of(-0.5 * at * at);
    double products = 0;
    for (const ThresholdPair& pair : pairs)
      products +=
          normal_share((pair.a - common * at) * own) * normal_share((pair.b - common * at) * own);
    sum += weight * products;
  }
  return sum / static_cast<double>(pairs.size());
}

double correlation_of(std::span<const ThresholdPair> pairs, double both) {
  double low = 0, high = 0.995;
  constexpr int kHalvings = 11;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (both_share(pairs, middle) < both ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double normal_quantile(double share) {
  const double wanted = std::clamp(share, 1e-6, 1 - 1e-6);
  double low = -5, high = 5;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (normal_share(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double octave_correlation(std::size_t octave, std::size_t lag) {
  const std::size_t columns = octave_columns(static_cast<int>(octave));
  double sum = 0;
  for (std::size_t first = 0; first < columns; ++first) {
    const auto parts = [&](std::size_t column) {
      const double share = static_cast<double>(column % columns) / static_cast<double>(columns);
      const double size = std::sqrt(share * share + (1 - share) * (1 - share));
      return std::pair{(1 - share) / size, share / size};
    };
    const auto [a, b] = parts(first);
    const auto [c, d] = parts(first + lag);
    const std::size_t nodes = (first + lag) / columns;
    if (nodes == 0) sum += a * c + b * d;
    if (nodes == 1) sum += b * c;
  }
  return sum / static_cast<double>(columns);
}

FieldShares shares_of(const LagCorrelations& correlations) {
  double of[kFieldLags.size()][kFieldOctaves] = {};
  for (std::size_t l = 0; l < kFieldLags.size(); ++l)
    for (std::size_t k = 0; k < kFieldOctaves; ++k) of[l][k] = octave_correlation(k, kFieldLags[l]);
  FieldShares shares = {0.1, 0.1, 0.1, 0.1};
  constexpr int kSteps = 30'000;  // of projected gradient descent; the problem has 4 unknowns
  constexpr double kStep = 0.05 / static_cast<double>(kFieldLags.size());
  for (int step = 0; step < kSteps; ++step) {
    FieldShares gradient = {};
    for (std::size_t l = 0; l < kFieldLags.size(); ++l) {
      double error = -correlations[l];
      for (std::size_t k = 0; k < kFieldOctaves; ++k) error += of[l][k] * shares[k];
      for (std::size_t k = 0; k < kFieldOctaves; ++k) gradient[k] += error * of[l][k];
    }
    for (std::size_t k = 0; k < kFieldOctaves; ++k)
      shares[k] = std::max(0.0, shares[k] - kStep * gradient[k]);
  }
  double sum = 0;
  for (const double share : shares) sum += share;
  for (double& share : shares) share = std::round(1e4 * share / std::max(1.0, sum / 0.999)) / 1e4;
  return shares;
}

LagCorrelations latent_correlations(std::span<const UnitBeam> beams,
                                    std::span<const double> chances,
                                    std::span<const std::uint8_t> events) {
  LagCorrelations correlations = {};
  for (std::size_t l = 0; l < kFieldLags.size(); ++l) {
    const std::size_t lag = kFieldLags[l];
    std::vector<std::size_t> firsts;
    std::size_t both = 0;
    for (std::size_t i = 0; i + lag < beams.size(); ++i) {
      const std::size_t j = i + lag;
      if (!same_ring(beams[i], beams[j]) || !(chances[i] + chances[j] >= 0)) continue;
      firsts.push_back(i);
      both += events[i] != 0 && events[j] != 0 ? 1 : 0;
    }
    if (firsts.empty()) continue;
    std::vector<ThresholdPair> pairs;
    const std::size_t count = std::min(firsts.size(), kMostPairs);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = firsts[k * firsts.size() / count];
      pairs.push_back({normal_quantile(chances[i]), normal_quantile(chances[i + lag])});
    }
    correlations[l] =
        correlation_of(pairs, static_cast<double>(both) / static_cast<double>(firsts.size()));
  }
  return correlations;
}

LagCorrelations lag_products(std::span<const UnitBeam> beams, std::span<const double> numbers) {
  LagCorrelations products = {};
  for (std::size_t l = 0; l < kFieldLags.size(); ++l) {
    const std::size_t lag = kFieldLags[l];
    double sum = 0, count = 0;
    for (std::size_t i = 0; i + lag < beams.size(); ++i) {
      const double product = numbers[i] * numbers[i + lag];
      if (!same_ring(beams[i], beams[i + lag]) || product != product) continue;
      sum += product;
      ++count;
    }
    products[l] = count > 0 ? sum / count : 0;
  }
  return products;
}

}  // namespace adasplats
