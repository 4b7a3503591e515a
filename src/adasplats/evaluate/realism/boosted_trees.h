// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/evaluate/realism/sample_table.h"

namespace adasplats {

/// How trees are grown. The values are customary ones (those of XGBoost and LightGBM, with fewer
/// and shallower trees for some thousand samples); none was chosen by data.
struct TreeOptions {
  std::size_t trees = 100;
  std::size_t depth = 4;
  double learning_rate = 0.1;
  double min_weight = 5;  ///< least sum of p (1 - p) in a leaf
  double ridge = 1;       ///< added to it
};

/// A sum of small trees that gives the log odds of the positive class: gradient boosting with
/// Newton steps over histograms of 63 quantiles a feature (Friedman 2001; Chen and Guestrin 2016).
/// Deterministic: no sampling, ties go to the first feature and the lowest bound.
class BoostedTrees {
 public:
  /// Throws std::logic_error without samples of both classes.
  BoostedTrees(const SampleTable& samples, const TreeOptions& options);

  /// Log odds.
  double score(std::span<const float> row) const;

 private:
  struct Node {
    std::uint32_t feature = 0;
    float bound = 0;         ///< values below it, and NaN, go left
    std::int32_t left = -1;  ///< -1: a leaf; the right one is behind the left one
    double value = 0;
  };
  struct Growth;
  using Tree = std::vector<Node>;

  double bias_ = 0;
  std::vector<Tree> trees_;
};

}  // namespace adasplats
