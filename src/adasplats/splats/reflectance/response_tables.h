// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// Nodes of the response's tables. Choices: denser near the sensor, where echoes change most with
/// range; finer ones follow noise and what chanced to stand there, coarser ones miss the bends.
struct ResponseNodes {
  static constexpr std::size_t kRanges = 18, kCosines = 11;
  static constexpr std::size_t kUnitRange = 4;  ///< whose gain is 1, by definition: 10 m
  static constexpr std::size_t kUnitCosine = kCosines - 1;

  std::array<float, kRanges> ranges_m = {2,  4,  6,  8,  10, 12, 14, 16, 18,
                                         20, 25, 30, 35, 40, 50, 60, 80, 100};
  std::array<float, kCosines> cosines = {0.0F, 0.1F, 0.2F, 0.3F, 0.4F, 0.5F,
                                         0.6F, 0.7F, 0.8F, 0.9F, 1.0F};
};

/// Where a value lies among ascending nodes: the number of the node below it and the share of the
/// way to the next, as one number. Values outside lie on the first or last node.
template <std::size_t N>
ADASPLATS_HD inline float place_among(const std::array<float, N>& nodes, float value) {
  std::size_t below = 0;
  while (below + 2 < N && value >= nodes[below + 1]) ++below;
  const float share = (value - nodes[below]) / (nodes[below + 1] - nodes[below]);
  return static_cast<float>(below) + std::clamp(share, 0.0F, 1.0F);
}

/// What place_among() put together.
struct ResponsePlace {
  std::size_t below;
  float share;  ///< of the next node, 0..1
};

template <std::size_t N>
ADASPLATS_HD inline ResponsePlace node_place(float place) {
  const std::size_t below = std::min(static_cast<std::size_t>(place), N - 2);
  return {below, place - static_cast<float>(below)};
}

template <std::size_t N>
ADASPLATS_HD inline float value_at(const std::array<float, N>& values, float place) {
  const ResponsePlace at = node_place<N>(place);
  return values[at.below] + at.share * (values[at.below + 1] - values[at.below]);
}

/// The gains at the nodes.
struct ResponseGains {
  std::array<float, ResponseNodes::kRanges> of_ranges;
  std::array<float, ResponseNodes::kCosines> of_cosines;
};

/// Numbers from 0 to 1 are added in whole units, so that sums are the same in every order: those of
/// 2^32 numbers fit.
inline constexpr double kShareUnit = 0x1p-30;

ADASPLATS_HD inline std::int64_t whole_units(double share) {
  return static_cast<std::int64_t>(std::floor(share * (1 / kShareUnit) + 0.5));
}

/// Normal equations of a table that is linear between its nodes, in units of kShareUnit: three
/// diagonals.
template <std::size_t N>
struct TableSums {
  std::array<std::int64_t, N> diagonal = {};
  std::array<std::int64_t, N> beside = {};  ///< of node k and the next
  std::array<std::int64_t, N> right = {};

  ADASPLATS_HD TableSums& operator+=(const TableSums& other) {
    for (std::size_t k = 0; k < N; ++k) {
      diagonal[k] += other.diagonal[k];
      beside[k] += other.beside[k];
      right[k] += other.right[k];
    }
    return *this;
  }
  /// A ray with `intensity` = `factor` * table value at `place`; both from 0 to 1.
  ADASPLATS_HD void add(float place, double intensity, double factor) {
    const ResponsePlace at = node_place<N>(place);
    const auto upper = static_cast<double>(at.share);
    const double low = (1 - upper) * factor, high = upper * factor;
    diagonal[at.below] += whole_units(low * low);
    diagonal[at.below + 1] += whole_units(high * high);
    beside[at.below] += whole_units(low * high);
    right[at.below] += whole_units(low * intensity);
    right[at.below + 1] += whole_units(high * intensity);
  }
};

}  // namespace adasplats
