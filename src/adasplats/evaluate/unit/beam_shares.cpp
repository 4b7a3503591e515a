// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/unit/beam_shares.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "adasplats/evaluate/unit/fit_unit.h"
#include "adasplats/simulate/scan/intensity_rules.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxTriples = 400'000;

/// Share of the middle one of three, moved towards their mean. `keeps`: remaining part of its
/// distance.
float damped_share(float before, float share, float behind, double keeps) {
  const auto mean = static_cast<double>((before + share + behind) / 3);
  return static_cast<float>(mean + keeps * (static_cast<double>(share) - mean));
}

/// Three neighbours on one surface, and three others of their ring, half a turn away, whose shares
/// are applied to them.
struct SharedTriple {
  std::size_t first, other;
};

bool are_known(std::span<const float> shares, std::size_t begin, std::size_t end) {
  return std::all_of(shares.begin() + static_cast<std::ptrdiff_t>(begin),
                     shares.begin() + static_cast<std::ptrdiff_t>(end),
                     [](float share) { return share == share; });
}

std::vector<SharedTriple> triples_of(std::span<const SensorBeam> beams,
                                     std::span<const float> shares) {
  std::vector<SharedTriple> triples;
  for (std::size_t begin = 0, end = 0; begin < beams.size(); begin = end) {
    while (end < beams.size() && same_ring(beams[begin], beams[end])) ++end;
    const std::size_t half = (end - begin) / 2;
    for (std::size_t i = begin; i + 2 < begin + half && end - begin > 10; ++i) {
      const std::size_t other = i + half;
      if (on_one_surface(beams[i], beams[i + 1], beams[i + 2]) && are_known(shares, i, i + 3) &&
          other > begin && other + 4 < end && are_known(shares, other - 1, other + 4))
        triples.push_back({i, other});
    }
  }
  const std::size_t stride = triples.size() / kMaxTriples + 1;
  std::vector<SharedTriple> chosen;
  for (std::size_t k = 0; k < triples.size(); k += stride) chosen.push_back(triples[k]);
  return chosen;
}

}  // namespace

double damp_shares(std::span<const SensorBeam> beams, const SensorIntensity& unit,
                   std::vector<float>& shares) {
  constexpr std::size_t kMinTriples = 1000;
  constexpr int kHalvings = 6;
  constexpr double kOfAStep = 0.25;
  const std::vector<SharedTriple> triples = triples_of(beams, shares);
  if (triples.size() < kMinTriples) return 1;
  std::vector<float> measured;
  for (const SharedTriple& triple : triples) {
    const SensorBeam* const three = &beams[triple.first];
    measured.push_back(
        second_difference(three[0].intensity, three[1].intensity, three[2].intensity));
  }
  const double noise = noise_of_second_differences(measured);
  const IntensityRules rules = intensity_rules(unit);
  const auto noise_with = [&](double keeps) {
    std::vector<float> made;
    for (const SharedTriple& triple : triples) {
      float values[3] = {};
      for (std::size_t k = 0; k < 3; ++k) {
        const SensorBeam& beam = beams[triple.first + k];
        const float* const share = &shares[triple.other + k];
        values[k] = converted(
            rules,
            textured(rules, level_of(rules, beam.ring, beam.expected_intensity),
                     static_cast<double>(damped_share(share[-1], share[0], share[1], keeps))));
      }
      made.push_back(second_difference(values[0], values[1], values[2]));
    }
    return noise_of_second_differences(made);
  };
  // Differences below a fraction of the converter's step are ignored.
  if (noise_with(1) <= noise + kOfAStep * unit.step) return 1;
  double low = 0, high = 1;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (low + high) / 2;
    (noise_with(middle) > noise ? high : low) = middle;
  }
  const std::vector<float> before = shares;
  for (std::size_t i = 1; i + 1 < shares.size(); ++i)
    if (same_ring(beams[i - 1], beams[i + 1]) && are_known(before, i - 1, i + 2))
      shares[i] = damped_share(before[i - 1], before[i], before[i + 1], low);
  return low;
}

}  // namespace adasplats
