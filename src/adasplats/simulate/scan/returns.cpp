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
#include "adasplats/simulate/scan/echoes.h"

namespace adasplats {

namespace {

/// Number of sub-rays on each ring around the axis: about 6, 12, 18, ... as on a hexagonal grid, so
/// each represents about the same area.
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

/// Offset of a sub-ray from the axis, in units of the ellipse's semi-axes.
struct CrossSectionPlace {
  double horizontal;
  double vertical;
};

std::vector<CrossSectionPlace> places_of(int sub_rays) {
  std::vector<CrossSectionPlace> places{{0, 0}};
  if (sub_rays == 1) return places;
  const std::vector<int> sizes = ring_sizes(sub_rays - 1);
  // Ring k is in the middle of the annulus from (2k - 1) to (2k + 1) of 2n + 1 equal steps.
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
    throw Error(
        ErrorKind::usage,
        "2 sub-rays cannot be distributed evenly around the beam axis, expected 1, or 3 or more");
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
  return static_cast<std::size_t>(
      select_returns(pulses.data(), static_cast<int>(pulses.size()), options));
}

std::size_t returns_of(std::span<const Hit> hits, std::span<const float> weights,
                       std::span<const std::uint16_t> classes, const BeamOptions& options,
                       std::span<Return> out) {
  if (weights.size() != static_cast<std::size_t>(options.sub_rays) ||
      hits.size() != options.hits_per_firing())
    throw std::logic_error("returns need one weight and `depth` hits per sub-ray");
  for (const Hit& hit : hits)
    if (!classes.empty() && hit.valid() && hit.primitive >= classes.size())
      throw std::logic_error("an attribute has fewer values than the scene has primitives");
  std::array<Return, kMaxSubRays> returns{};
  const int count = firing_returns<kMaxSubRays>(
      hits.data(), weights.data(), options,
      [&](std::uint32_t primitive) -> std::uint16_t {
        return primitive < classes.size() ? classes[primitive] : 0;
      },
      returns.data());
  std::copy_n(returns.begin(), count, out.begin());
  return static_cast<std::size_t>(count);
}

}  // namespace adasplats
