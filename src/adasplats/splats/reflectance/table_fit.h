// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/splats/reflectance/response_tables.h"

namespace adasplats {

/// Solves for the values at the nodes, scaled so that that of `unit` is 1. Neighbours pull each
/// other a little, so that a node that no ray is near has its neighbour's value. Without rays, or
/// with nothing at `unit`: 1 everywhere. All of one length; values of any unit.
void solve_table(std::span<const std::int64_t> diagonal, std::span<const std::int64_t> beside,
                 std::span<const std::int64_t> right, std::size_t unit, std::span<float> values);

template <std::size_t N>
std::array<float, N> solved(const TableSums<N>& sums, std::size_t unit) {
  std::array<float, N> values;
  solve_table(sums.diagonal, sums.beside, sums.right, unit, values);
  return values;
}

/// The least power of two above a number that is 0 or more: dividing by it is exact. 1 for 0.
double power_of_two_above(double value);

}  // namespace adasplats
