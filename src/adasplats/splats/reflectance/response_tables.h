// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// A gain, linear between nodes and constant outside, for CPU and GPU; 1 without nodes.
struct GainTable {
  const float* nodes = nullptr;  ///< ascending
  const float* gains = nullptr;  ///< one per node
  std::uint32_t count = 0;
};

ADASPLATS_HD inline float gain_of(const GainTable& table, float value) {
  if (table.count == 0) return 1.0F;
  const std::uint32_t last = table.count - 1;
  if (last == 0 || !(value > table.nodes[0])) return table.gains[0];
  if (value >= table.nodes[last]) return table.gains[last];
  // Without branches on the value; tables are short.
  std::uint32_t below = 0;
  for (std::uint32_t k = 1; k < last; ++k) below += table.nodes[k] <= value ? 1U : 0U;
  const float low = table.nodes[below];
  const float share = (value - low) / (table.nodes[below + 1] - low);
  return table.gains[below] + share * (table.gains[below + 1] - table.gains[below]);
}

/// Nodes of the response's tables. Chosen: denser near the sensor, where echoes change most with
/// range; finer nodes follow noise, coarser ones miss the curvature.
struct ResponseNodes {
  static constexpr std::size_t kRanges = 18, kCosines = 11;
  static constexpr std::size_t kUnitRange = 4;  ///< the node with gain 1 by definition: 10 m
  static constexpr std::size_t kUnitCosine = kCosines - 1;

  std::array<float, kRanges> ranges_m = {2,  4,  6,  8,  10, 12, 14, 16, 18,
                                         20, 25, 30, 35, 40, 50, 60, 80, 100};
  std::array<float, kCosines> cosines = {0.0F, 0.1F, 0.2F, 0.3F, 0.4F, 0.5F,
                                         0.6F, 0.7F, 0.8F, 0.9F, 1.0F};
};

/// Position of a value among ascending nodes: index of the node below plus the fraction of the way
/// to the next. Values outside are clamped to the first or last node.
template <std::size_t N>
ADASPLATS_HD inline float position_among(const std::array<float, N>& nodes, float value) {
  std::size_t below = 0;
  while (below + 2 < N && value >= nodes[below + 1]) ++below;
  const float share = (value - nodes[below]) / (nodes[below + 1] - nodes[below]);
  return static_cast<float>(below) + std::clamp(share, 0.0F, 1.0F);
}

/// The two parts of a position_among().
struct NodePosition {
  std::size_t below;
  float share;  ///< fraction of the way to the next node, 0..1
};

template <std::size_t N>
ADASPLATS_HD inline NodePosition node_position(float position) {
  const std::size_t below = std::min(static_cast<std::size_t>(position), N - 2);
  return {below, position - static_cast<float>(below)};
}

template <std::size_t N>
ADASPLATS_HD inline float value_at(const std::array<float, N>& values, float position) {
  const NodePosition at = node_position<N>(position);
  return values[at.below] + at.share * (values[at.below + 1] - values[at.below]);
}

/// The gains at the nodes.
struct ResponseGains {
  std::array<float, ResponseNodes::kRanges> of_ranges;
  std::array<float, ResponseNodes::kCosines> of_cosines;
};

/// Numbers from 0 to 1 are added as integer multiples of this, so that the order does not matter;
/// sums of 2^32 numbers fit.
inline constexpr double kShareUnit = 0x1p-30;

ADASPLATS_HD inline std::int64_t whole_units(double share) {
  return static_cast<std::int64_t>(std::floor(share * (1 / kShareUnit) + 0.5));
}

/// Normal equations of a piecewise linear table, in units of kShareUnit: three diagonals.
template <std::size_t N>
struct TableSums {
  std::array<std::int64_t, N> diagonal = {};
  std::array<std::int64_t, N> off_diagonal = {};  ///< off-diagonal of nodes k and k + 1
  std::array<std::int64_t, N> right = {};

  ADASPLATS_HD TableSums& operator+=(const TableSums& other) {
    for (std::size_t k = 0; k < N; ++k) {
      diagonal[k] += other.diagonal[k];
      off_diagonal[k] += other.off_diagonal[k];
      right[k] += other.right[k];
    }
    return *this;
  }
  /// Adds a ray with `intensity` = `factor` * table value at `position`; both from 0 to 1.
  ADASPLATS_HD void add(float position, double intensity, double factor) {
    const NodePosition at = node_position<N>(position);
    const auto upper = static_cast<double>(at.share);
    const double low = (1 - upper) * factor, high = upper * factor;
    diagonal[at.below] += whole_units(low * low);
    diagonal[at.below + 1] += whole_units(high * high);
    off_diagonal[at.below] += whole_units(low * high);
    right[at.below] += whole_units(low * intensity);
    right[at.below + 1] += whole_units(high * intensity);
  }
};

/// Solves for the values at the nodes, scaled to 1 at node `unit`. A weak coupling of neighbours
/// gives a node without rays the value of its neighbour. Without rays, or with 0 at `unit`: 1
/// everywhere. All spans have the same length.
void solve_table(std::span<const std::int64_t> diagonal, std::span<const std::int64_t> off_diagonal,
                 std::span<const std::int64_t> right, std::size_t unit, std::span<float> values);

template <std::size_t N>
std::array<float, N> solved(const TableSums<N>& sums, std::size_t unit) {
  std::array<float, N> values;
  solve_table(sums.diagonal, sums.off_diagonal, sums.right, unit, values);
  return values;
}

/// The smallest power of two above a number of at least 0, so that dividing by it is exact; 1 for
/// 0.
double power_of_two_above(double value);

}  // namespace adasplats
