// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/canonical_order.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace adasplats {
namespace {

/// -1, 0 or 1: a comes before, with or after b in one attribute.
template <class T>
int compare(const std::vector<T>& values, std::uint32_t a, std::uint32_t b) {
  if (values[a] == values[b]) return 0;
  return values[a] < values[b] ? -1 : 1;
}

/// NaN (an unknown intensity) comes after all numbers.
int compare(const std::vector<float>& values, std::uint32_t a, std::uint32_t b) {
  if (values[a] == values[b]) return 0;
  const int unknown = (std::isnan(values[a]) ? 1 : 0) - (std::isnan(values[b]) ? 1 : 0);
  if (unknown != 0 || std::isnan(values[a])) return unknown;
  return values[a] < values[b] ? -1 : 1;
}

int compare(const std::vector<Vec3f>& values, std::uint32_t a, std::uint32_t b) {
  for (int axis = 0; axis < 3; ++axis)
    if (values[a][axis] != values[b][axis]) return values[a][axis] < values[b][axis] ? -1 : 1;
  return 0;
}

/// Compares two points by all attributes that the cloud has, those of the lowest rank first.
class TieBreakers {
 public:
  explicit TieBreakers(const PointCloud& cloud) {
    for_each_attribute([&](const auto& attribute) {
      const auto& values = attribute.of(cloud);
      if (values.empty()) return;
      ranked_.emplace_back(attribute.tie_rank, [&values](std::uint32_t a, std::uint32_t b) {
        return compare(values, a, b);
      });
    });
    std::ranges::sort(ranked_, {}, &Ranked::first);
  }

  bool operator()(std::uint32_t a, std::uint32_t b) const {
    for (const Ranked& ranked : ranked_)
      if (const int result = ranked.second(a, b); result != 0) return result < 0;
    return false;
  }

 private:
  using Ranked = std::pair<int, std::function<int(std::uint32_t, std::uint32_t)>>;
  std::vector<Ranked> ranked_;
};

}  // namespace

std::vector<std::uint32_t> canonical_order(const PointCloud& cloud, const Executor& executor) {
  return canonical_order(cloud, curve_box_of(cloud.positions, executor), executor);
}

std::vector<std::uint32_t> canonical_order(const PointCloud& cloud, const CurveBox& box,
                                           const Executor& executor) {
  std::vector<std::uint32_t> order = hilbert_order(cloud.positions, box, executor);
  const TieBreakers breakers(cloud);
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::find_if(begin + 1, order.end(), [&](std::uint32_t i) {
      return !(cloud.positions[i] == cloud.positions[*begin]);
    });
    if (end - begin > 1) std::sort(begin, end, std::cref(breakers));
    begin = end;
  }
  return order;
}

PointCloud load_in_order(const PointCloud& cloud, const CurveBox& box,
                         std::span<const std::uint8_t> removed, const Executor& executor) {
  std::vector<std::uint32_t> order = canonical_order(cloud, box, executor);
  if (!removed.empty() && !cloud.classes.empty())
    std::erase_if(order, [&](std::uint32_t i) { return removed[cloud.classes[i]] != 0; });
  return gather(cloud, order);
}

PointCloud points_of_classes(const PointCloud& cloud, std::span<const std::uint8_t> flags) {
  PointCloud points;
  if (flags.empty() || cloud.classes.empty()) return points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (flags[cloud.classes[i]] == 0) continue;
    points.positions.push_back(cloud.positions[i]);
    if (!cloud.sensor_positions.empty())
      points.sensor_positions.push_back(cloud.sensor_positions[i]);
    if (!cloud.origin_kinds.empty()) points.origin_kinds.push_back(cloud.origin_kinds[i]);
    if (!cloud.intensities.empty()) points.intensities.push_back(cloud.intensities[i]);
  }
  return points;
}

}  // namespace adasplats
