// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What a unit reports as intensity: levels of its lasers, zeros, texture.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/realism/scan_part.h"
#include "adasplats/evaluate/unit/field_fit.h"
#include "adasplats/evaluate/unit/fit_unit.h"
#include "adasplats/simulate/scan/intensity_rules.h"

namespace adasplats {
namespace {

constexpr std::size_t kLeastReturns = 10'000;
constexpr std::size_t kLeastOfLaser = 500;  // else it has the levels of all
constexpr std::size_t kLeastOfLevel = 100;  // that do not report zero
/// Parts of the expected intensities of a laser, and of the levels of all: finer where it is dark,
/// since zeros are there.
constexpr double kLaserParts[] = {0, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.97, 1};
constexpr double kLevelParts[] = {0,    0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13,
                                  0.17, 0.22, 0.3,  0.4,  0.55, 0.75, 0.9, 1};

/// A return of which both intensities are known.
struct KnownReturn {
  std::uint32_t beam;
  std::uint16_t ring;
  float expected, measured;
};

std::vector<KnownReturn> known_returns(std::span<const UnitBeam> beams, std::size_t rings) {
  std::vector<KnownReturn> known;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const UnitBeam& beam = beams[i];
    if (!beam.returned() || !beam.hit || beam.ring >= rings) continue;
    if (!std::isfinite(beam.intensity) || !std::isfinite(beam.expected_intensity)) continue;
    known.push_back(
        {static_cast<std::uint32_t>(i), beam.ring, beam.expected_intensity, beam.intensity});
  }
  return known;
}

/// The step that all values are multiples of; 0: there is none.
double step_of(std::vector<float> values) {
  constexpr std::size_t kMostSteps = 4096;
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < 2 || values.size() > kMostSteps) return 0;
  double step = 1e9;
  for (std::size_t i = 1; i < values.size(); ++i)
    step = std::min(step, static_cast<double>(values[i]) - static_cast<double>(values[i - 1]));
  // The widest span that is a whole number of steps says it best.
  const double span = static_cast<double>(values.back()) - static_cast<double>(values.front());
  step = span / std::round(span / step);
  for (const float value : values) {
    const double steps = static_cast<double>(value) / step;
    if (std::fabs(steps - std::round(steps)) > 0.02) return 0;
  }
  return std::round(step * 1e7) / 1e7;
}

/// Means of pairs sorted by the first, one of each part; the firsts made to ascend.
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

void fit_lasers(std::span<const KnownReturn> known, std::size_t rings, UnitIntensity& unit) {
  std::vector<std::vector<std::pair<float, float>>> of_ring(rings);
  std::vector<std::pair<float, float>> all;
  for (const KnownReturn& one : known) {
    of_ring[one.ring].emplace_back(one.expected, one.measured);
    all.emplace_back(one.expected, one.measured);
  }
  const PartMeans usual = means_of_parts(all);
  unit.ring_nodes = usual.expected.size();
  for (auto& pairs : of_ring) {
    const PartMeans means = pairs.size() < kLeastOfLaser ? usual : means_of_parts(pairs);
    unit.ring_expected.insert(unit.ring_expected.end(), means.expected.begin(),
                              means.expected.end());
    unit.ring_level.insert(unit.ring_level.end(), means.measured.begin(), means.measured.end());
  }
}

IntensityRules rules_of(const UnitIntensity& unit) {
  IntensityRules rules;
  rules.on = true;
  rules.ring_nodes = static_cast<std::uint32_t>(unit.ring_nodes);
  rules.rings = static_cast<std::uint32_t>(unit.ring_expected.size() / unit.ring_nodes);
  rules.ring_expected = unit.ring_expected.data();
  rules.ring_level = unit.ring_level.data();
  return rules;
}

/// Known returns by their level: parts [begins[k], begins[k + 1]) of `order`.
struct LevelParts {
  std::vector<float> levels;  ///< of known returns
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> begins;

