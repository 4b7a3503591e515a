// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The intensities of a sensor: levels of its lasers, zeros, and the scatter of the others.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/realism/scan_part.h"
#include "adasplats/evaluate/unit/beam_shares.h"
#include "adasplats/evaluate/unit/fit_unit.h"
#include "adasplats/simulate/scan/intensity_rules.h"

namespace adasplats {
namespace {

constexpr std::size_t kMinReturns = 10'000;
constexpr std::size_t kMinOfLaser = 500;  // otherwise the laser gets the levels of all
constexpr std::size_t kMinOfLevel = 100;  // non-zero returns
/// Quantiles of the expected intensities of a laser, and of the levels of all: finer for dark
/// surfaces, which report zeros.
constexpr double kLaserParts[] = {0, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.97, 1};
constexpr double kLevelParts[] = {0,    0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13,
                                  0.17, 0.22, 0.3,  0.4,  0.55, 0.75, 0.9, 1};

/// A return with a measured and an expected intensity.
struct KnownReturn {
  std::uint32_t beam;
  std::uint16_t ring;
  float expected, measured;
};

std::vector<KnownReturn> known_returns(std::span<const SensorBeam> beams, std::size_t rings) {
  std::vector<KnownReturn> known;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const SensorBeam& beam = beams[i];
    if (!beam.returned() || !beam.hit || beam.ring >= rings) continue;
    if (!std::isfinite(beam.intensity) || !std::isfinite(beam.expected_intensity)) continue;
    known.push_back(
        {static_cast<std::uint32_t>(i), beam.ring, beam.expected_intensity, beam.intensity});
  }
  return known;
}

/// The step that all values are multiples of; 0: none.
double step_of(std::vector<float> values) {
  constexpr std::size_t kMaxSteps = 4096;
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < 2 || values.size() > kMaxSteps) return 0;
  double step = 1e9;
  for (std::size_t i = 1; i < values.size(); ++i)
    step = std::min(step, static_cast<double>(values[i]) - static_cast<double>(values[i - 1]));
  // The widest span that is a whole number of steps gives the best estimate.
  const double span = static_cast<double>(values.back()) - static_cast<double>(values.front());
  step = span / std::round(span / step);
  for (const float value : values) {
    const double steps = static_cast<double>(value) / step;
    if (std::fabs(steps - std::round(steps)) > 0.02) return 0;
  }
  return std::round(step * 1e7) / 1e7;
}

/// Means of pairs sorted by the first value, one per part; the first values made to ascend.
struct PartMeans {
  std::vector<float> expected, measured;
};

PartMeans means_of_parts(std::vector<std::pair<float, float>>& pairs) {
  std::ranges::sort(pairs);
  PartMeans means;
  for (std::size_t part = 0; part + 1 < std::size(kLaserParts); ++part) {
    const auto at = [&](double share) {
      return static_cast<std::size_t>(share * static_cast<double>(pairs.size()));
    };
    const std::size_t begin = at(kLaserParts[part]);
    const std::size_t end = std::max(at(kLaserParts[part + 1]), begin + 1);
    double expected = 0, measured = 0;
    for (std::size_t i = begin; i < end; ++i) {
      expected += static_cast<double>(pairs[i].first);
      measured += static_cast<double>(pairs[i].second);
    }
    auto node = static_cast<float>(expected / static_cast<double>(end - begin));
    if (!means.expected.empty())
      node =
          std::max(node, means.expected.back() + 1e-4F * std::fabs(means.expected.back()) + 1e-6F);
    means.expected.push_back(node);
    means.measured.push_back(static_cast<float>(measured / static_cast<double>(end - begin)));
  }
  return means;
}

void fit_lasers(std::span<const KnownReturn> known, std::size_t rings, SensorIntensity& unit) {
  std::vector<std::vector<std::pair<float, float>>> of_ring(rings);
  std::vector<std::pair<float, float>> all;
  for (const KnownReturn& one : known) {
    of_ring[one.ring].emplace_back(one.expected, one.measured);
    all.emplace_back(one.expected, one.measured);
  }
  const PartMeans usual = means_of_parts(all);
  unit.ring_nodes = usual.expected.size();
  for (auto& pairs : of_ring) {
    const PartMeans means = pairs.size() < kMinOfLaser ? usual : means_of_parts(pairs);
    unit.ring_expected.insert(unit.ring_expected.end(), means.expected.begin(),
                              means.expected.end());
    unit.ring_level.insert(unit.ring_level.end(), means.measured.begin(), means.measured.end());
  }
}

/// Known returns by their level: parts [begins[k], begins[k + 1]) of `order`.
struct LevelParts {
  std::vector<float> levels;  ///< of known returns
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> begins;

  LevelParts(std::span<const KnownReturn> known, const SensorIntensity& unit) {
    const IntensityRules rules = intensity_rules(unit);
    levels.reserve(known.size());
    for (const KnownReturn& one : known) levels.push_back(level_of(rules, one.ring, one.expected));
    order.resize(known.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
      return levels[a] != levels[b] ? levels[a] < levels[b] : a < b;
    });
    for (const double share : kLevelParts)
      begins.push_back(static_cast<std::size_t>(share * static_cast<double>(known.size())));
  }
  std::size_t size() const { return begins.size() - 1; }
  std::span<const std::uint32_t> part(std::size_t k) const {
    return std::span(order).subspan(begins[k], begins[k + 1] - begins[k]);
  }
};

