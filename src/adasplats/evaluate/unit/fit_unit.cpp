// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/unit/fit_unit.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "adasplats/core/constants.h"
#include "adasplats/evaluate/realism/scan_part.h"

namespace adasplats {
namespace {

constexpr float kOneSurface_m = 0.3F;  // as on_one_surface()
constexpr float kSmooth_m = 0.02F;     // second difference of the model: no edge, no bend
constexpr std::size_t kMinOfRing = 300;
/// The middle half of second differences of white noise has this mean (see features.cpp).
constexpr double kMiddleHalf = 0.6933 * 2.449489742783178;

/// Whether three beams hit one surface in the model.
bool is_one_in_model(const SensorBeam& a, const SensorBeam& b, const SensorBeam& c) {
  return a.hit && b.hit && c.hit && std::fabs(b.expected_m - a.expected_m) < kOneSurface_m &&
         std::fabs(c.expected_m - b.expected_m) < kOneSurface_m;
}

std::size_t places_of(std::span<const SensorBeam> beams) {
  std::set<std::uint32_t> places;
  for (const SensorBeam& beam : beams) places.insert(beam.place);
  return places.size();
}

}  // namespace

double noise_of_second_differences(std::vector<float>& second) {
  if (second.empty()) return 0;
  std::ranges::sort(second);
  return mean_between(second, 0.25, 0.75) / kMiddleHalf;
}

std::vector<double> fit_ring_noise_m(std::span<const SensorBeam> beams, std::size_t rings) {
  constexpr double kMinNoise_m = 1e-4;
  std::vector<std::vector<float>> measured(rings), modelled(rings);
  for (std::size_t i = 0; i + 2 < beams.size(); ++i) {
    const SensorBeam* const three = &beams[i];
    if (three->ring >= rings || !on_one_surface(three[0], three[1], three[2]) ||
        !is_one_in_model(three[0], three[1], three[2]))
      continue;
    const float of_model =
        second_difference(three[0].expected_m, three[1].expected_m, three[2].expected_m);
    if (of_model > kSmooth_m) continue;
    modelled[three->ring].push_back(of_model);
    measured[three->ring].push_back(
        second_difference(three[0].range_m, three[1].range_m, three[2].range_m));
  }
  std::vector<double> noise_m(rings, kNaN);
  std::vector<double> known;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    if (measured[ring].size() < kMinOfRing) continue;
    const double all_m = noise_of_second_differences(measured[ring]);
    const double of_model_m = noise_of_second_differences(modelled[ring]);
    noise_m[ring] =
        std::sqrt(std::max(all_m * all_m - of_model_m * of_model_m, kMinNoise_m * kMinNoise_m));
    known.push_back(noise_m[ring]);
  }
  if (4 * known.size() < rings) return {};
  const double usual_m = median_of_known(known);
  for (double& one_m : noise_m)
    if (one_m != one_m) one_m = usual_m;
  return noise_m;
}

std::optional<double> fit_max_range_m(std::span<const SensorBeam> beams) {
  constexpr std::size_t kMinBeyond = 200;
  float farthest_m = 0;
  for (const SensorBeam& beam : beams)
    if (beam.returned()) farthest_m = std::max(farthest_m, beam.range_m);
  const auto beyond = static_cast<std::size_t>(std::ranges::count_if(
      beams, [&](const SensorBeam& beam) { return beam.hit && beam.expected_m > farthest_m + 1; }));
  if (beyond < kMinBeyond) return std::nullopt;
  return std::ceil(static_cast<double>(farthest_m) * 10 - 1e-6) / 10;
}

UnitFit fit_unit(std::span<const SensorBeam> beams, const UnitPattern& pattern) {
  UnitFit fit;
  const std::size_t rings = pattern.rings;
  fit.max_range_m = fit_max_range_m(beams);
  fit.ring_noise_m = fit_ring_noise_m(beams, rings);
  if (fit.ring_noise_m.empty())
    fit.not_estimated.emplace_back(
        "range noise: fewer than a quarter of the rings have 300 neighbouring returns on smooth "
        "surfaces of the model");
  std::optional<IntensityFit> intensity = fit_unit_intensity(beams, rings);
  if (!intensity)
    fit.not_estimated.emplace_back(
        "intensities: fewer than 10,000 returns with an intensity meet the model where it has "
        "one, or all are alike");
  std::optional<DropFit> drop = fit_unit_drop(beams, fit.max_range_m.value_or(pattern.max_range_m));
  if (places_of(beams) < kMinBlockedPlaces)
    fit.not_estimated.emplace_back(
        "the vehicle's body, and directions that it blocks: the scans are from fewer than three "
        "places 2 m apart");
  fit.body = fit_vehicle_body(beams);
  if (!drop)
    fit.not_estimated.emplace_back(
        "drop-outs: fewer than 100 beams that met the model did not return, or did");
  if (!fit.ring_noise_m.empty() || intensity || drop)
    fit.fields = fit_unit_fields(
        beams, pattern, fit.ring_noise_m,
        {drop ? std::span<const float>(drop->shares) : std::span<float>(),
         intensity ? std::span<const float>(intensity->shares) : std::span<float>(),
         intensity ? std::span<const float>(intensity->zeros) : std::span<float>()});
  if (intensity) fit.intensity = std::move(intensity->unit);
  if (drop) fit.drop = std::move(drop->model);
  return fit;
}

}  // namespace adasplats
