// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/returns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {

namespace {

/// What came back along one sub-ray.
struct Echo {
  float range_m;
  float weight;
  std::uint32_t primitive;
  std::uint32_t ray;
  std::uint16_t class_id;
};

/// A pulse that the receiver sees as one: echoes of one class, one after the other.
struct Pulse {
  float first_m;  ///< its rising edge
  float last_m;   ///< of its last echo so far
  float energy;   ///< of all its echoes
  std::uint16_t class_id;
};

std::uint16_t class_of(std::uint32_t primitive, std::span<const std::uint16_t> classes) {
  if (classes.empty()) return 0;
  if (primitive >= classes.size())
    throw std::logic_error("an attribute has fewer values than the scene has primitives");
  return classes[primitive];
}

bool apart(float near_m, float far_m, double most_m) {
  return static_cast<double>(far_m) - static_cast<double>(near_m) > most_m;
}

/// How many of the hits of one ray are averaged: D' of kernel_mean().
std::size_t overlapping_hits(std::span<const Hit> hits, std::span<const std::uint16_t> classes,
                             double depth_gap_m) {
  if (hits.size() == 1) return 1;
  std::size_t count = 1;
  const std::uint16_t first_class = class_of(hits[0].primitive, classes);
  while (count < hits.size() && hits[count].valid() &&
         !apart(hits[count - 1].t, hits[count].t, depth_gap_m) &&
         class_of(hits[count].primitive, classes) == first_class)
    ++count;
  return count;
}

/// The weighted mean of the paper (section "SimKITTI32"): P = sum(beta_i P_i) / sum(beta_i), beta_i
/// = exp(-|d_i - D/2| / (D/2)). Read so: d_i counts the hits of the ray from 1, and D is the number
/// of hits that are averaged ("we reset D to the maximum number of intersections"), not the depth
/// that was asked for. Averaged are the first hit and those after it for as long as they are of its
/// class and within the gap of the one before. All are on one ray, so the mean of the points is
/// that of the ranges. `primitive` is that of the greatest weight, of two the nearer.
Hit kernel_mean(std::span<const Hit> hits) {
  if (hits.size() == 1) return hits[0];  // beta_1 / beta_1: the hit itself to the last bit
  const double half = static_cast<double>(hits.size()) / 2.0;
  double sum = 0;
  double weight_sum = 0;
  double greatest = 0;
  Hit mean;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double beta = std::exp(-std::fabs(static_cast<double>(i + 1) - half) / half);
    sum += beta * static_cast<double>(hits[i].t);
    weight_sum += beta;
    if (beta > greatest) mean.primitive = hits[i].primitive;
    greatest = std::max(greatest, beta);
  }
  mean.t = static_cast<float>(sum / weight_sum);
  return mean;
}

/// The echoes of a firing by range, those at the same range by ray.
std::span<const Echo> echoes_of(std::span<const Hit> hits, std::span<const float> weights,
                                std::span<const std::uint16_t> classes, const BeamOptions& options,
                                std::array<Echo, kMostSubRays>& buffer) {
  const auto depth = static_cast<std::size_t>(options.depth);
  std::size_t count = 0;
  for (std::size_t ray = 0; ray < weights.size(); ++ray) {
    const auto of_ray = hits.subspan(ray * depth, depth);
    if (!of_ray[0].valid()) continue;
    const Hit mean =
        kernel_mean(of_ray.first(overlapping_hits(of_ray, classes, options.depth_gap_m)));
    buffer[count++] = {mean.t, weights[ray], mean.primitive, static_cast<std::uint32_t>(ray),
                       class_of(mean.primitive, classes)};
  }
  const auto echoes = std::span(buffer).first(count);
  std::ranges::sort(echoes, [](const Echo& a, const Echo& b) {
    return a.range_m < b.range_m || (a.range_m == b.range_m && a.ray < b.ray);
  });
  return echoes;
}

/// The primitive with the most energy among echoes[i] with belongs(i), of two the nearer.
template <class F>
std::uint32_t strongest_primitive(std::span<const Echo> echoes, F&& belongs) {
  std::uint32_t strongest = Hit::kNone;
  float greatest = -1;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (!belongs(i)) continue;
    float energy = 0;
    for (std::size_t j = 0; j < echoes.size(); ++j)
      if (belongs(j) && echoes[j].primitive == echoes[i].primitive) energy += echoes[j].weight;
    if (energy > greatest) strongest = echoes[i].primitive;
    greatest = std::max(greatest, energy);
  }
  return strongest;
}

