// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/unit/unit_accuracy.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/evaluate/intensity_agreement.h"
#include "adasplats/evaluate/share.h"
#include "adasplats/simulate/scan/intensity_rules.h"
#include "adasplats/simulate/scan/ray_drop.h"

namespace adasplats {
namespace {

constexpr float kNearModel_m = 0.5F;

struct MeasuredIntensities {
  std::vector<float> expected, measured;
};

/// Sum of squares about the best non-decreasing curve (pool adjacent violators). Equal expected
/// values form one pool.
double squares_after_curve(const MeasuredIntensities& pairs) {
  std::vector<std::uint32_t> order(pairs.expected.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return pairs.expected[a] != pairs.expected[b] ? pairs.expected[a] < pairs.expected[b] : a < b;
  });
  struct Pool {
    double sum = 0, squares = 0, count = 0;
    double mean() const { return sum / count; }
  };
  std::vector<Pool> pools;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    Pool pool;
    for (; end < order.size() && pairs.expected[order[end]] == pairs.expected[order[begin]];
         ++end) {
      const auto value = static_cast<double>(pairs.measured[order[end]]);
      pool.sum += value;
      pool.squares += value * value;
      ++pool.count;
    }
    while (!pools.empty() && pools.back().mean() >= pool.mean()) {
      pool.sum += pools.back().sum;
      pool.squares += pools.back().squares;
      pool.count += pools.back().count;
      pools.pop_back();
    }
    pools.push_back(pool);
  }
  double squares = 0;
  for (const Pool& pool : pools) squares += pool.squares - pool.sum * pool.mean();
  return squares;
}

UnitIntensityAccuracy accuracy_of(const MeasuredIntensities& pairs) {
  UnitIntensityAccuracy accuracy;
  accuracy.returns = pairs.measured.size();
  if (pairs.measured.empty()) {
    accuracy.rank_correlation = accuracy.rmse_after_curve = kNaN;
    return accuracy;
  }
  accuracy.rank_correlation = rank_correlation(pairs.expected, pairs.measured);
  accuracy.rmse_after_curve =
      std::sqrt(std::max(squares_after_curve(pairs), 0.0) / static_cast<double>(accuracy.returns)) /
      full_scale_of(pairs.measured);
  return accuracy;
}

/// The prediction for a beam.
struct BeamPrediction {
  double chance = 0;  ///< probability of being lost
  bool blocked = false;
};

BeamPrediction prediction_of(const SensorBeam& beam, const LidarModel& unit) {
  BeamPrediction prediction;
  const bool out_of_range = !beam.hit || static_cast<double>(beam.expected_m) > unit.max_range_m;
  prediction.chance = out_of_range ? 1 : 0;
  if (!unit.drop) return prediction;
  prediction.blocked = unit.drop->blocks(beam.direction);
  if (prediction.blocked) prediction.chance = 1;
  if (prediction.chance < 1) prediction.chance = drop_probability(*unit.drop, beam.conditions());
  return prediction;
}

struct DropCount {
  UnitDropAccuracy accuracy;
  std::size_t right = 0;

  void add(bool lost, bool predicted) {
    DropAccuracy& beams = accuracy.beams;
    ++beams.beams;
    beams.empty += lost ? 1 : 0;
    beams.predicted += predicted ? 1 : 0;
    beams.right += lost && predicted ? 1 : 0;
    right += lost == predicted ? 1 : 0;
  }
  UnitDropAccuracy result() {
    accuracy.right_share = share_of(right, accuracy.beams.beams);
    return accuracy;
  }
};

/// The threshold that as many chances exceed as the sum of all chances.
double chance_by_rate(std::vector<double> chances) {
  const double lost = std::accumulate(chances.begin(), chances.end(), 0.0);
  std::ranges::sort(chances, std::greater<>());
  const auto last = static_cast<std::size_t>(lost);
  return last < chances.size() ? chances[last] : 0;
}

}  // namespace

UnitAccuracy unit_accuracy(std::span<const SensorBeam> beams, const LidarModel& unit) {
  IntensityRules rules;
  if (unit.intensity) rules = intensity_rules(*unit.intensity);
  MeasuredIntensities all, near;
  DropCount drop, unblocked, by_rate;
  std::vector<double> chances;
  std::vector<std::uint8_t> lost;
  for (const SensorBeam& beam : beams) {
    const BeamPrediction prediction = prediction_of(beam, unit);
    drop.add(!beam.returned(), prediction.chance > 0.5);
    if (!prediction.blocked) {
      unblocked.add(!beam.returned(), prediction.chance > 0.5);
      chances.push_back(prediction.chance);
      lost.push_back(beam.returned() ? 0 : 1);
    }
    if (!beam.returned() || !beam.hit || !std::isfinite(beam.intensity) ||
        !std::isfinite(beam.expected_intensity))
      continue;
    const float expected = level_of(rules, beam.ring, beam.expected_intensity);
    const bool is_near = std::fabs(beam.range_m - beam.expected_m) < kNearModel_m;
    for (MeasuredIntensities* pairs : {&all, is_near ? &near : nullptr}) {
      if (pairs == nullptr) continue;
      pairs->expected.push_back(expected);
      pairs->measured.push_back(beam.intensity);
    }
  }
  const double threshold = chance_by_rate(chances);
  for (std::size_t i = 0; i < chances.size(); ++i)
    by_rate.add(lost[i] != 0, chances[i] > threshold);
  return {accuracy_of(all), accuracy_of(near), drop.result(), unblocked.result(), by_rate.result()};
}

}  // namespace adasplats
