// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "adasplats/evaluate/realism/classifiers.h"

namespace adasplats {
namespace {

constexpr std::size_t kBins = 64;  // the first one is for NaN and the smallest values

/// Bounds between the bins of a feature, ascending: bin b holds values of [bounds[b - 1],
/// bounds[b]).
std::vector<float> bin_bounds(const SampleTable& samples, std::size_t feature) {
  std::vector<float> values;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const float value = samples.row(i)[feature];
    if (value == value) values.push_back(value);
  }
  std::ranges::sort(values);
  std::vector<float> bounds;
  for (std::size_t k = 0; k + 1 < kBins && !values.empty(); ++k) {
    const float bound = values[k * values.size() / (kBins - 1)];
    if (bounds.empty() || bound > bounds.back()) bounds.push_back(bound);
  }
  return bounds;
}

struct Slopes {
  double gradient = 0, weight = 0;
};

double gain_of(Slopes sum, double ridge) {
  return sum.gradient * sum.gradient / (sum.weight + ridge);
}

struct Split {
  double gain = 0;
  std::uint32_t feature = 0, bin = 0;  ///< bins up to this one go left
};

}  // namespace

/// State while trees are grown.
struct BoostedTrees::Growth {
  const SampleTable& samples;
  const TreeOptions& options;
  std::vector<std::vector<float>> bounds;       ///< feature by feature
  std::vector<std::vector<std::uint8_t>> bins;  ///< ..., one per sample
  std::vector<double> scores;
  std::vector<Slopes> slopes;
  std::vector<std::uint32_t> leaves;  ///< node of each sample

  Growth(const SampleTable& table, const TreeOptions& tree_options)
      : samples(table), options(tree_options), slopes(table.size()), leaves(table.size()) {
    for (std::size_t f = 0; f < samples.columns; ++f) {
      bounds.push_back(bin_bounds(samples, f));
      std::vector<std::uint8_t>& own = bins.emplace_back();
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const float value = samples.row(i)[f];
        const auto place = std::ranges::upper_bound(bounds[f], value);
        own.push_back(value == value ? static_cast<std::uint8_t>(place - bounds[f].begin()) : 0);
      }
    }
  }

  void update_slopes() {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double p = 1 / (1 + std::exp(-scores[i]));
      slopes[i] = {static_cast<double>(samples.positive[i]) - p, p * (1 - p)};
    }
  }

  /// The best split of each node from `first` on.
  std::vector<Split> best_splits(std::size_t first, std::size_t nodes) const {
    std::vector<Split> best(nodes);
    std::vector<std::array<Slopes, kBins>> sums(nodes);
    for (std::size_t f = 0; f < samples.columns; ++f) {
      if (bounds[f].empty()) continue;
      std::ranges::fill(sums, std::array<Slopes, kBins>{});
      for (std::size_t i = 0; i < samples.size(); ++i) {
        if (leaves[i] < first) continue;
        Slopes& sum = sums[leaves[i] - first][bins[f][i]];
        sum.gradient += slopes[i].gradient;
        sum.weight += slopes[i].weight;
      }
      for (std::size_t n = 0; n < nodes; ++n)
        improve(sums[n], static_cast<std::uint32_t>(f), best[n]);
    }
    return best;
  }

  void improve(const std::array<Slopes, kBins>& sums, std::uint32_t feature, Split& best) const {
    Slopes all;
    for (const Slopes& sum : sums) {
      all.gradient += sum.gradient;
      all.weight += sum.weight;
    }
    Slopes left;
    for (std::uint32_t bin = 0; bin < bounds[feature].size(); ++bin) {
      left.gradient += sums[bin].gradient;
      left.weight += sums[bin].weight;
      const Slopes right = {all.gradient - left.gradient, all.weight - left.weight};
      if (left.weight < options.min_weight || right.weight < options.min_weight) continue;
      const double gain = gain_of(left, options.ridge) + gain_of(right, options.ridge) -
                          gain_of(all, options.ridge);
      if (gain > best.gain + 1e-12) best = {gain, feature, bin};
    }
  }

  Tree grow() {
    Tree tree(1);
    std::ranges::fill(leaves, 0U);
    std::size_t first = 0;
    for (std::size_t level = 0; level < options.depth; ++level) {
      const std::size_t nodes = tree.size() - first;
      const std::vector<Split> splits = best_splits(first, nodes);
      const std::size_t next = tree.size();
      for (std::size_t n = 0; n < nodes; ++n) {
        if (!(splits[n].gain > 0)) continue;
        Node& node = tree[first + n];
        node.feature = splits[n].feature;
        node.bound = bounds[node.feature][splits[n].bin];
        node.left = static_cast<std::int32_t>(tree.size());
        tree.resize(tree.size() + 2);
      }
      if (tree.size() == next) break;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        if (leaves[i] < first || tree[leaves[i]].left < 0) continue;
        const Split& split = splits[leaves[i] - first];
        const bool goes_right = bins[split.feature][i] > split.bin;
        leaves[i] = static_cast<std::uint32_t>(tree[leaves[i]].left) + (goes_right ? 1U : 0U);
      }
      first = next;
    }
    set_values(tree);
    return tree;
  }

  void set_values(Tree& tree) {
    std::vector<Slopes> sums(tree.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      sums[leaves[i]].gradient += slopes[i].gradient;
      sums[leaves[i]].weight += slopes[i].weight;
    }
    for (std::size_t n = 0; n < tree.size(); ++n)
      tree[n].value = options.learning_rate * sums[n].gradient / (sums[n].weight + options.ridge);
    for (std::size_t i = 0; i < samples.size(); ++i) scores[i] += tree[leaves[i]].value;
  }
};

BoostedTrees::BoostedTrees(const SampleTable& samples, const TreeOptions& options) {
  const auto positives = static_cast<double>(
      std::accumulate(samples.positive.begin(), samples.positive.end(), std::size_t{0}));
  const double negatives = static_cast<double>(samples.size()) - positives;
  if (!(positives > 0 && negatives > 0))
    throw std::logic_error("boosted trees need samples of both classes");
  bias_ = std::log(positives / negatives);
  Growth growth(samples, options);
  growth.scores.assign(samples.size(), bias_);
  for (std::size_t t = 0; t < options.trees; ++t) {
    growth.update_slopes();
    trees_.push_back(growth.grow());
  }
}

double BoostedTrees::score(std::span<const float> row) const {
  double sum = bias_;
  for (const Tree& tree : trees_) {
    std::size_t at = 0;
    while (tree[at].left >= 0) {
      const bool goes_right = row[tree[at].feature] >= tree[at].bound;  // NaN: no
      at = static_cast<std::size_t>(tree[at].left) + (goes_right ? 1U : 0U);
    }
    sum += tree[at].value;
  }
  return sum;
}

}  // namespace adasplats
