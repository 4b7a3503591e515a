// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lidar_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "adasplats/sensors/lidar_files.h"

namespace adasplats {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

void check(const LidarModel& model) {
  const auto one_a_beam = [&](std::size_t count) {
    return count == 0 || count == model.elevations_rad.size();
  };
  if (!one_a_beam(model.azimuth_offsets_rad.size()) || !one_a_beam(model.beam_origins_m.size()) ||
      !one_a_beam(model.firing_times_s.size()) || !one_a_beam(model.range_offsets_m.size()) ||
      !one_a_beam(model.ring_noise_m.size()))
    throw std::logic_error("a LiDAR model needs one value a beam, or none");
  if (!(model.rotation_hz > 0)) throw std::logic_error("a LiDAR model needs rotation_hz > 0");
}

/// Whether the free pattern lasts longer than a scan.
bool continues(const LidarModel& model) {
  constexpr double kRounding = 1e-6;
  return !model.free_pattern.empty() && model.pattern_s * model.rotation_hz > 1 + kRounding;
}

/// The part of a pattern that belongs to a scan. Scans have equal numbers of rays, so no ray is
/// skipped or repeated between two scans.
std::vector<Firing> continued_firings(const LidarModel& model, std::uint64_t scan_index) {
  const std::vector<Firing>& pattern = model.free_pattern;
  const std::size_t count = model.rays_per_scan();
  const std::size_t first = static_cast<std::size_t>(scan_index % pattern.size()) *
                            (count % pattern.size()) % pattern.size();
  const auto begin_s = static_cast<double>(pattern[first].time_s);
  std::vector<Firing> firings;
  firings.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = first + i;
    Firing firing = pattern[place % pattern.size()];
    const std::size_t round = place / pattern.size();
    const double round_s = model.pattern_s * static_cast<double>(round);
    firing.column = static_cast<std::uint32_t>(i);
    firing.time_s = static_cast<float>(static_cast<double>(firing.time_s) + round_s - begin_s);
    firings.push_back(firing);
  }
  return firings;
}

}  // namespace

double full_e2_angle_rad(double stated_rad, DivergenceKind kind) {
  switch (kind) {
    case DivergenceKind::fwhm: return 2.0 * stated_rad / std::sqrt(2.0 * std::numbers::ln2);
    case DivergenceKind::half_e2: return 2.0 * stated_rad;
    case DivergenceKind::full_e2:
    case DivergenceKind::unknown: break;
  }
  return stated_rad;
}

std::vector<double> even_fan_rad(int beams, double top_deg, double bottom_deg) {
  std::vector<double> elevations_rad;
  for (int i = 0; i < beams; ++i) {
    const double share = beams == 1 ? 0.0 : static_cast<double>(i) / (beams - 1);
    elevations_rad.push_back(radians(top_deg + share * (bottom_deg - top_deg)));
  }
  return elevations_rad;
}

Vec3f direction_of(double azimuth_rad, double elevation_rad) {
  const double flat = std::cos(elevation_rad);
  return vec_cast<float>(
      Vec3d{flat * std::cos(azimuth_rad), flat * std::sin(azimuth_rad), std::sin(elevation_rad)});
}

double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

Firing firing_at(const LidarModel& model, std::size_t ring, double head_rad) {
  const double offset_rad =
      model.azimuth_offsets_rad.empty() ? 0.0 : model.azimuth_offsets_rad[ring];
  Firing firing{direction_of(head_rad + offset_rad, model.elevations_rad[ring]),
                static_cast<std::uint16_t>(ring),
                0,
                0,
                {}};
  if (!model.beam_origins_m.empty()) {
    const Vec3d head = model.beam_origins_m[ring];
    const double cos = std::cos(head_rad);
    const double sin = std::sin(head_rad);
    firing.origin =
        vec_cast<float>(Vec3d{cos * head.x - sin * head.y, sin * head.x + cos * head.y, head.z});
  }
  return firing;
}

Firing turned_firing(const LidarModel& model, std::size_t ring, std::uint32_t column) {
  const double share = static_cast<double>(column) / model.columns;
  const double late_s = model.firing_times_s.empty() ? 0.0 : model.firing_times_s[ring];
  const double angle_rad = (share + late_s * model.rotation_hz) * kTurn;
  Firing firing =
      firing_at(model, ring, model.first_azimuth_rad + (model.clockwise ? -angle_rad : angle_rad));
  firing.column = column;
  firing.time_s = static_cast<float>(share / model.rotation_hz + late_s);
  return firing;
}

bool LidarModel::fires_in(std::uint32_t column) const {
  const double share = static_cast<double>(column) / columns;
  if (window_begin <= window_end) return share >= window_begin && share < window_end;
  return share >= window_begin || share < window_end;
}

std::size_t LidarModel::rays_per_scan() const {
  if (rosette) return rosette_rays_per_scan(*this);
  if (continues(*this)) {
    const double share = 1 / (rotation_hz * pattern_s);
    return std::max<std::size_t>(
        1,
        static_cast<std::size_t>(std::llround(share * static_cast<double>(free_pattern.size()))));
  }
  if (!free_pattern.empty()) return free_pattern.size();
  std::size_t fired = columns;
  if (has_window()) {
    fired = 0;
    for (std::uint32_t column = 0; column < columns; ++column) fired += fires_in(column) ? 1 : 0;
  }
  return elevations_rad.size() * fired;
}

std::size_t LidarModel::rings() const {
  if (rosette) return std::max<std::size_t>(rosette->laser_tilts_rad.size(), 1);
  std::size_t count = free_pattern.empty() ? elevations_rad.size() : 0;
  for (const Firing& firing : free_pattern)
    count = std::max(count, static_cast<std::size_t>(firing.ring) + 1);
  return count;
}

std::vector<Firing> firings_of(const LidarModel& model, std::uint64_t scan_index) {
  if (model.rosette) return rosette_firings(model, scan_index);
  if (continues(model)) return continued_firings(model, scan_index);
  if (!model.free_pattern.empty()) return model.free_pattern;
  check(model);
  std::vector<Firing> firings;
  firings.reserve(model.rays_per_scan());
  for (std::size_t ring = 0; ring < model.elevations_rad.size(); ++ring)
    for (std::uint32_t column = 0; column < model.columns; ++column)
      if (model.fires_in(column)) firings.push_back(turned_firing(model, ring, column));
  return firings;
}

bool repeats(const LidarModel& model) { return !model.rosette && !continues(model); }

bool fires_at_once(const LidarModel& model) {
  if (!repeats(model)) return false;
  const auto are_equal = [](const auto& values, const auto& time_of) {
    return std::ranges::all_of(
        values, [&](const auto& value) { return time_of(value) == time_of(values.front()); });
  };
  if (!model.free_pattern.empty())
    return are_equal(model.free_pattern, [](const Firing& firing) { return firing.time_s; });
  return model.columns == 1 &&
         are_equal(model.firing_times_s, [](double time_s) { return time_s; });
}

}  // namespace adasplats
