// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/ring_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/core/maths/median.h"

namespace adasplats {
namespace {

constexpr double kFullTurn_rad = 2 * std::numbers::pi;

struct ArrangedReturn {
  std::uint16_t ring;
  float azimuth_rad, range_m;
  std::uint32_t point;
  Vec3f direction;
};

/// Gaps between neighbours of a ring, the one over the seam left out.
std::vector<float> gaps_rad(const RingScan& scan) {
  std::vector<float> gaps;
  for (std::size_t ring = 0; ring < scan.rings(); ++ring)
    for (std::size_t i = scan.begins[ring]; i + 1 < scan.begins[ring + 1]; ++i)
      gaps.push_back(scan.azimuths_rad[i + 1] - scan.azimuths_rad[i]);
  return gaps;
}

}  // namespace

RingScan arrange_in_rings(const KittiSequence& sequence, std::size_t index, const KittiScan& scan,
                          std::span<const double> heights_m) {
  const std::size_t rings = heights_m.size();
  std::vector<ArrangedReturn> returns;
  returns.reserve(scan.positions.size());
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    if (!is_finite(vec_cast<double>(scan.positions[i]))) continue;
    const MeasuredBeam beam = beam_of(sequence, index, scan, i);
    if (beam.laser >= rings) continue;
    const double raised_m = scan.origins.empty() ? 0 : heights_m[beam.laser];
    const Vec3d way = beam.end - beam.origin - Vec3d{0, 0, raised_m};
    const double range_m = length(way);
    if (!(range_m > 0)) continue;
    const double azimuth_rad = std::numbers::pi - std::atan2(way.y, way.x);  // 0 to a turn
    returns.push_back({beam.laser, static_cast<float>(azimuth_rad), static_cast<float>(range_m),
                       static_cast<std::uint32_t>(i), vec_cast<float>(way / range_m)});
  }
  std::ranges::sort(returns, [](const ArrangedReturn& a, const ArrangedReturn& b) {
    if (a.ring != b.ring) return a.ring < b.ring;
    return a.azimuth_rad != b.azimuth_rad ? a.azimuth_rad < b.azimuth_rad : a.point < b.point;
  });
  RingScan arranged;
  for (std::size_t ring = 0, i = 0; ring <= rings; ++ring) {
    while (i < returns.size() && returns[i].ring < ring) ++i;
    arranged.begins.push_back(i);
  }
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  for (const ArrangedReturn& one : returns) {
    arranged.azimuths_rad.push_back(one.azimuth_rad);
    arranged.ranges_m.push_back(one.range_m);
    arranged.directions.push_back(one.direction);
    arranged.intensities.push_back(scan.intensities.empty() ? kUnknown
                                                            : scan.intensities[one.point]);
  }
  return arranged;
}

double azimuth_step_rad(const RingScan& scan) {
  std::vector<float> gaps = gaps_rad(scan);
  if (gaps.empty()) return 0;
  const double median = static_cast<double>(upper_median_of(gaps));
  double sum = 0, count = 0;
  for (const float gap : gaps) {
    if (!(gap > 0.4 * median && gap < 1.4 * median)) continue;
    sum += static_cast<double>(gap);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

void count_missing(RingScan& scan, double step_rad) {
  scan.missing.assign(scan.size(), 0);
  for (std::size_t ring = 0; ring < scan.rings(); ++ring) {
    const std::size_t begin = scan.begins[ring], end = scan.begins[ring + 1];
    for (std::size_t i = begin; i < end; ++i) {
      const bool last = i + 1 == end;
      const double next = static_cast<double>(scan.azimuths_rad[last ? begin : i + 1]);
      const double gap =
          next + (last ? kFullTurn_rad : 0) - static_cast<double>(scan.azimuths_rad[i]);
      const double beams = std::round(gap / step_rad) - 1;
      scan.missing[i] = beams > 0 ? static_cast<std::uint32_t>(beams) : 0;
    }
  }
}

std::size_t unfolded_rings(std::span<const Vec3f> positions) {
  std::size_t rings = positions.empty() ? 0 : 1;
  double before = 0;
  for (const Vec3f& point : positions) {
    const double turned = std::atan2(static_cast<double>(point.y), static_cast<double>(point.x));
    const double turns = (turned < 0 ? turned + kFullTurn_rad : turned) / kFullTurn_rad;
    rings += before > 0.8 && turns < 0.2 ? 1 : 0;
    before = turns;
  }
  return rings;
}

}  // namespace adasplats
