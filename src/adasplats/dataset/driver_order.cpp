// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/driver_order.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace adasplats {

std::vector<std::uint32_t> driver_order(const ScanView& scan, FirstRing first) {
  if (scan.rings.size() != scan.size() || scan.columns.size() != scan.size())
    throw std::logic_error("driver_order: the scan has no rings or columns");
  std::vector<std::uint32_t> order(scan.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto place = [&](std::uint32_t i) {
    const int ring = scan.rings[i];
    return std::pair(scan.columns[i], first == FirstRing::top ? ring : -ring);
  };
  std::ranges::stable_sort(order, {}, place);
  return order;
}

}  // namespace adasplats
