// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace adasplats {

/// Scores that one classifier gave to samples of two classes, each of some scan.
struct ScoredSamples {
  std::vector<double> scores;
  std::vector<std::uint8_t> positive;  ///< 1: of the class that shall score higher
  std::vector<std::uint32_t> scans;    ///< the number of each one's scan
};

/// Area under the ROC curve: how often a positive sample scores higher than a negative one, equal
/// scores counting half. NaN without samples of both classes. O(n log n).
double auc(std::span<const double> scores, std::span<const std::uint8_t> positive);

/// A mean, and what 95 % of resampled sets of scans give.
struct AucInterval {
  double mean = 0, low = 0, high = 0;
};

/// One way to split scans into what is learned from and what is scored: a part for each classifier.
using ScoredSplit = std::vector<ScoredSamples>;

/// The share of all pairs of a positive and a negative sample *within one part* (scores of
/// different classifiers cannot be compared) in which the positive one scores higher; the mean over
/// splits. The interval is that of a single split, by the percentile bootstrap over scans: as many
/// as there are of each set are drawn with replacement, with all their samples, of each split in
/// turn. `sets`: sizes of the sets of scans that are drawn from one by one, numbers of the first
/// set first. Classifiers stay as they are: what they would have learned from other scans is not in
/// the interval, which is too narrow by a third. NaN without pairs.
AucInterval auc_interval(std::span<const ScoredSplit> splits, std::span<const std::size_t> sets,
                         std::uint64_t seed);

}  // namespace adasplats
