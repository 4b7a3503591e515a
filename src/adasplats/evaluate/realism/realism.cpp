// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/realism.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/realism/classifiers.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kPatchStream = 0x7061746368;  // "patch"
/// Maximum number of training patches of both classes: more improve little and take long.
constexpr std::size_t kMaxPatches = 24000;
constexpr std::size_t kTests = std::size(kRealismFeatures);
constexpr std::size_t kOrders = 8;     // a power of two
constexpr std::size_t kFewScans = 32;  // eight orders of them take as long as the test itself

/// A scan in a test, with class and fold.
struct TestScan {
  const RealismScan* scan;
  std::uint8_t positive;
  std::size_t fold;
};

std::size_t patches_of(const RealismScan& scan) {
  return scan.patches.size() / patch_features().size();
}

/// Folds are blocks of consecutive scans.
std::size_t fold_of(std::size_t scan, std::size_t scans) { return scan * kRealismFolds / scans; }

/// Groups of features that both classes have in at least one patch.
using KnownGroups = std::array<bool, std::size(kFeatureGroups)>;

KnownGroups known_groups(std::span<const TestScan> scans) {
  std::array<KnownGroups, 2> known{};  // of the negative and the positive class
  const std::size_t columns = patch_features().size();
  for (const TestScan& one : scans)
    for (std::size_t k = 0; k < one.scan->patches.size(); ++k)
      if (one.scan->patches[k] == one.scan->patches[k])
        known[one.positive][static_cast<std::size_t>(patch_features()[k % columns].group)] = true;
  for (std::size_t group = 0; group < known[0].size(); ++group)
    known[0][group] = known[0][group] && known[1][group];
  return known[0];
}

/// Columns of the features of a test. Groups that are not known are left out; empty if only context
/// would remain.
std::vector<std::size_t> columns_of(RealismFeatures features, const KnownGroups& known) {
  constexpr FeatureGroup kGroups[] = {FeatureGroup::context, FeatureGroup::geometry,
                                      FeatureGroup::dropout, FeatureGroup::intensity};
  std::vector<std::size_t> columns;
  bool is_known = false;
  for (std::size_t f = 0; f < patch_features().size(); ++f) {
    const FeatureGroup group = patch_features()[f].group;
    const bool is_context = group == FeatureGroup::context;
    const bool is_own = !is_context && (features == RealismFeatures::all ||
                                        group == kGroups[static_cast<std::size_t>(features)]);
    if (!known[static_cast<std::size_t>(group)] || !(is_own || is_context)) continue;
    columns.push_back(f);
    is_known = is_known || is_own;
  }
  return is_known ? columns : std::vector<std::size_t>();
}

std::vector<float> row_of(const RealismScan& scan, std::size_t patch,
                          std::span<const std::size_t> columns) {
  std::vector<float> row;
  for (const std::size_t column : columns)
    row.push_back(scan.patches[patch * patch_features().size() + column]);
  return row;
}

/// The patches of all folds but one; a random selection of very many.
SampleTable training_table(std::span<const TestScan> scans, std::size_t left_out,
                           std::span<const std::size_t> columns, std::uint64_t seed) {
  std::size_t count = 0;
  for (const TestScan& one : scans) count += one.fold == left_out ? 0 : patches_of(*one.scan);
  const double share = static_cast<double>(kMaxPatches) / static_cast<double>(count);
  SampleTable table{columns.size(), {}, {}};
  for (std::size_t s = 0; s < scans.size(); ++s) {
    if (scans[s].fold == left_out) continue;
    for (std::size_t p = 0; p < patches_of(*scans[s].scan); ++p) {
      Random random(seed, kPatchStream + s, p);
      if (random.uniform() >= share) continue;
      const std::vector<float> row = row_of(*scans[s].scan, p, columns);
      table.values.insert(table.values.end(), row.begin(), row.end());
      table.positive.push_back(scans[s].positive);
    }
  }
  return table;
}

