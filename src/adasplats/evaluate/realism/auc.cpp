// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/auc.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kBootstrapStream = 0x617563;  // "auc"
constexpr std::size_t kReplicates = 1000;             // enough for the bounds

/// Samples by rising score; those with equal scores have the same group.
struct Ranked {
  std::vector<std::uint32_t> scans, groups;
  std::vector<std::uint8_t> positive;
};

Ranked ranked(const ScoredSamples& samples) {
  std::vector<std::uint32_t> order(samples.scores.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return samples.scores[a] != samples.scores[b] ? samples.scores[a] < samples.scores[b] : a < b;
  });
  Ranked result;
  std::uint32_t group = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && samples.scores[order[k]] != samples.scores[order[k - 1]]) ++group;
    result.scans.push_back(samples.scans[order[k]]);
    result.positive.push_back(samples.positive[order[k]]);
    result.groups.push_back(group);
  }
  return result;
}

struct Pairs {
  double won = 0, all = 0;
};

/// Adds the pairs of one part, each sample as often as its scan was drawn.
void add_pairs(const Ranked& samples, std::span<const double> weights, Pairs& pairs) {
  double below = 0, positives = 0;
  for (std::size_t begin = 0, end = 0; begin < samples.groups.size(); begin = end) {
    double negative = 0, positive = 0;
    for (end = begin; end < samples.groups.size() && samples.groups[end] == samples.groups[begin];
         ++end)
      (samples.positive[end] != 0 ? positive : negative) += weights[samples.scans[end]];
    pairs.won += positive * (below + 0.5 * negative);
    below += negative;
    positives += positive;
  }
  pairs.all += positives * below;
}

double share_won(std::span<const Ranked> parts, std::span<const double> weights) {
  Pairs pairs;
  for (const Ranked& part : parts) add_pairs(part, weights, pairs);
  return pairs.all > 0 ? pairs.won / pairs.all : std::numeric_limits<double>::quiet_NaN();
}

/// How often each scan is drawn: as many draws as there are, with replacement.
void draw(std::span<double> weights, Random& random) {
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double at = random.uniform() * static_cast<double>(weights.size());
    weights[std::min(static_cast<std::size_t>(at), weights.size() - 1)] += 1;
  }
}

}  // namespace

double auc(std::span<const double> scores, std::span<const std::uint8_t> positive) {
  ScoredSamples samples;
  samples.scores.assign(scores.begin(), scores.end());
  samples.positive.assign(positive.begin(), positive.end());
  samples.scans.assign(scores.size(), 0);
  const Ranked one = ranked(samples);
  const double weight = 1;
  return share_won({&one, 1}, {&weight, 1});
}

AucInterval auc_interval(std::span<const ScoredSplit> splits, std::span<const std::size_t> sets,
                         std::uint64_t seed) {
  const std::size_t scans = std::accumulate(sets.begin(), sets.end(), std::size_t{0});
  AucInterval result;
  std::vector<std::vector<Ranked>> sorted;
  for (const ScoredSplit& split : splits) {
    std::vector<Ranked>& parts = sorted.emplace_back();
    for (const ScoredSamples& part : split) parts.push_back(ranked(part));
    result.mean +=
        share_won(parts, std::vector<double>(scans, 1)) / static_cast<double>(splits.size());
  }
  std::vector<double> drawn;
  for (std::size_t replicate = 0; replicate < kReplicates; ++replicate) {
    Random random(seed, kBootstrapStream, replicate);
    std::vector<double> weights(scans, 0);
    for (std::size_t first = 0; const std::size_t set : sets) {
      draw(std::span(weights).subspan(first, set), random);
      first += set;
    }
    const double share = share_won(sorted[replicate % sorted.size()], weights);
    if (share == share) drawn.push_back(share);  // NaN: no part has scans of both classes
  }
  if (drawn.empty()) return {result.mean, result.mean, result.mean};
  std::ranges::sort(drawn);
  const auto at = [&](double quantile) {
    return drawn[static_cast<std::size_t>(quantile * static_cast<double>(drawn.size() - 1))];
  };
  result.low = at(0.025);
  result.high = at(0.975);
  return result;
}

}  // namespace adasplats
