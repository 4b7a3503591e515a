// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace adasplats {

/// Eigenvalues of a small symmetric matrix, in no particular order, with unit eigenvectors.
template <std::size_t N>
struct SmallEigen {
  std::array<double, N> values{};
  std::array<std::array<double, N>, N> vectors{};  ///< one for each value
};

/// Cyclic Jacobi (Golub and Van Loan, "Matrix computations", 8.5). `a` by rows.
template <std::size_t N>
SmallEigen<N> small_eigen(std::array<double, N * N> a) {
  SmallEigen<N> result;
  for (std::size_t i = 0; i < N; ++i) result.vectors[i][i] = 1;
  const auto turn = [](double& x, double& y, double c, double s) {
    const double before = x;
    x = c * before - s * y;
    y = s * before + c * y;
  };
  constexpr int kMaxSweeps = 20;  // convergence is quadratic: about six suffice
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    for (std::size_t p = 0; p < N; ++p) {
      for (std::size_t q = p + 1; q < N; ++q) {
        if (a[p * N + q] == 0) continue;
        const double tau = (a[q * N + q] - a[p * N + p]) / (2 * a[p * N + q]);
        const double t = (tau >= 0 ? 1.0 : -1.0) / (std::fabs(tau) + std::sqrt(1 + tau * tau));
        const double c = 1 / std::sqrt(1 + t * t);
        for (std::size_t k = 0; k < N; ++k) turn(a[k * N + p], a[k * N + q], c, t * c);
        for (std::size_t k = 0; k < N; ++k) turn(a[p * N + k], a[q * N + k], c, t * c);
        for (std::size_t k = 0; k < N; ++k)
          turn(result.vectors[p][k], result.vectors[q][k], c, t * c);
      }
    }
  }
  for (std::size_t i = 0; i < N; ++i) result.values[i] = a[i * N + i];
  return result;
}

/// Cholesky factorization of a small symmetric matrix, a = L L^T; L replaces its lower half. Raises
/// diagonal entries that are not positive.
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

/// Solves L L^T x = `right`.
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
