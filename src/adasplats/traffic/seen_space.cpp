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
constexpr float kTurn = 2 * std::numbers::pi_v<float>;

float azimuth_of(Vec3d direction) {
  return static_cast<float>(std::atan2(direction.y, direction.x));
}

std::size_t column_of(float azimuth) {
  const double turn = static_cast<double>(azimuth) / (2 * std::numbers::pi) + 0.5;
  return static_cast<std::size_t>(std::max(turn, 0.0) * kColumns) % kColumns;
}

float elevation_of(Vec3d direction) {
  return static_cast<float>(direction.z /
                            std::sqrt(direction.x * direction.x + direction.y * direction.y));
}

}  // namespace

SeenSpace::SeenSpace(const KittiSequence& drive, std::size_t index, const KittiScan& scan,
                     const SeenSpaceOptions& options)
    : options_(options),
      sensor_from_world_(drive.trajectory[index].world_from_sensor.inverse()),
      starts_(kColumns + 1) {
  struct Placed {
    float elevation;
    std::uint32_t number;
  };
  std::vector<std::uint16_t> columns;
  std::vector<Direction> directions;
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const MeasuredBeam beam = beam_of(drive, index, scan, i);
    const float elevation = elevation_of(beam.end);
    if (!std::isfinite(elevation)) continue;
    const float azimuth = azimuth_of(beam.end);
    columns.push_back(static_cast<std::uint16_t>(column_of(azimuth)));
    directions.push_back({elevation, azimuth});
    beams.push_back({vec_cast<float>(beam.origin), vec_cast<float>(beam.end)});
    ++starts_[columns.back() + 1U];
  }
  for (std::size_t c = 0; c < kColumns; ++c) starts_[c + 1] += starts_[c];
  std::vector<std::uint32_t> places(starts_.begin(), starts_.end() - 1);
  std::vector<Placed> placed(beams.size());
  for (std::size_t k = 0; k < beams.size(); ++k)
    placed[places[columns[k]]++] = {directions[k].elevation, static_cast<std::uint32_t>(k)};
  for (std::size_t c = 0; c < kColumns; ++c)
    std::sort(placed.begin() + starts_[c], placed.begin() + starts_[c + 1],
              [](const Placed& a, const Placed& b) {
                return a.elevation != b.elevation ? a.elevation < b.elevation : a.number < b.number;
              });
  for (const Placed& place : placed) {
    elevations_.push_back(place.elevation);
    azimuths_.push_back(directions[place.number].azimuth);
    beams_.push_back(beams[place.number]);
  }
}

class SeenSpace::Columns {
 public:
  Columns(const SeenSpace& seen, float elevation, float azimuth)
      : seen_(seen),
        elevation_(elevation),
        azimuth_(azimuth),
        column_(column_of(azimuth)),
        reach_(static_cast<float>(seen.options_.reach_deg * kRadiansPerDegree)) {
    constexpr double kWidth = 2 * std::numbers::pi / kColumns;
    from_right_ = azimuth + std::numbers::pi - static_cast<double>(column_) * kWidth;
    if (from_right_ > std::numbers::pi) from_right_ -= 2 * std::numbers::pi;
    from_left_ = kWidth - from_right_;
  }

  /// The beam with the smallest angle to the direction on one side of it; null: none in reach.
  const Beam* nearest(Side side) {
    constexpr double kWidth = 2 * std::numbers::pi / kColumns, kRounding = 1e-4;
    const Beam* best = nullptr;
    float least = reach_;
    for (int k = 0; k <= kBeside; ++k) {
      // All beams of a column may be too far aside.
      const double aside_of_all = (side.left ? from_left_ : from_right_) + (k - 1) * kWidth;
      if (aside_of_all - kRounding > static_cast<double>(least)) break;
      const Range& range = column(side.left ? k : -k);
      if (range.after == (side.above ? range.end : range.begin)) continue;
      const std::uint32_t beam = side.above ? range.after : range.after - 1;
      float aside = seen_.azimuths_[beam] - azimuth_;
      if (std::fabs(aside) > kTurn / 2) aside -= std::copysign(kTurn, aside);
      if (side.left ? aside < 0 : aside > 0) continue;
      const float off = std::max(std::fabs(seen_.elevations_[beam] - elevation_), std::fabs(aside));
      if (off >= least) continue;
      least = off;
      best = &seen_.beams_[beam];
    }
    return best;
  }

 private:
  static constexpr int kBeside = 3;  // columns
  /// Beams of a column, and the first one that is not below the direction.
  struct Range {
    std::uint32_t begin = 0, after = 0, end = 0;
    bool is_known = false;
  };

  const Range& column(int offset) {
    const int place = offset + kBeside;
    Range& range = ranges_[static_cast<std::size_t>(place)];
    if (range.is_known) return range;
    const std::size_t c = (column_ + kColumns + static_cast<std::size_t>(offset)) % kColumns;
    range = {seen_.starts_[c], 0, seen_.starts_[c + 1], true};
    const float* const all = seen_.elevations_.data();
    range.after = static_cast<std::uint32_t>(
        std::lower_bound(all + range.begin, all + range.end, elevation_) - all);
    return range;
  }

  const SeenSpace& seen_;
  float elevation_, azimuth_;
  std::size_t column_;
  float reach_;
  double from_right_, from_left_;  ///< from the sides of its column, rad
  std::array<Range, 2 * kBeside + 1> ranges_;
};

Seen SeenSpace::at(Vec3d place) const {
  const Vec3d local = sensor_from_world_ * place;
  const float elevation = elevation_of(local);
  if (!std::isfinite(elevation)) return Seen::unknown;
  constexpr std::array<Side, 4> kSides = {
      {{false, false}, {false, true}, {true, false}, {true, true}}};
  bool is_free = true;
  Columns columns(*this, elevation, azimuth_of(local));
  for (const Side side : kSides) {
    const Beam* beam = columns.nearest(side);
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
