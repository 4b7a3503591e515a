// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/unit/unit_beams.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace adasplats {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// A beam in its scan's frame.
struct FiredBeam {
  std::uint16_t ring;
  double azimuth_rad, elevation_rad;  ///< azimuth clockwise from the rear
  float range_m, intensity;
  Vec3d origin;
  std::uint32_t point;  ///< of the scan; makes the order unique
};

std::vector<FiredBeam> returns_of(const KittiSequence& sequence, std::size_t index,
                                  std::span<const double> heights_m) {
  const KittiScan scan = read_all_returns(sequence, index);
  std::vector<FiredBeam> returns;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    if (!is_finite(vec_cast<double>(scan.positions[i]))) continue;
    const MeasuredBeam beam = beam_of(sequence, index, scan, i);
    if (beam.laser >= heights_m.size()) continue;
    const double raised_m = scan.origins.empty() ? 0 : heights_m[beam.laser];
    const Vec3d origin = beam.origin + Vec3d{0, 0, raised_m};
    const Vec3d way = beam.end - origin;
    const double range_m = length(way);
    if (!(range_m > 0)) continue;
    returns.push_back({beam.laser, std::numbers::pi - std::atan2(way.y, way.x),
                       std::asin(std::clamp(way.z / range_m, -1.0, 1.0)),
                       static_cast<float>(range_m),
                       scan.intensities.empty() ? kNothing : scan.intensities[i], origin,
                       static_cast<std::uint32_t>(i)});
  }
  std::ranges::sort(returns, [](const FiredBeam& a, const FiredBeam& b) {
    if (a.ring != b.ring) return a.ring < b.ring;
    return a.azimuth_rad != b.azimuth_rad ? a.azimuth_rad < b.azimuth_rad : a.point < b.point;
  });
  return returns;
}

/// `count` beams without return next to `beam`, `step_rad` apart, the nearest first.
void add_missing(const FiredBeam& beam, int count, double step_rad, std::vector<FiredBeam>& beams) {
  for (int k = 1; k <= count; ++k)
    beams.push_back({beam.ring, beam.azimuth_rad + k * step_rad, beam.elevation_rad, kNothing,
                     kNothing, beam.origin, beam.point});
}

/// Adds the beams between returns of a ring, and those before the first and after the last one,
/// within the azimuths of all returns: the scan may not cover a full turn.
std::vector<FiredBeam> with_missing(const std::vector<FiredBeam>& returns, double step_rad) {
  std::vector<FiredBeam> beams;
  if (returns.empty()) return beams;
  const auto [first, last] = std::ranges::minmax_element(returns, {}, &FiredBeam::azimuth_rad);
  const auto steps_between = [&](double from_rad, double to_rad) {
    return static_cast<int>(std::round((to_rad - from_rad) / step_rad));
  };
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const FiredBeam& one = returns[i];
    if (i == 0 || returns[i - 1].ring != one.ring) {
      const auto begin = static_cast<std::ptrdiff_t>(beams.size());
      add_missing(one, steps_between(first->azimuth_rad, one.azimuth_rad), -step_rad, beams);
      std::reverse(beams.begin() + begin, beams.end());
    }
    beams.push_back(one);
    if (i + 1 == returns.size() || returns[i + 1].ring != one.ring) {
      add_missing(one, steps_between(one.azimuth_rad, last->azimuth_rad), step_rad, beams);
      continue;
    }
    const FiredBeam& next = returns[i + 1];
    const int steps = steps_between(one.azimuth_rad, next.azimuth_rad);
    for (int k = 1; k < steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      const auto between = [&](double a, double b) { return a + share * (b - a); };
      beams.push_back({one.ring, between(one.azimuth_rad, next.azimuth_rad),
                       between(one.elevation_rad, next.elevation_rad), kNothing, kNothing,
                       (1 - share) * one.origin + share * next.origin, one.point});
    }
  }
  return beams;
}

Vec3d direction_of(const FiredBeam& beam) {
  const double azimuth_rad = std::numbers::pi - beam.azimuth_rad;
  const double flat = std::cos(beam.elevation_rad);
  return {flat * std::cos(azimuth_rad), flat * std::sin(azimuth_rad), std::sin(beam.elevation_rad)};
}

SensorBeam unit_beam(const EchoScene& scene, const FiredBeam& fired, const Ray& ray,
                     const Hit& hit) {
  SensorBeam beam;
  beam.ring = fired.ring;
  beam.range_m = fired.range_m;
  beam.intensity = fired.intensity;
  beam.hit = hit.valid();
  beam.reflectance = beam.expected_intensity = kNothing;
  if (!beam.hit) return beam;
  const EchoConditions echo = echo_of(scene, ray, hit);
  beam.expected_m = echo.range_m;
  beam.cos_incidence = echo.cos_incidence;
  beam.reflectance = echo.reflectance;
  beam.drop_log_odds = echo.drop_log_odds;
  const IntensityResponse* response = scene.attributes.response;
  beam.expected_intensity =
      echo.reflectance *
      (response == nullptr ? 1.0F : response->gain(echo.range_m, echo.cos_incidence));
  return beam;
}

}  // namespace

std::vector<SensorBeam> collect_unit_beams(const EchoScene& scene, const KittiSequence& sequence,
                                           std::span<const std::size_t> indices,
                                           std::span<const double> heights_m, double step_rad,
                                           const Executor& executor, ProgressSink& progress) {
  std::vector<SensorBeam> all;
  const std::vector<std::uint32_t> places = standpoints_of(sequence, indices);
  progress.begin_step("cast all beams", indices.size());
  for (std::size_t s = 0; s < indices.size(); ++s) {
    const std::vector<FiredBeam> fired =
        with_missing(returns_of(sequence, indices[s], heights_m), step_rad);
    RigidTransform scene_from_scan = sequence.trajectory[indices[s]].world_from_sensor;
    scene_from_scan.translation = scene_from_scan.translation - scene.origin;
    std::vector<Ray> rays(fired.size());
    std::vector<Hit> hits(fired.size());
    executor.for_chunks(fired.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        rays[i].origin = vec_cast<float>(scene_from_scan * fired[i].origin);
        rays[i].direction = vec_cast<float>(scene_from_scan.rotation * direction_of(fired[i]));
      }
    });
    scene.tracer.nearest(rays, hits, executor);
    for (std::size_t i = 0; i < fired.size(); ++i) {
      SensorBeam beam = unit_beam(scene, fired[i], rays[i], hits[i]);
      beam.scan = static_cast<std::uint32_t>(indices[s]);
      beam.place = places[s];
      const bool goes_on = i > 0 && fired[i - 1].ring == fired[i].ring;
      beam.column =
          goes_on ? all.back().column + 1
                  : static_cast<std::uint32_t>(std::max(fired[i].azimuth_rad, 0.0) / step_rad);
      beam.direction = vec_cast<float>(direction_of(fired[i]));
      all.push_back(beam);
    }
    progress.advance(s + 1);
  }
  progress.end_step();
  return all;
}

}  // namespace adasplats
