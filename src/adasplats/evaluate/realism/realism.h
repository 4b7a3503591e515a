// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/core/words.h"
#include "adasplats/evaluate/realism/auc.h"
#include "adasplats/evaluate/realism/features.h"

namespace adasplats {

/// Cross-validation takes this many blocks of consecutive scans; a class needs two scans in each,
/// so that halves of the real ones have one.
inline constexpr std::size_t kRealismFolds = 4;
inline constexpr std::size_t kMinRealismScans = 2 * kRealismFolds;

/// What the test sees of one scan.
struct RealismScan {
  std::vector<float> patches;      ///< features_of_patches()
  std::vector<double> statistics;  ///< statistics_of_scan()
};

/// Which features a test sees; each with those of context.
enum class RealismFeatures : std::uint8_t { all, geometry, dropout, intensity };
inline constexpr std::pair<std::string_view, RealismFeatures> kRealismFeatures[] = {
    {"all", RealismFeatures::all},
    {"geometry", RealismFeatures::geometry},
    {"dropout", RealismFeatures::dropout},
    {"intensity", RealismFeatures::intensity}};
inline Words<RealismFeatures> words_of(RealismFeatures) { return kRealismFeatures; }

/// How well patches of two sets of scans are told apart, in the order of kRealismFeatures. What one
/// of the sets does not have at all (intensities) is left out; a test of that alone is nothing.
struct RealismTest {
  std::vector<std::optional<AucInterval>> trees;     ///< the judge
  std::vector<std::optional<AucInterval>> logistic;  ///< beside it, kept out of development
  std::size_t patches = 0;                           ///< of both sets
};

/// A number of the scans, or the patches, of both sides.
struct StatisticPair {
  double real = 0, simulated = 0;  ///< means; NaN: not known
  /// How often a simulated one has the larger value, equal ones counting half: 0 and 1 tell all by
  /// this alone, 0.5 none.
  double auc = 0;
};

struct RealismResult {
  RealismTest simulated_real;
  RealismTest real_real;                  ///< halves of the real scans
  std::vector<StatisticPair> statistics;  ///< scan_statistics()
  std::vector<StatisticPair> features;    ///< patch_features(), means over patches
};

/// Can patches of simulated scans be told from those of real ones? A classifier learns it from
/// three quarters of the scans and is asked of the fourth, four times over: folds are blocks of
/// consecutive scans, the same share of both sides. Real scans against real ones, one of each two
/// neighbours as if simulated, are split in the same way: what no simulation can be better than.
/// `seed`: of the bootstrap, and of which patches are learned from where there are very many.
/// Errors: data (fewer than kMinRealismScans scans on a side, a side without patches).
RealismResult compare_realism(std::span<const RealismScan> simulated,
                              std::span<const RealismScan> real, std::uint64_t seed,
                              const Executor& executor);

}  // namespace adasplats