template <class Classifier>
ScoredSamples scored(std::span<const TestScan> scans, std::size_t fold,
                     std::span<const std::size_t> columns, const Classifier& classifier) {
  ScoredSamples samples;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    if (scans[s].fold != fold) continue;
    for (std::size_t p = 0; p < patches_of(*scans[s].scan); ++p) {
      samples.scores.push_back(classifier.score(row_of(*scans[s].scan, p, columns)));
      samples.positive.push_back(scans[s].positive);
      samples.scans.push_back(static_cast<std::uint32_t>(s));
    }
  }
  return samples;
}

/// Whether both classes have training patches.
bool has_both(const SampleTable& table) {
  const auto positives = std::ranges::count(table.positive, std::uint8_t{1});
  return positives > 0 && static_cast<std::size_t>(positives) < table.size();
}

/// Trains on three folds and scores the fourth, for each group of features and each fold.
struct FoldScores {
  std::vector<ScoredSamples> trees, logistic;  ///< tests x folds

  FoldScores(std::span<const TestScan> scans, std::uint64_t seed, const Executor& executor)
      : trees(kTests * kRealismFolds), logistic(kTests * kRealismFolds) {
    const KnownGroups known = known_groups(scans);
    executor.for_chunks(kTests * kRealismFolds, 1, [&](std::size_t k, std::size_t) {
      const std::vector<std::size_t> columns =
          columns_of(kRealismFeatures[k / kRealismFolds].second, known);
      const std::size_t fold = k % kRealismFolds;
      const SampleTable table = training_table(scans, fold, columns, seed);
      if (columns.empty() || !has_both(table)) return;
      trees[k] = scored(scans, fold, columns, BoostedTrees(table, {}));
      logistic[k] = scored(scans, fold, columns, LogisticScore(table));
    });
  }
};

/// `scores`: one or several ways to split the same scans. `sets`: as auc_interval() takes them.
RealismTest test_of(std::span<const TestScan> scans, std::span<const FoldScores> scores,
                    std::span<const std::size_t> sets, std::uint64_t seed,
                    const Executor& executor) {
  RealismTest test{std::vector<std::optional<AucInterval>>(kTests),
                   std::vector<std::optional<AucInterval>>(kTests)};
  for (const TestScan& one : scans) test.patches += patches_of(*one.scan);
  const auto pooled = [&](const std::vector<ScoredSamples> FoldScores::*classifier, std::size_t t) {
    std::vector<ScoredSplit> splits;
    for (const FoldScores& split : scores) {
      const auto first =
          (split.*classifier).begin() + static_cast<std::ptrdiff_t>(t * kRealismFolds);
      splits.emplace_back(first, first + static_cast<std::ptrdiff_t>(kRealismFolds));
    }
    return auc_interval(splits, sets, seed);
  };
  const KnownGroups known = known_groups(scans);
  executor.for_chunks(kTests, 1, [&](std::size_t t, std::size_t) {
    if (columns_of(kRealismFeatures[t].second, known).empty()) return;
    test.trees[t] = pooled(&FoldScores::trees, t);
    test.logistic[t] = pooled(&FoldScores::logistic, t);
  });
  return test;
}

/// Whether the second scan of a pair of neighbours has the role of a simulated one, or the first.
/// Columns of an 8 x 8 Walsh matrix: over all orders, any two of eight pairs are split alike as
/// often as not; the first order is the Thue-Morse sequence, in which trends cancel.
bool second_is_positive(std::size_t pair, std::size_t order) {
  return std::popcount(pair & (kOrders - 1 - order)) % 2 == 0;
}

/// Halves of the real scans: one of every two neighbours has the role of a simulated scan. Changes
/// along the drive mislead the classifiers: a trend that rises in three folds falls in the fourth.
/// With few scans that costs some hundredths of AUC, so they are split in all eight orders.
RealismTest test_of_halves(std::span<const RealismScan> real, std::uint64_t seed,
                           const Executor& executor) {
  const std::size_t pairs = real.size() / 2, orders = real.size() <= kFewScans ? kOrders : 1;
  std::vector<TestScan> scans;
  std::vector<FoldScores> scores;
  for (std::size_t order = 0; order < orders; ++order) {
    scans.clear();
    for (std::size_t i = 0; i < 2 * pairs; ++i) {
      const bool is_second = i % 2 == 1;
      const bool positive = is_second == second_is_positive(i / 2, order);
      scans.push_back(
          {&real[i], positive ? std::uint8_t{1} : std::uint8_t{0}, fold_of(i / 2, pairs)});
    }
    scores.emplace_back(scans, seed, executor);
  }
  const std::size_t all = scans.size();
  return test_of(scans, scores, {&all, 1}, seed, executor);
}

