// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace adasplats {

/// Scores of one classifier for samples of two classes, with their scans.
struct ScoredSamples {
  std::vector<double> scores;
  std::vector<std::uint8_t> positive;  ///< 1: the class that should score higher
  std::vector<std::uint32_t> scans;    ///< index of the scan of each sample
};

/// Area under the ROC curve: how often a positive sample scores higher than a negative one, equal
/// scores counting half. NaN without samples of both classes. O(n log n).
double auc(std::span<const double> scores, std::span<const std::uint8_t> positive);

/// A mean, and the 95 % interval over resampled sets of scans.
struct AucInterval {
  double mean = 0, low = 0, high = 0;
};

/// One split of scans into training and scored parts: a part for each classifier.
using ScoredSplit = std::vector<ScoredSamples>;

/// The share of all pairs of a positive and a negative sample *within one part* (scores of
/// different classifiers cannot be compared) in which the positive one scores higher; the mean over
/// splits. The interval is that of a single split, by the percentile bootstrap over scans: from
/// each set as many scans as it has are drawn with replacement, with all their samples, for each
/// split in turn. `sets`: sizes of the sets of scans, whose indices follow one another. Classifiers
/// are not trained again: the interval ignores the variation of training scans and is too narrow by
/// a third. NaN without pairs.
AucInterval auc_interval(std::span<const ScoredSplit> splits, std::span<const std::size_t> sets,
                         std::uint64_t seed);

}  // namespace adasplats
