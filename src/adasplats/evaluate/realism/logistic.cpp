// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "adasplats/evaluate/realism/classifiers.h"

namespace adasplats {
namespace {

/// Small, but enough to keep the weights of separable classes finite.
constexpr double kRidge = 1;
constexpr double kCutoff = 4;  // standard deviations: limits the influence of single samples
constexpr int kMaxSteps = 25;

/// Solves a x = b for a symmetric positive definite matrix by rows, by Cholesky's factors.
std::vector<double> solved_symmetric(std::vector<double> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      double sum = a[row * n + column];
      for (std::size_t k = 0; k < column; ++k) sum -= a[row * n + k] * a[column * n + k];
      a[row * n + column] =
          column < row ? sum / a[column * n + column] : std::sqrt(std::max(sum, 1e-12));
    }
  }
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t k = 0; k < row; ++k) b[row] -= a[row * n + k] * b[k];
    b[row] /= a[row * n + row];
  }
  for (std::size_t row = n; row-- > 0;) {
    for (std::size_t k = row + 1; k < n; ++k) b[row] -= a[k * n + row] * b[k];
    b[row] /= a[row * n + row];
  }
  return b;
}

/// The bias is the last weight.
double log_odds(std::span<const float> row, std::span<const double> weights) {
  double sum = weights.back();
  for (std::size_t k = 0; k < row.size(); ++k) sum += weights[k] * static_cast<double>(row[k]);
  return sum;
}

/// Gradient and negative Hessian of the penalised likelihood.
struct NewtonSums {
  std::vector<double> gradient, hessian;

  explicit NewtonSums(std::size_t n) : gradient(n, 0), hessian(n * n, 0) {}

  void add(std::span<const float> row, double residual, double weight) {
    const std::size_t n = gradient.size();
    for (std::size_t a = 0; a < n; ++a) {
      const double left = a < row.size() ? static_cast<double>(row[a]) : 1.0;
      gradient[a] += residual * left;
      for (std::size_t b = 0; b <= a; ++b)
        hessian[a * n + b] += weight * left * (b < row.size() ? static_cast<double>(row[b]) : 1.0);
    }
  }
};

}  // namespace

std::vector<double> fit_logistic(const SampleTable& samples, double ridge) {
  const std::size_t n = samples.columns + 1;
  std::vector<double> weights(n, 0);
  for (int step = 0; step < kMaxSteps; ++step) {
    NewtonSums sums(n);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double p = 1 / (1 + std::exp(-log_odds(samples.row(i), weights)));
      sums.add(samples.row(i), static_cast<double>(samples.positive[i]) - p,
               std::max(p * (1 - p), 1e-6));
    }
    for (std::size_t a = 0; a + 1 < n; ++a) {
      sums.gradient[a] -= ridge * weights[a];
      sums.hessian[a * n + a] += ridge;
    }
    const std::vector<double> move = solved_symmetric(sums.hessian, sums.gradient);
    double max_move = 0;
    for (std::size_t a = 0; a < n; ++a) {
      weights[a] += std::clamp(move[a], -2.0, 2.0);  // far steps overshoot where classes separate
      max_move = std::max(max_move, std::fabs(move[a]));
    }
    if (max_move < 1e-8) break;
  }
  return weights;
}

LogisticScore::LogisticScore(const SampleTable& samples) {
  for (std::size_t f = 0; f < samples.columns; ++f) {
    double count = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto value = static_cast<double>(samples.row(i)[f]);
      if (value != value) continue;
      ++count;
      sum += value;
      squares += value * value;
    }
    const double mean = count > 0 ? sum / count : 0;
    const double variance = count > 0 ? squares / count - mean * mean : 0;
    means_.push_back(mean);
    deviations_.push_back(variance > 1e-12 * (1 + mean * mean) ? std::sqrt(variance) : 0);
  }
  SampleTable table{2 * samples.columns, {}, samples.positive};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::vector<float> row = expanded(samples.row(i));
    table.values.insert(table.values.end(), row.begin(), row.end());
  }
  weights_ = fit_logistic(table, kRidge);
}

std::vector<float> LogisticScore::expanded(std::span<const float> row) const {
  std::vector<float> values(2 * row.size(), 0);
  for (std::size_t f = 0; f < row.size(); ++f) {
    if (row[f] != row[f] || !(deviations_[f] > 0)) continue;
    const double z =
        std::clamp((static_cast<double>(row[f]) - means_[f]) / deviations_[f], -kCutoff, kCutoff);
    values[f] = static_cast<float>(z);
    values[row.size() + f] = static_cast<float>(z * z - 1);
  }
  return values;
}

double LogisticScore::score(std::span<const float> row) const {
  return log_odds(expanded(row), weights_);
}

}  // namespace adasplats