/// Values of both sides; NaN does not count.
class TwoSides {
 public:
  void add(double value, bool is_simulated) {
    if (value != value) return;
    values_.push_back(value);
    simulated_.push_back(is_simulated ? 1 : 0);
  }

  StatisticPair pair() const {
    double sums[2] = {}, counts[2] = {};
    for (std::size_t k = 0; k < values_.size(); ++k) {
      sums[simulated_[k]] += values_[k];
      ++counts[simulated_[k]];
    }
    // Without values: 0 / 0, which is NaN.
    return {sums[0] / counts[0], sums[1] / counts[1], auc(values_, simulated_)};
  }

 private:
  std::vector<double> values_;
  std::vector<std::uint8_t> simulated_;
};

StatisticPair statistic_pair(std::span<const RealismScan> simulated,
                             std::span<const RealismScan> real, std::size_t statistic) {
  TwoSides sides;
  for (const RealismScan& scan : real) sides.add(scan.statistics[statistic], false);
  for (const RealismScan& scan : simulated) sides.add(scan.statistics[statistic], true);
  return sides.pair();
}

StatisticPair feature_pair(std::span<const RealismScan> simulated,
                           std::span<const RealismScan> real, std::size_t feature) {
  TwoSides sides;
  const auto add = [&](std::span<const RealismScan> scans, bool is_simulated) {
    for (const RealismScan& scan : scans)
      for (std::size_t k = feature; k < scan.patches.size(); k += patch_features().size())
        sides.add(static_cast<double>(scan.patches[k]), is_simulated);
  };
  add(real, false);
  add(simulated, true);
  return sides.pair();
}

void require_scans(std::span<const RealismScan> scans, const std::string& side) {
  if (scans.size() < kMinRealismScans)
    throw Error(ErrorKind::data, side + " has " + std::to_string(scans.size()) +
                                     " scans, expected at least " +
                                     std::to_string(kMinRealismScans) +
                                     ": two in each block of the cross-validation");
  const auto has_patches = [](const RealismScan& scan) { return patches_of(scan) > 0; };
  if (std::ranges::none_of(scans, has_patches))
    throw Error(ErrorKind::data, side + " has no patch of " + std::to_string(kPatchRings) + " x " +
                                     std::to_string(kPatchColumns) + " beams with " +
                                     std::to_string(kMinInPatch) + " returns");
}

}  // namespace

RealismResult compare_realism(std::span<const RealismScan> simulated,
                              std::span<const RealismScan> real, std::uint64_t seed,
                              const Executor& executor) {
  require_scans(simulated, "SIMULATED");
  require_scans(real, "REAL");
  std::vector<TestScan> scans;
  for (std::size_t i = 0; i < real.size(); ++i)
    scans.push_back({&real[i], 0, fold_of(i, real.size())});
  for (std::size_t i = 0; i < simulated.size(); ++i)
    scans.push_back({&simulated[i], 1, fold_of(i, simulated.size())});
  const FoldScores scores(scans, seed, executor);
  const std::size_t sets[] = {real.size(), simulated.size()};
  RealismResult result;
  result.simulated_real = test_of(scans, {&scores, 1}, sets, seed, executor);
  result.real_real = test_of_halves(real, seed, executor);
  for (std::size_t s = 0; s < scan_statistics().size(); ++s)
    result.statistics.push_back(statistic_pair(simulated, real, s));
  result.features.resize(patch_features().size());
  executor.for_chunks(result.features.size(), 1, [&](std::size_t f, std::size_t) {
    result.features[f] = feature_pair(simulated, real, f);
  });
  return result;
}

}  // namespace adasplats
