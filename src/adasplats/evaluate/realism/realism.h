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

/// Number of blocks of consecutive scans in cross-validation. A class needs two scans in each, so
/// that halves of the real scans have one.
inline constexpr std::size_t kRealismFolds = 4;
inline constexpr std::size_t kMinRealismScans = 2 * kRealismFolds;

/// The input of the test from one scan.
struct RealismScan {
  std::vector<float> patches;      ///< features_of_patches()
  std::vector<double> statistics;  ///< statistics_of_scan()
};

/// The features of a test, always with those of context.
enum class RealismFeatures : std::uint8_t { all, geometry, dropout, intensity };
inline constexpr std::pair<std::string_view, RealismFeatures> kRealismFeatures[] = {
    {"all", RealismFeatures::all},
    {"geometry", RealismFeatures::geometry},
    {"dropout", RealismFeatures::dropout},
    {"intensity", RealismFeatures::intensity}};
inline Words<RealismFeatures> words_of(RealismFeatures) { return kRealismFeatures; }

/// How well patches of two sets of scans can be distinguished, in the order of kRealismFeatures.
/// Groups of features that one set lacks (intensities) are left out; a test of such a group alone
/// is empty.
struct RealismTest {
  std::vector<std::optional<AucInterval>> trees;     ///< boosted trees, the reference
  std::vector<std::optional<AucInterval>> logistic;  ///< second opinion, not used in development
  std::size_t patches = 0;                           ///< of both sets
};

/// A number of the scans, or the patches, of both sides.
struct StatisticPair {
  double real = 0, simulated = 0;  ///< means; NaN: unknown
  /// How often the simulated value is the larger one, equal values counting half: 0 and 1
  /// distinguish all pairs by this number alone, 0.5 none.
  double auc = 0;
};

struct RealismResult {
  RealismTest simulated_real;
  RealismTest real_real;                  ///< halves of the real scans
  std::vector<StatisticPair> statistics;  ///< scan_statistics()
  std::vector<StatisticPair> features;    ///< patch_features(), means over patches
};

/// Can patches of simulated scans be distinguished from those of real ones? Classifiers are trained
/// on three quarters of the scans and tested on the fourth, four times: folds are blocks of
/// consecutive scans, the same share of both sides. Real scans against real ones, with one of every
/// two neighbours in the role of simulated, are split in the same way and give the limit for any
/// simulation. `seed`: for the bootstrap, and for the choice of training patches if there are very
/// many. Errors: data (fewer than kMinRealismScans scans on a side, a side without patches).
RealismResult compare_realism(std::span<const RealismScan> simulated,
                              std::span<const RealismScan> real, std::uint64_t seed,
                              const Executor& executor);

}  // namespace adasplats