/// A receiver triggers on the rising edge: what comes later than the gap after the first echo of a
/// pulse adds to its energy, not to its range.
Return return_of(const Pulse& pulse, std::size_t number, std::span<const Echo> echoes,
                 std::span<const std::uint8_t> pulse_of, double depth_gap_m) {
  const auto on_edge = [&](std::size_t i) {
    return pulse_of[i] == number && !apart(pulse.first_m, echoes[i].range_m, depth_gap_m);
  };
  double sum = 0;
  double weight_sum = 0;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (!on_edge(i)) continue;
    sum += static_cast<double>(echoes[i].weight) * static_cast<double>(echoes[i].range_m);
    weight_sum += static_cast<double>(echoes[i].weight);
  }
  // Weights may be zero where the beam has no energy: the edge itself is then all that is known.
  const float range_m = weight_sum > 0 ? static_cast<float>(sum / weight_sum) : pulse.first_m;
  return {range_m, strongest_primitive(echoes, on_edge), pulse.energy};
}

/// The pulses of the echoes as returns, by range. An echo belongs to the pulse of its class that
/// the one before it did: where two classes share a range, each keeps one pulse.
std::size_t pulses_of(std::span<const Echo> echoes, const BeamOptions& options,
                      std::array<Return, kMostSubRays>& returns) {
  std::array<Pulse, kMostSubRays> pulses;             // NOLINT: filled as far as it is read
  std::array<std::uint8_t, kMostSubRays> pulse_of{};  // of each echo
  std::size_t count = 0;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const Echo& echo = echoes[i];
    std::size_t pulse = 0;
    while (pulse < count && (pulses[pulse].class_id != echo.class_id ||
                             apart(pulses[pulse].last_m, echo.range_m, options.separation_m)))
      ++pulse;
    if (pulse == count) pulses[count++] = {echo.range_m, echo.range_m, 0, echo.class_id};
    pulses[pulse].last_m = echo.range_m;
    pulses[pulse].energy += echo.weight;
    pulse_of[i] = static_cast<std::uint8_t>(pulse);
  }
  for (std::size_t i = 0; i < count; ++i)
    returns[i] = return_of(pulses[i], i, echoes, std::span(pulse_of).first(echoes.size()),
                           options.depth_gap_m);
  // Pulses began by range, but the means of two that overlap may be the other way round.
  std::ranges::stable_sort(std::span(returns).first(count), {}, &Return::range_m);
  return count;
}

/// The place among `left` (ascending) of what is reported after the `reported` ones.
std::size_t next_reported(std::span<const Return> reported, std::span<const Return> left,
                          ReturnMode mode) {
  if (mode == ReturnMode::first) return 0;
  if (mode == ReturnMode::last) return left.size() - 1;
  if (reported.size() == 1 && left.back().range_m > reported[0].range_m) return left.size() - 1;
  std::size_t strongest = 0;
  for (std::size_t i = 1; i < left.size(); ++i)
    if (left[i].energy > left[strongest].energy) strongest = i;
  return strongest;
}

/// How many sub-rays stand on each ring around the axis: about 6, 12, 18, ... as on a hexagonal
/// grid, so that each stands for about the same area.
std::vector<int> ring_sizes(int around) {
  int rings = 1;
  while (3 * (rings + 1) * (rings + 2) <= around) ++rings;
  std::vector<int> sizes;
  const int all = rings * (rings + 1) / 2;
  int before = 0;
  for (int ring = 1; ring <= rings; ++ring) {
    const int until = around * (ring * (ring + 1) / 2) / all;
    sizes.push_back(until - before);
    before = until;
  }
  return sizes;
}

/// Where a sub-ray leaves the axis, in units of the ellipse's semi-axes.
struct CrossSectionPlace {
  double horizontal;
  double vertical;
};

std::vector<CrossSectionPlace> places_of(int sub_rays) {
  std::vector<CrossSectionPlace> places{{0, 0}};
  if (sub_rays == 1) return places;
  const std::vector<int> sizes = ring_sizes(sub_rays - 1);
  // Ring k stands in the middle of the annulus from (2k - 1) to (2k + 1) of 2n + 1 equal steps.
  const double step = 1.0 / static_cast<double>(2 * sizes.size() + 1);
  for (std::size_t ring = 1; ring <= sizes.size(); ++ring) {
    const double radius = 2.0 * static_cast<double>(ring) * step;
    for (int i = 0; i < sizes[ring - 1]; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / sizes[ring - 1];
      places.push_back({radius * std::cos(turn), radius * std::sin(turn)});
    }
  }
  return places;
}

Vec3f leaning(Vec3f axis, double horizontal_rad, double vertical_rad) {
  const Vec3d d = vec_cast<double>(axis);
  const Vec3d flat = cross(Vec3d{0, 0, 1}, d);
  const Vec3d sideways = dot(flat, flat) > 1e-12 ? normalized(flat) : Vec3d{0, 1, 0};
  const Vec3d upwards = cross(d, sideways);
  return vec_cast<float>(
      normalized(d + std::tan(horizontal_rad) * sideways + std::tan(vertical_rad) * upwards));
}

}  // namespace

