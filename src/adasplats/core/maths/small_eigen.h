// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace adasplats {

/// Eigenvalues of a symmetric matrix of a few rows, in no order, with unit eigenvectors.
template <std::size_t N>
struct SmallEigen {
  std::array<double, N> values{};
  std::array<std::array<double, N>, N> vectors{};  ///< one a value
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
  constexpr int kMaxSweeps = 20;  // it converges quadratically: six or so are enough
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

}  // namespace adasplats
