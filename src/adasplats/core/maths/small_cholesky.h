// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace adasplats {

/// Factors a symmetric matrix of a few rows, a = L L^T: L takes the place of its lower half. A
/// matrix that is not positive definite is made so by the least that helps.
template <std::size_t N>
void factor(std::array<double, N * N>& a) {
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      double sum = a[row * N + column];
      for (std::size_t k = 0; k < column; ++k) sum -= a[row * N + k] * a[column * N + k];
      a[row * N + column] =
          column < row ? sum / a[column * N + column] : std::sqrt(std::max(sum, 1e-12));
    }
  }
}

/// The x of L L^T x = `right`.
template <std::size_t N>
std::array<double, N> solved(const std::array<double, N * N>& l, std::array<double, N> right) {
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t k = 0; k < row; ++k) right[row] -= l[row * N + k] * right[k];
    right[row] /= l[row * N + row];
  }
  for (std::size_t row = N; row-- > 0;) {
    for (std::size_t k = row + 1; k < N; ++k) right[row] -= l[k * N + row] * right[k];
    right[row] /= l[row * N + row];
  }
  return right;
}

}  // namespace adasplats
