// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/unit/fit_unit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/realism/scan_part.h"
#include "adasplats/evaluate/unit/field_fit.h"

namespace adasplats {
namespace {

constexpr float kOneSurface_m = 0.3F;  // as on_one_surface()
constexpr float kSmooth_m = 0.02F;     // second difference of the model: no edge, no bend
constexpr std::size_t kLeastOfRing = 300;
/// The middle half of second differences of white noise has this mean (see features.cpp).
constexpr double kMiddleHalf = 0.6933 * 2.449489742783178;

/// Likewise in the model.
bool modelled_as_one(const UnitBeam& a, const UnitBeam& b, const UnitBeam& c) {
  return a.hit && b.hit && c.hit && std::fabs(b.expected_m - a.expected_m) < kOneSurface_m &&
         std::fabs(c.expected_m - b.expected_m) < kOneSurface_m;
}

float second_difference(float a, float b, float c) { return std::fabs(a - 2 * b + c); }

double deviation_of(std::vector<float>& second) {
  std::ranges::sort(second);
  return mean_between(second, 0.25, 0.75) / kMiddleHalf;
}

}  // namespace

std::vector<double> fit_ring_noise_m(std::span<const UnitBeam> beams, std::size_t rings) {
  constexpr double kLeast_m = 1e-4;
  std::vector<std::vector<float>> measured(rings), modelled(rings);
  for (std::size_t i = 0; i + 2 < beams.size(); ++i) {
    const UnitBeam* const three = &beams[i];
    if (three->ring >= rings || !on_one_surface(three[0], three[1], three[2]) ||
        !modelled_as_one(three[0], three[1], three[2]))
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
    if (measured[ring].size() < kLeastOfRing) continue;
    const double all_m = deviation_of(measured[ring]), of_model_m = deviation_of(modelled[ring]);
    noise_m[ring] =
        std::sqrt(std::max(all_m * all_m - of_model_m * of_model_m, kLeast_m * kLeast_m));
    known.push_back(noise_m[ring]);
  }
  if (4 * known.size() < rings) return {};
  const double usual_m = median_of_known(known);
  for (double& one_m : noise_m)
    if (one_m != one_m) one_m = usual_m;
  return noise_m;
}

std::optional<double> fit_max_range_m(std::span<const UnitBeam> beams) {
  constexpr std::size_t kLeastBeyond = 200;
  float farthest_m = 0;
  for (const UnitBeam& beam : beams)
    if (beam.returned()) farthest_m = std::max(farthest_m, beam.range_m);
  const auto beyond = static_cast<std::size_t>(std::ranges::count_if(
      beams, [&](const UnitBeam& beam) { return beam.hit && beam.expected_m > farthest_m + 1; }));
  if (beyond < kLeastBeyond) return std::nullopt;
  return std::ceil(static_cast<double>(farthest_m) * 10 - 1e-6) / 10;
}

std::optional<RayDropModel> fit_unit_drop(std::span<const UnitBeam> beams, double max_range_m) {
  BeamEchoes echoes;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const UnitBeam& beam = beams[i];
    if (!beam.hit || !(static_cast<double>(beam.expected_m) < max_range_m)) continue;
    echoes.echoes.push_back(
        {beam.expected_m, beam.cos_incidence, beam.reflectance, beam.direction});
    echoes.hit.push_back(1);
    echoes.lost.push_back(beam.returned() ? 0 : 1);
    echoes.scans.push_back(beam.scan);
    numbers.push_back(i);
  }
  std::optional<RayDropModel> model;
  try {
    model = fit_ray_drop(echoes);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::data) throw;
    return std::nullopt;
  }
  std::vector<double> chances(beams.size(), kNaN);
  std::vector<std::uint8_t> lost(beams.size(), 0);
  const DropRules rules = model->rules();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const EchoConditions& echo = echoes.echoes[k];
    if (model->blocks(echo.direction)) continue;
    chances[numbers[k]] = drop_chance(rules, echo.range_m, echo.cos_incidence, echo.reflectance);
    lost[numbers[k]] = echoes.lost[k];
  }
  model->field = shares_of(latent_correlations(beams, chances, lost));
  return model;
}

UnitFit fit_unit(std::span<const UnitBeam> beams, std::size_t rings, double max_range_m) {
  UnitFit fit;
  fit.max_range_m = fit_max_range_m(beams);
  fit.ring_noise_m = fit_ring_noise_m(beams, rings);
  if (fit.ring_noise_m.empty())
    fit.not_told.emplace_back(
        "range noise: fewer than a quarter of the rings have 300 neighbouring returns on smooth "
        "surfaces of the model");
  fit.intensity = fit_unit_intensity(beams, rings);
  if (!fit.intensity)
    fit.not_told.emplace_back(
        "intensities: fewer than 10,000 returns with an intensity meet the model where it has "
        "one, or all are alike");
  fit.drop = fit_unit_drop(beams, fit.max_range_m.value_or(max_range_m));
  if (!fit.drop)
    fit.not_told.emplace_back(
        "drop-outs: fewer than 100 beams that met the model did not return, or did");
  return fit;
}

}  // namespace adasplats
