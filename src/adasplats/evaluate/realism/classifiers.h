// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// The two classifiers of the realism test. They are our own, not a library's: the AUC of the test
// must stay comparable between versions of this program, and a library changes its binning,
// tie-breaking or defaults with its version.
namespace adasplats {

/// Samples of two classes with the same features. NaN: a sample does not have the feature.
struct SampleTable {
  std::size_t columns = 0;
  std::vector<float> values;           ///< sample by sample
  std::vector<std::uint8_t> positive;  ///< one per sample

  std::size_t size() const { return positive.size(); }
  std::span<const float> row(std::size_t i) const {
    return std::span(values).subspan(i * columns, columns);
  }
};

/// How trees are grown. The defaults are those of XGBoost and LightGBM, with fewer and shallower
/// trees for some thousand samples; none was tuned on data.
struct TreeOptions {
  std::size_t trees = 100;
  std::size_t depth = 4;
  double learning_rate = 0.1;
  double min_weight = 5;  ///< minimum sum of p (1 - p) in a leaf
  double ridge = 1;       ///< added to it
};

/// A sum of small trees that predicts the log odds of the positive class: gradient boosting with
/// Newton steps over histograms of 63 quantiles per feature (Friedman 2001; Chen and Guestrin
/// 2016). Deterministic: no sampling, ties go to the first feature and the lowest bound.
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
    std::int32_t left = -1;  ///< -1: a leaf; the right node follows the left one
    double value = 0;
  };
  struct Growth;
  using Tree = std::vector<Node>;

  double bias_ = 0;
  std::vector<Tree> trees_;
};

/// The weights that maximise the likelihood of logistic regression less ridge / 2 times their
/// squares (the bias, the last one, is free), by Newton's method. `samples` without NaN.
std::vector<double> fit_logistic(const SampleTable& samples, double ridge);

/// Logistic regression over features, standardised with the mean and deviation of the samples and
/// limited to 4 deviations (NaN becomes the mean), and over their squares, so both too small and
/// too large values can be detected.
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
