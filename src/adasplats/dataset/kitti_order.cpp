// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/kitti_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <type_traits>

namespace adasplats {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// Points by ring, in firing order within a ring, and the begin of each ring.
struct Rings {
  Numbers points;
  std::vector<std::size_t> begins;  ///< number of rings + 1
};

Rings rings_of(const ScanView& scan) {
  const std::size_t points = scan.rings.size();
  const std::size_t rings =
      points == 0 ? 0 : *std::max_element(scan.rings.begin(), scan.rings.end()) + std::size_t{1};
  Rings found{Numbers(points), std::vector<std::size_t>(rings + 1)};
  for (const std::uint16_t ring : scan.rings) ++found.begins[ring + std::size_t{1}];
  std::partial_sum(found.begins.begin(), found.begins.end(), found.begins.begin());
  std::vector<std::size_t> next = found.begins;
  for (std::uint32_t i = 0; i < points; ++i) found.points[next[scan.rings[i]]++] = i;
  return found;
}

/// Whether a point is a later return of the firing of the previous point.
bool is_later_return(const ScanView& scan, std::uint32_t i) {
  return !scan.return_indices.empty() && scan.return_indices[i] > 0;
}

/// Numbers of steps between firings in each direction of rotation.
struct Turns {
  std::size_t left = 0, right = 0;
};

Turns turns_of(const ScanView& scan, const Rings& rings) {
  Turns turns;
  for (std::size_t k = 1; k < rings.points.size(); ++k) {
    const std::uint32_t i = rings.points[k - 1], j = rings.points[k];
    if (scan.rings[i] != scan.rings[j] || is_later_return(scan, j)) continue;
    const Vec3f a = scan.positions[i], b = scan.positions[j];
    const float turn = a.x * b.y - a.y * b.x;
    turns.left += turn > 0 ? 1 : 0;
    turns.right += turn < 0 ? 1 : 0;
  }
  return turns;
}

/// Angular noise reverses some steps; an oscillating pattern reverses every second one.
bool is_steady(const Turns& turns) {
  constexpr std::size_t kOneInTen = 10;
  return kOneInTen * std::min(turns.left, turns.right) <= turns.left + turns.right;
}

/// Reverses a ring, firing by firing.
void reverse_firings(const ScanView& scan, std::span<std::uint32_t> ring) {
  std::reverse(ring.begin(), ring.end());
  for (std::size_t begin = 0, end = 0; begin < ring.size(); begin = end) {
    while (end < ring.size() && is_later_return(scan, ring[end])) ++end;
    if (end < ring.size()) ++end;  // the first return of the firing, now the last
    std::reverse(ring.begin() + static_cast<std::ptrdiff_t>(begin),
                 ring.begin() + static_cast<std::ptrdiff_t>(end));
  }
}

/// Rotates a counter-clockwise ring so that it begins at azimuth 0.
void begin_ahead(const ScanView& scan, std::span<std::uint32_t> ring) {
  const auto at = [&](std::uint32_t i) { return scan.positions[i]; };
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const std::uint32_t before = ring[(k == 0 ? ring.size() : k) - 1];
    if (!(at(before).y < 0 && at(ring[k]).y >= 0 && at(ring[k]).x > 0)) continue;
    std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(k), ring.end());
    return;
  }
}

/// Angular noise moves some beams near azimuth 0 across it: they are moved to the end of the ring
/// to which they belong.
void part_ends(const ScanView& scan, std::span<std::uint32_t> ring) {
  constexpr float kBesideTan = 0.02F;  // of 1.1 degrees, more than the noise of any sensor
  const auto is_beside = [&](std::uint32_t i) {
    const Vec3f p = scan.positions[i];
    return p.x > 0 && std::fabs(p.y) < kBesideTan * p.x;
  };
  const auto lead_end = std::find_if_not(ring.begin(), ring.end(), is_beside);
  if (lead_end == ring.end()) return;
  const auto tail_begin = std::find_if_not(ring.rbegin(), ring.rend(), is_beside).base();
  Numbers parted;
  parted.reserve(ring.size());
  const auto take = [&](auto begin, auto end, bool left) {
    for (; begin != end; ++begin)
      if ((scan.positions[*begin].y >= 0) == left) parted.push_back(*begin);
  };
  take(tail_begin, ring.end(), true);
  take(ring.begin(), lead_end, true);
  parted.insert(parted.end(), lead_end, tail_begin);
  take(tail_begin, ring.end(), false);
  take(ring.begin(), lead_end, false);
  std::ranges::copy(parted, ring.begin());
}

template <class T>
void reorder(std::vector<T>& values, std::span<const std::type_identity_t<T>> from,
             std::span<const std::uint32_t> order) {
  if (from.size() != order.size()) return;  // optional attribute
  values.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) values[i] = from[order[i]];
}

}  // namespace

std::vector<std::uint32_t> kitti_order(const ScanView& scan) {
  if (scan.rings.size() != scan.size())
    throw std::logic_error("kitti_order: the scan has no rings");
  Rings rings = rings_of(scan);
  const Turns turns = turns_of(scan, rings);
  if (!is_steady(turns)) {
    std::iota(rings.points.begin(), rings.points.end(), 0U);
    return std::move(rings.points);
  }
  for (std::size_t k = 0; k + 1 < rings.begins.size(); ++k) {
    const std::span ring =
        std::span(rings.points).subspan(rings.begins[k], rings.begins[k + 1] - rings.begins[k]);
    if (turns.right > turns.left) reverse_firings(scan, ring);
    begin_ahead(scan, ring);
    part_ends(scan, ring);
  }
  return std::move(rings.points);
}

Scan reordered(const ScanView& scan, std::span<const std::uint32_t> order) {
  Scan made;
  made.world_from_sensor = scan.world_from_sensor;
  made.time_s = scan.time_s;
  made.rays = scan.rays;
  reorder(made.positions, scan.positions, order);
  for_each_scan_attribute(
      [&](const auto& attribute) { reorder(attribute.of(made), attribute.of(scan), order); });
  return made;
}

}  // namespace adasplats