  LevelParts(std::span<const KnownReturn> known, const UnitIntensity& unit) {
    const IntensityRules rules = rules_of(unit);
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

void fit_zeros(std::span<const UnitBeam> beams, std::span<const KnownReturn> known,
               const LevelParts& parts, UnitIntensity& unit) {
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
  std::vector<double> chances(beams.size(), kNaN);
  std::vector<std::uint8_t> zero(beams.size(), 0);
  const GainTable table{unit.levels.data(), unit.zero_share.data(),
                        static_cast<std::uint32_t>(unit.levels.size())};
  for (std::size_t i = 0; i < known.size(); ++i) {
    chances[known[i].beam] = static_cast<double>(gain_of(table, parts.levels[i]));
    zero[known[i].beam] = known[i].measured <= 0 ? 1 : 0;
  }
  unit.zero_field = shares_of(latent_correlations(beams, chances, zero));
}

/// Numbers of a standard normal distribution in the order of `values`.
std::vector<double> normal_scores(std::span<const double> values) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  constexpr std::size_t kSteps = 2000;
  std::vector<double> table(kSteps);
  for (std::size_t k = 0; k < kSteps; ++k)
    table[k] = normal_quantile((static_cast<double>(k) + 0.5) / kSteps);
  std::vector<double> scores(values.size());
  for (std::size_t rank = 0; rank < order.size(); ++rank)
    scores[order[rank]] = table[rank * kSteps / order.size()];
  return scores;
}

/// How even the white part of numbers along a ring is: the mean middle half of their second
/// differences over the root of the mean square. Less where few large ones are among small ones.
double evenness_of(std::vector<double> second) {
  if (second.empty()) return 0;
  double squares = 0;
  for (const double value : second) squares += value * value;
  std::ranges::sort(second);
  const std::vector<float> ascending(second.begin(), second.end());
  return mean_between(ascending, 0.25, 0.75) /
         std::sqrt(squares / static_cast<double>(second.size()));
}

/// Texture fields of a scan that nobody measured, ring by ring.
constexpr std::uint32_t kDrawnRings = 64, kDrawnColumns = 2000;

std::vector<double> drawn_textures(const UnitIntensity& unit, double unevenness) {
  const FieldWeights weights = field_weights(unit.texture_field);
  std::vector<double> values;
  values.reserve(std::size_t{kDrawnRings} * kDrawnColumns);
  for (std::uint32_t ring = 0; ring < kDrawnRings; ++ring)
    for (std::uint32_t column = 0; column < kDrawnColumns; ++column)
      values.push_back(texture_value(beam_field_parts(0, 0, ring, column), weights, unevenness, 1));
  return values;
}

double drawn_evenness(const UnitIntensity& unit, double unevenness) {
  const std::vector<double> scores = normal_scores(drawn_textures(unit, unevenness));
  std::vector<double> second;
  for (std::size_t i = 0; i + 2 < scores.size(); ++i)
    if (i / kDrawnColumns == (i + 2) / kDrawnColumns)
      second.push_back(std::fabs(scores[i] - 2 * scores[i + 1] + scores[i + 2]));
  return evenness_of(std::move(second));
}

double fit_unevenness(const UnitIntensity& unit, double evenness) {
  double low = 0, high = 2;
  if (drawn_evenness(unit, low) <= evenness) return low;
  for (int k = 0; k < 6; ++k) {
    const double middle = 0.5 * (low + high);
    (drawn_evenness(unit, middle) > evenness ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// How much rings differ in the middle half of their second differences, about 1.
std::vector<float> amplitudes_of(std::vector<std::vector<float>>& of_rings) {
  std::vector<double> middles;
  for (std::vector<float>& second : of_rings) {
    std::ranges::sort(second);
    middles.push_back(second.size() < kLeastOfLaser ? kNaN : mean_between(second, 0.25, 0.75));
  }
  const double usual = median_of_known(middles);
  std::vector<float> amplitudes;
  for (const double middle : middles) {
    const bool known = middle == middle && usual > 0;
    amplitudes.push_back(known ? static_cast<float>(std::clamp(middle / usual, 0.3, 3.0)) : 1.0F);
  }
  return amplitudes;
}

/// What the returns of a part report that do not report zero.
std::vector<double> reported_values(std::span<const KnownReturn> known,
                                    std::span<const std::uint32_t> part) {
  std::vector<double> values;
  for (const std::uint32_t i : part)
    if (known[i].measured > 0) values.push_back(static_cast<double>(known[i].measured));
  return values;
}

/// Numbers in steps, as they were before.
void spread_steps(std::vector<double>& values, double step) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += step * (Random(0, 0, i).uniform() - 0.5);
}

void fit_texture(std::span<const UnitBeam> beams, std::span<const KnownReturn> known,
                 const LevelParts& parts, UnitIntensity& unit) {
  std::vector<double> scores(beams.size(), kNaN);
  std::vector<std::vector<double>> values(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    // Equal ones, as neighbours often are, have scores in the order of the beams, side by side.
    std::vector<std::uint32_t> in_order(parts.part(k).begin(), parts.part(k).end());
    std::ranges::sort(in_order);
    values[k] = reported_values(known, in_order);
    const std::vector<double> of_part = normal_scores(values[k]);
    std::size_t next = 0;
    for (const std::uint32_t i : in_order)
      if (known[i].measured > 0) scores[known[i].beam] = of_part[next++];
  }
  unit.texture_field = shares_of(lag_products(beams, scores));
  std::vector<double> second;
  std::vector<std::vector<float>> of_rings(unit.ring_expected.size() / unit.ring_nodes);
  for (std::size_t i = 0; i + 2 < beams.size(); ++i) {
    if (!on_one_surface(beams[i], beams[i + 1], beams[i + 2])) continue;
    const double of_three = std::fabs(scores[i] - 2 * scores[i + 1] + scores[i + 2]);
    if (of_three != of_three) continue;
    second.push_back(of_three);
    of_rings[beams[i].ring].push_back(static_cast<float>(of_three));
  }
  unit.ring_texture = amplitudes_of(of_rings);
  unit.texture_unevenness = std::round(1e3 * fit_unevenness(unit, evenness_of(second))) / 1e3;
  std::vector<double> drawn = drawn_textures(unit, unit.texture_unevenness);
  std::ranges::sort(drawn);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    // A level with too few has what the one before it has, the first that of the next.
    if (values[k].size() < kLeastOfLevel && k > 0) {
      for (std::size_t n = 0; n < kTextureNodes; ++n)
        unit.reported.push_back(unit.reported[unit.reported.size() - kTextureNodes]);
      continue;
    }
    spread_steps(values[k], unit.step);
    std::ranges::sort(values[k]);
    const std::vector<float> ascending(values[k].begin(), values[k].end());
    for (std::uint32_t n = 0; n < kTextureNodes; ++n) {
      const auto node = static_cast<double>(texture_node(n));
      const auto below = std::ranges::lower_bound(drawn, node) - drawn.begin();
      const double share = static_cast<double>(below) / static_cast<double>(drawn.size());
      const double value = ascending.empty() ? unit.step : quantile_of(ascending, share);
      unit.reported.push_back(static_cast<float>(std::max(0.0, value)));
    }
  }
}

}  // namespace

std::optional<UnitIntensity> fit_unit_intensity(std::span<const UnitBeam> beams,
                                                std::size_t rings) {
  const std::vector<KnownReturn> known = known_returns(beams, rings);
  if (known.size() < kLeastReturns) return std::nullopt;
  std::vector<float> measured;
  measured.reserve(known.size());
  for (const KnownReturn& one : known) measured.push_back(one.measured);
  const auto [least, most] = std::ranges::minmax(measured);
  if (!(most > least)) return std::nullopt;
  UnitIntensity unit;
  unit.highest = static_cast<double>(most);
  unit.step = step_of(std::move(measured));
  if (unit.step > 0) unit.highest = unit.step * std::round(unit.highest / unit.step);
  fit_lasers(known, rings, unit);
  const LevelParts parts(known, unit);
  fit_zeros(beams, known, parts, unit);
  fit_texture(beams, known, parts, unit);
  return unit;
}

}  // namespace adasplats
