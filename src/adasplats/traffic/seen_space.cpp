// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/seen_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace adasplats {
namespace {

constexpr std::size_t kColumns = 1024;
constexpr double kRadiansPerDegree = std::numbers::pi / 180;

float azimuth_of(Vec3d direction) {
  return static_cast<float>(std::atan2(direction.y, direction.x));
}

std::size_t column_of(float azimuth) {
  const double turn = static_cast<double>(azimuth) / (2 * std::numbers::pi) + 0.5;
  return static_cast<std::size_t>(std::max(turn, 0.0) * kColumns) % kColumns;
}

float elevation_of(Vec3d direction) {
  return static_cast<float>(direction.z / std::hypot(direction.x, direction.y));
}

}  // namespace

SeenSpace::SeenSpace(const KittiSequence& drive, std::size_t index, const KittiScan& scan,
                     const SeenSpaceOptions& options)
    : options_(options),
      sensor_from_world_(drive.trajectory[index].world_from_sensor.inverse()),
      starts_(kColumns + 1) {
  std::vector<std::uint16_t> columns;
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const MeasuredBeam beam = beam_of(drive, index, scan, i);
    const float elevation = elevation_of(beam.end);
    if (!std::isfinite(elevation)) continue;
    const float azimuth = azimuth_of(beam.end);
    columns.push_back(static_cast<std::uint16_t>(column_of(azimuth)));
    beams.push_back({elevation, azimuth, vec_cast<float>(beam.origin), vec_cast<float>(beam.end)});
    ++starts_[columns.back() + 1U];
  }
  for (std::size_t c = 0; c < kColumns; ++c) starts_[c + 1] += starts_[c];
  std::vector<std::uint32_t> places(starts_.begin(), starts_.end() - 1);
  beams_.resize(beams.size());
  for (std::size_t k = 0; k < beams.size(); ++k) beams_[places[columns[k]]++] = beams[k];
  for (std::size_t c = 0; c < kColumns; ++c)
    std::stable_sort(beams_.begin() + starts_[c], beams_.begin() + starts_[c + 1],
                     [](const Beam& a, const Beam& b) { return a.elevation < b.elevation; });
}

const SeenSpace::Beam* SeenSpace::nearest(float elevation, float azimuth, Side side) const {
  constexpr int kBeside = 3;  // columns
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const Beam* best = nullptr;
  float least = static_cast<float>(options_.reach_deg * kRadiansPerDegree);
  for (int k = 0; k <= kBeside; ++k) {
    const std::size_t c =
        column_of(azimuth) + kColumns + static_cast<std::size_t>(side.left ? k : -k);
    const auto begin = beams_.begin() + starts_[c % kColumns];
    const auto end = beams_.begin() + starts_[c % kColumns + 1];
    const auto after = std::lower_bound(
        begin, end, elevation, [](const Beam& beam, float e) { return beam.elevation < e; });
    if (side.above ? after == end : after == begin) continue;
    const Beam& beam = side.above ? *after : *(after - 1);
    float aside = beam.azimuth - azimuth;
    if (std::fabs(aside) > kTurn / 2) aside -= std::copysign(kTurn, aside);
    if (side.left ? aside < 0 : aside > 0) continue;
    const float off = std::max(std::fabs(beam.elevation - elevation), std::fabs(aside));
    if (off >= least) continue;
    least = off;
    best = &beam;
  }
  return best;
}

Seen SeenSpace::at(Vec3d place) const {
  const Vec3d local = sensor_from_world_ * place;
  const float elevation = elevation_of(local);
  if (!std::isfinite(elevation)) return Seen::unknown;
  constexpr std::array<Side, 4> kSides = {
      {{false, false}, {false, true}, {true, false}, {true, true}}};
  bool is_free = true;
  for (const Side side : kSides) {
    const Beam* beam = nearest(elevation, azimuth_of(local), side);
    if (beam == nullptr) return Seen::unknown;
    const Vec3d origin = vec_cast<double>(beam->origin), end = vec_cast<double>(beam->end);
    const double range_m = length(end - origin);
    const Vec3d direction = (end - origin) / range_m, to_place = local - origin;
    const double along_m = dot(to_place, direction);
    // Beams begin elsewhere if the sensor moves: they may lead past the place.
    constexpr double kNear_m = 0.1;
    const double aside_m = length(to_place - along_m * direction);
    if (aside_m > kNear_m + options_.reach_deg * kRadiansPerDegree * along_m) return Seen::unknown;
    if (std::fabs(range_m - along_m) <= options_.margin_m) return Seen::occupied;
    is_free = is_free && range_m > along_m;
  }
  return is_free ? Seen::free : Seen::unknown;
}

}  // namespace adasplats