void fit_zeros(std::span<const KnownReturn> known, const LevelParts& parts, SensorIntensity& unit) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    double sum = 0, zeros = 0;
    for (const std::uint32_t i : parts.part(k)) {
      sum += static_cast<double>(parts.levels[i]);
      zeros += known[i].measured <= 0 ? 1 : 0;
    }
    const auto count = static_cast<double>(parts.part(k).size());
    auto level = static_cast<float>(sum / count);
    if (!unit.levels.empty())
      level = std::max(level, unit.levels.back() + 1e-4F * std::fabs(unit.levels.back()) + 1e-6F);
    unit.levels.push_back(level);
    unit.zero_share.push_back(static_cast<float>(zeros / count));
  }
}

/// The non-zero intensities of a part.
std::vector<double> reported_values(std::span<const KnownReturn> known,
                                    std::span<const std::uint32_t> part) {
  std::vector<double> values;
  for (const std::uint32_t i : part)
    if (known[i].measured > 0) values.push_back(static_cast<double>(known[i].measured));
  return values;
}

/// Undoes the rounding to steps with random numbers.
void spread_steps(std::vector<double>& values, double step) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += step * (Random(0, 0, i).uniform() - 0.5);
}

void fit_reported(std::span<const KnownReturn> known, const LevelParts& parts,
                  SensorIntensity& unit) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    std::vector<double> values = reported_values(known, parts.part(k));
    // A level with too few returns gets the values of the level before.
    if (values.size() < kMinOfLevel && k > 0) {
      for (std::size_t n = 0; n < kTextureNodes; ++n)
        unit.reported.push_back(unit.reported[unit.reported.size() - kTextureNodes]);
      continue;
    }
    spread_steps(values, unit.step);
    std::ranges::sort(values);
    const std::vector<float> ascending(values.begin(), values.end());
    for (std::uint32_t n = 0; n < kTextureNodes; ++n) {
      const auto share = static_cast<double>(texture_node(n));
      const double value = ascending.empty() ? unit.step : quantile_of(ascending, share);
      unit.reported.push_back(static_cast<float>(std::max(0.0, value)));
    }
  }
}

/// For each non-zero beam the share of the non-zero beams of its level that report less. Equal
/// values, common among neighbours, are ranked in the order of the beams.
std::vector<float> shares_below(std::size_t beams, std::span<const KnownReturn> known,
                                const LevelParts& parts) {
  std::vector<float> shares(beams, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    std::vector<std::uint32_t> order;
    for (const std::uint32_t i : parts.part(k))
      if (known[i].measured > 0) order.push_back(i);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
      return known[a].measured != known[b].measured ? known[a].measured < known[b].measured : a < b;
    });
    const auto count = static_cast<float>(order.size());
    for (std::size_t rank = 0; rank < order.size(); ++rank)
      shares[known[order[rank]].beam] = (static_cast<float>(rank) + 0.5F) / count;
  }
  return shares;
}

/// For each beam the share of the beams of its level that report zero before it.
std::vector<float> zero_shares(std::span<const SensorBeam> beams,
                               std::span<const KnownReturn> known, const LevelParts& parts,
                               const SensorIntensity& unit) {
  constexpr SharePatch kPatch = {4, 16};
  const GainTable zeros{unit.levels.data(), unit.zero_share.data(),
                        static_cast<std::uint32_t>(unit.levels.size())};
  std::vector<float> shares(beams.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto chance = static_cast<double>(gain_of(zeros, parts.levels[i]));
    shares[known[i].beam] = static_cast<float>(
        share_by_chance(beams[known[i].beam], chance, known[i].measured <= 0, kPatch, kPatch, 3));
  }
  return shares;
}

}  // namespace

std::optional<IntensityFit> fit_unit_intensity(std::span<const SensorBeam> beams,
                                               std::size_t rings) {
  const std::vector<KnownReturn> known = known_returns(beams, rings);
  if (known.size() < kMinReturns) return std::nullopt;
  std::vector<float> measured;
  measured.reserve(known.size());
  for (const KnownReturn& one : known) measured.push_back(one.measured);
  const auto [min, max] = std::ranges::minmax(measured);
  if (!(max > min)) return std::nullopt;
  IntensityFit fit;
  fit.unit.highest = static_cast<double>(max);
  fit.unit.step = step_of(std::move(measured));
  if (fit.unit.step > 0)
    fit.unit.highest = fit.unit.step * std::round(fit.unit.highest / fit.unit.step);
  fit_lasers(known, rings, fit.unit);
  const LevelParts parts(known, fit.unit);
  fit_zeros(known, parts, fit.unit);
  fit_reported(known, parts, fit.unit);
  fit.shares = shares_below(beams.size(), known, parts);
  damp_shares(beams, fit.unit, fit.shares);
  fit.zeros = zero_shares(beams, known, parts, fit.unit);
  return fit;
}

}  // namespace adasplats
