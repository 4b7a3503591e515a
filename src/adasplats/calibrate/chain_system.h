// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace adasplats {

/// A symmetric positive definite system of motions (six unknowns each), each coupled only with the
/// previous and the next one. Memory and time grow linearly with their number.
class ChainSystem {
 public:
  static constexpr std::size_t kUnknowns = 6;  ///< a rotation and a shift
  using Block = std::array<std::array<double, kUnknowns>, kUnknowns>;
  using Column = std::array<double, kUnknowns>;

  explicit ChainSystem(std::size_t count) : rows_(count * kUnknowns), right_(count * kUnknowns) {}

  /// Adds to the rows of `motion` and the columns of `other` (`motion` or the previous one).
  void add(std::size_t motion, std::size_t other, const Block& block) {
    for (std::size_t r = 0; r < kUnknowns; ++r)
      for (std::size_t c = 0; c < kUnknowns; ++c) {
        const std::size_t row = motion * kUnknowns + r, column = other * kUnknowns + c;
        if (column <= row) at(row, column) += block[r][c];
      }
  }
  void add(std::size_t motion, const Column& right) {
    for (std::size_t r = 0; r < kUnknowns; ++r) right_[motion * kUnknowns + r] += right[r];
  }

  /// Solves the system by a banded Cholesky factorisation.
  std::vector<double> solve() {
    const std::size_t n = right_.size();
    for (std::size_t row = 0; row < n; ++row)
      for (std::size_t column = first(row); column <= row; ++column) {
        double sum = at(row, column);
        for (std::size_t k = std::max(first(row), first(column)); k < column; ++k)
          sum -= at(row, k) * at(column, k);
        at(row, column) = column == row ? std::sqrt(sum) : sum / at(column, column);
      }
    std::vector<double> x = right_;
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t k = first(row); k < row; ++k) x[row] -= at(row, k) * x[k];
      x[row] /= at(row, row);
    }
    for (std::size_t row = n; row-- > 0;) {
      x[row] /= at(row, row);
      for (std::size_t k = first(row); k < row; ++k) x[k] -= at(row, k) * x[row];
    }
    return x;
  }

 private:
  static constexpr std::size_t kBand = 2 * kUnknowns;
  static std::size_t first(std::size_t row) { return row < kBand ? 0 : row - kBand + 1; }
  double& at(std::size_t row, std::size_t column) { return rows_[row][row - column]; }

  std::vector<std::array<double, kBand>> rows_;  ///< from the diagonal backwards
  std::vector<double> right_;
};

}  // namespace adasplats