void check_beam(const BeamOptions& options, const LidarModel& sensor) {
  check_settings(options);
  if (options.sub_rays == 1) return;
  if (options.sub_rays == 2)
    throw Error(ErrorKind::usage,
                "2 sub-rays cannot stand evenly around the beam's axis, expected 1, or 3 or more");
  if (!(sensor.divergence_rad[0] >= 0 && sensor.divergence_rad[1] >= 0 &&
        sensor.divergence_rad[0] + sensor.divergence_rad[1] > 0))
    throw Error(ErrorKind::usage,
                std::to_string(options.sub_rays) +
                    " sub-rays need the divergence of the beam, and the sensor '" + sensor.name +
                    "' has none");
}

std::vector<Firing> sub_firings(const LidarModel& sensor, std::span<const Firing> firings,
                                const BeamOptions& options) {
  check_beam(options, sensor);
  if (options.sub_rays == 1) return {firings.begin(), firings.end()};
  const std::vector<CrossSectionPlace> places = places_of(options.sub_rays);
  std::vector<Firing> rays;
  rays.reserve(firings.size() * places.size());
  for (const Firing& firing : firings) {
    rays.push_back(firing);
    for (std::size_t i = 1; i < places.size(); ++i) {
      rays.push_back(firing);
      rays.back().direction =
          leaning(firing.direction, 0.5 * sensor.divergence_rad[0] * places[i].horizontal,
                  0.5 * sensor.divergence_rad[1] * places[i].vertical);
    }
  }
  return rays;
}

std::vector<float> sub_ray_weights(const BeamOptions& options) {
  if (options.sub_rays == 1) return {1.0F};
  const std::vector<int> sizes = ring_sizes(options.sub_rays - 1);
  const double step = 1.0 / static_cast<double>(2 * sizes.size() + 1);
  // A Gaussian beam has 1 - exp(-2 r^2) of its energy within r of its 1/e^2 radii.
  const auto outside = [&](std::size_t steps) {
    const double radius = step * static_cast<double>(steps);
    return std::exp(-2.0 * radius * radius);
  };
  const double all = 1.0 - outside(2 * sizes.size() + 1);
  std::vector<float> weights{static_cast<float>((1.0 - outside(1)) / all)};
  for (std::size_t ring = 1; ring <= sizes.size(); ++ring) {
    const double energy = (outside(2 * ring - 1) - outside(2 * ring + 1)) / all;
    weights.insert(weights.end(), static_cast<std::size_t>(sizes[ring - 1]),
                   static_cast<float>(energy / sizes[ring - 1]));
  }
  return weights;
}

std::size_t reported_returns(std::span<Return> pulses, const BeamOptions& options) {
  auto left = pulses;
  std::size_t reported = 0;
  while (!left.empty() && reported < static_cast<std::size_t>(options.returns)) {
    const std::size_t next = next_reported(pulses.first(reported), left, options.mode);
    std::rotate(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(next),
                left.begin() + static_cast<std::ptrdiff_t>(next) + 1);
    const Return chosen = left[0];
    ++reported;
    left = left.subspan(1);
    // What the receiver cannot separate from the chosen one is no return of its own.
    const auto kept_end = std::remove_if(left.begin(), left.end(), [&](const Return& other) {
      const auto [near_m, far_m] = std::minmax(chosen.range_m, other.range_m);
      return !apart(near_m, far_m, options.separation_m);
    });
    left = left.first(static_cast<std::size_t>(kept_end - left.begin()));
  }
  return reported;
}

std::size_t returns_of(std::span<const Hit> hits, std::span<const float> weights,
                       std::span<const std::uint16_t> classes, const BeamOptions& options,
                       std::span<Return> out) {
  if (weights.size() == 1) {  // one ray: what nearly all scans are
    if (!hits[0].valid()) return 0;
    const Hit mean = kernel_mean(hits.first(overlapping_hits(hits, classes, options.depth_gap_m)));
    out[0] = {mean.t, mean.primitive, weights[0]};
    return 1;
  }
  std::array<Echo, kMostSubRays> echo_buffer;  // NOLINT: filled as far as it is read
  const auto echoes = echoes_of(hits, weights, classes, options, echo_buffer);
  std::array<Return, kMostSubRays> pulses;
  const std::size_t pulse_count = pulses_of(echoes, options, pulses);
  const std::size_t reported = reported_returns(std::span(pulses).first(pulse_count), options);
  std::copy_n(pulses.begin(), reported, out.begin());
  return reported;
}

}  // namespace adasplats
