// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/canonical_order.h"

#include <algorithm>
#include <cmath>

#include "adasplats/neighbors/hilbert.h"

namespace adasplats {
namespace {

/// -1, 0 or 1 as a comes before, with or after b in one attribute (absent: equal).
template <class T>
int compare(const std::vector<T>& values, std::uint32_t a, std::uint32_t b) {
  if (values.empty() || values[a] == values[b]) return 0;
  return values[a] < values[b] ? -1 : 1;
}

/// With NaN, an intensity that is not known, behind all numbers.
int compare(const std::vector<float>& values, std::uint32_t a, std::uint32_t b) {
  if (values.empty() || values[a] == values[b]) return 0;
  const int unknown = (std::isnan(values[a]) ? 1 : 0) - (std::isnan(values[b]) ? 1 : 0);
  if (unknown != 0 || std::isnan(values[a])) return unknown;
  return values[a] < values[b] ? -1 : 1;
}

int compare(const std::vector<Vec3f>& values, std::uint32_t a, std::uint32_t b) {
  if (values.empty()) return 0;
  for (int axis = 0; axis < 3; ++axis)
    if (values[a][axis] != values[b][axis]) return values[a][axis] < values[b][axis] ? -1 : 1;
  return 0;
}

bool attributes_before(const PointCloud& cloud, std::uint32_t a, std::uint32_t b) {
  for (const int result :
       {compare(cloud.classes, a, b), compare(cloud.instances, a, b),
        compare(cloud.scan_indices, a, b), compare(cloud.intensities, a, b),
        compare(cloud.sensor_positions, a, b), compare(cloud.origin_kinds, a, b)})
    if (result != 0) return result < 0;
  return false;
}

}  // namespace

std::vector<std::uint32_t> canonical_order(const PointCloud& cloud, const Executor& executor) {
  std::vector<std::uint32_t> order = hilbert_order(cloud.positions, executor);
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::find_if(begin + 1, order.end(), [&](std::uint32_t i) {
      return !(cloud.positions[i] == cloud.positions[*begin]);
    });
    if (end - begin > 1)
      std::sort(begin, end,
                [&](std::uint32_t a, std::uint32_t b) { return attributes_before(cloud, a, b); });
    begin = end;
  }
  return order;
}

}  // namespace adasplats
