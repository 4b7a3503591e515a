// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adasplats/evaluate/realism/sample_table.h"

namespace adasplats {

/// The weights that maximise the likelihood of logistic regression less ridge / 2 times their
/// squares (the bias, the last one, is free), by Newton's method. `samples` without NaN.
std::vector<double> fit_logistic(const SampleTable& samples, double ridge);

/// Logistic regression over features in standard deviations about their means (of the samples it
/// was fitted to, cut off at 4; NaN is the mean) and over the squares of these, so that too much
/// and too little of something are both seen.
class LogisticScore {
 public:
  explicit LogisticScore(const SampleTable& samples);

  /// Log odds of the positive class.
  double score(std::span<const float> row) const;

 private:
  std::vector<float> expanded(std::span<const float> row) const;

  std::vector<double> means_, deviations_, weights_;
};

}  // namespace adasplats
