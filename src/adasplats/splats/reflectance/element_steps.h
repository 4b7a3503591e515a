// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "adasplats/core/fetch_add.h"
#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/elementary.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/reflectance/response_tables.h"

namespace adasplats {

// The work of the reflectance steps for one element, in the order of the steps. Shared sums are
// integers, so any loop may run it (for_each and sum of a backend).

/// Maximum of numbers that are at least 0.
struct LargestOf {
  float value = 0;

  ADASPLATS_HD void add(float other) { value = std::max(value, other); }
  ADASPLATS_HD LargestOf& operator+=(const LargestOf& other) {
    add(other.value);
    return *this;
  }
};

/// Finds the maximum of the finite numbers.
struct FindLargest {
  const float* values;

  ADASPLATS_HD void operator()(std::size_t i, LargestOf& largest) const {
    if (std::isfinite(values[i])) largest.add(values[i]);
  }
};

struct RayCount {
  std::uint64_t rays = 0;

  ADASPLATS_HD RayCount& operator+=(const RayCount& other) {
    rays += other.rays;
    return *this;
  }
};

/// Adds up the numbers of rays that met each disk.
struct AddCounts {
  const std::uint32_t* counts;

  ADASPLATS_HD void operator()(std::size_t i, RayCount& all) const { all.rays += counts[i]; }
};

/// In place of the intensity of a beam without return.
inline constexpr float kLostIntensity = -std::numeric_limits<float>::infinity();

/// What one measured ray contributes to the disk that it met.
struct Observation {
  static constexpr std::uint32_t kNone = 0xffffffffU;
  std::uint32_t disk = kNone;
  float intensity = 0;        ///< divided by the unit of intensities, 0..1; or kLostIntensity
  float range_position = 0;   ///< position_among() the nodes of ranges
  float cosine_position = 0;  ///< position_among() the nodes of cosines of incidence

  ADASPLATS_HD bool lost() const { return intensity < 0; }
};

/// Records the rays that meet the model near their ends, and counts them by disk.
struct ObserveRay {
  const Disk* disks;
  const float* intensities;  ///< of the points
  double per_intensity;      ///< 1 over the unit of intensities
  ResponseNodes nodes;
  Observation* observations;  ///< one per ray
  std::uint32_t* counts;      ///< one per disk

  /// Rays are cast this much farther than their points, m.
  static constexpr float kBeyond_m = 1.0F;

  /// `point`: the point of ray `i`; `hit`: its nearest hit.
  ADASPLATS_HD void operator()(std::size_t i, std::uint32_t point, const Ray& ray, float range_m,
                               Hit hit) const {
    const Observation seen = observation(intensities[point], ray, range_m, hit);
    observations[i] = seen;
    if (seen.disk != Observation::kNone) fetch_add(counts[seen.disk], 1);
  }

 private:
  ADASPLATS_HD Observation observation(float intensity, const Ray& ray, float range_m,
                                       Hit hit) const {
    // Chosen well above the model's errors (median 3 cm, docs/results.md): a ray that ends farther
    // away met another object.
    const float tolerance_m = 0.2F + 0.005F * range_m;
    const bool lost = intensity == kLostIntensity;
    if (!hit.valid() || (!std::isfinite(intensity) && !lost)) return {};
    if (!lost && !(std::fabs(hit.t - range_m) < tolerance_m)) return {};
    const float cosine = std::min(std::fabs(dot(ray.direction, disks[hit.primitive].normal)), 1.0F);
    const double share = static_cast<double>(std::max(intensity, 0.0F)) * per_intensity;
    return {hit.primitive, lost ? kLostIntensity : static_cast<float>(share),
            position_among(nodes.ranges_m, lost ? hit.t : range_m),
            position_among(nodes.cosines, cosine)};
  }
};

/// Sorts observations by disk; the order within a disk is arbitrary.
struct PutByDisk {
  const Observation* from;
  const std::uint64_t* begins;  ///< of the disks
  std::uint32_t* left;          ///< observations that a disk still gets
  Observation* to;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const std::uint32_t disk = from[i].disk;
    if (disk == Observation::kNone) return;
    to[begins[disk] + fetch_add(left[disk], 0U - 1U) - 1] = from[i];
  }
};

/// Key of a splat: equal for splats in the same cell with the same main axis of the normal.
struct FindCell {
  /// Chosen: larger cells mix materials, smaller ones have no more rays than the splat itself.
  static constexpr float kCell_m = 0.4F;

  const Disk* disks;
  std::uint64_t* keys;

  ADASPLATS_HD void operator()(std::size_t i) const {
    constexpr std::uint64_t kMask = (1 << 20) - 1;
    const Disk& disk = disks[i];
    const Vec3f n = {std::fabs(disk.normal.x), std::fabs(disk.normal.y), std::fabs(disk.normal.z)};
    std::uint64_t key = n.y >= n.z ? 1 : 2;
    if (n.x >= n.y && n.x >= n.z) key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto cell = static_cast<std::int64_t>(std::floor(disk.center[axis] / kCell_m));
      key = key << 20 | (static_cast<std::uint64_t>(cell) & kMask);
    }
    keys[i] = key;
  }
};

/// Least squares of one value, intensity = value * gain, in units of kShareUnit.
struct ValueSums {
  std::int64_t product = 0;  ///< of intensities and gains
  std::int64_t square = 0;   ///< of gains

  ADASPLATS_HD ValueSums& operator+=(const ValueSums& other) {
    product += other.product;
    square += other.square;
    return *this;
  }
};

/// The sums of a disk over its rays.
struct SumOfDisk {
  const Observation* observations;
  const std::uint64_t* begins;
  ResponseGains gains;
  double per_gain;  ///< 1 over the unit of gains, which is their upper bound
  ValueSums* sums;

  ADASPLATS_HD void operator()(std::size_t disk) const {
    ValueSums sum;
    for (std::uint64_t k = begins[disk]; k < begins[disk + 1]; ++k) {
      const Observation& seen = observations[k];
      if (seen.lost()) continue;
      const float gain = value_at(gains.of_ranges, seen.range_position) *
                         value_at(gains.of_cosines, seen.cosine_position);
      const double share = static_cast<double>(gain) * per_gain;
      sum.product += whole_units(static_cast<double>(seen.intensity) * share);
      sum.square += whole_units(share * share);
    }
    sums[disk] = sum;
  }
};

struct AddSums {
  const ValueSums* sums;

  ADASPLATS_HD void operator()(std::size_t i, ValueSums& all) const { all += sums[i]; }
};

/// Sets the reflectances of a cell's disks: each is drawn to the mean of the cell, and that to the
/// mean of the model.
struct SetReflectances {
  /// Weights, in rays, of the mean of the cell and of the mean of the model. Intensities scatter by
  /// a third from ray to ray; on kitti-0005, 1 to 8 perform equally well.
  static constexpr double kCellRays = 3;
  static constexpr double kModelRays = 4;

  const std::uint32_t* order;   ///< disks, cell by cell
  const std::uint32_t* begins;  ///< of the cells
  const ValueSums* sums;        ///< of the disks
  double gain_unit;
  double usual;
  const float* fallback;  ///< of the disks, intensities
  double per_intensity;
  float* values;  ///< of the disks, as shares of the unit of intensities

  ADASPLATS_HD void operator()(std::size_t cell) const {
    ValueSums all;
    for (std::uint32_t k = begins[cell]; k < begins[cell + 1]; ++k) all += sums[order[k]];
    const double of_cell = value(all, usual, kModelRays);
    for (std::uint32_t k = begins[cell]; k < begins[cell + 1]; ++k) {
      const std::uint32_t disk = order[k];
      const double found = all.square > 0 ? value(sums[disk], of_cell, kCellRays) : unseen(disk);
      values[disk] = static_cast<float>(found);
    }
  }

 private:
  /// The fit with `rays` additional rays of the value `otherwise`.
  ADASPLATS_HD double value(const ValueSums& sum, double otherwise, double rays) const {
    const double product = static_cast<double>(sum.product) * (kShareUnit * gain_unit);
    const double square = static_cast<double>(sum.square) * (kShareUnit * gain_unit * gain_unit);
    return (product + rays * otherwise) / (square + rays);
  }
  /// Value of a disk in a cell without rays.
  ADASPLATS_HD double unseen(std::uint32_t disk) const {
    if (!std::isfinite(fallback[disk])) return usual;
    return static_cast<double>(std::max(fallback[disk], 0.0F)) * per_intensity;
  }
};

using RangeSums = TableSums<ResponseNodes::kRanges>;
using CosineSums = TableSums<ResponseNodes::kCosines>;

// ---- lost beams ------------------------------------------------------------------------------

/// Index of the node nearest to a position_among().
ADASPLATS_HD inline std::size_t nearest_node(float position) {
  const auto below = static_cast<std::size_t>(position);
  return position - static_cast<float>(below) < 0.5F ? below : below + 1;
}

/// By node: lost beams, and how many of them are expected, in units of kShareUnit.
template <std::size_t N>
struct LossSums {
  std::array<std::int64_t, N> lost = {};
  std::array<std::int64_t, N> expected = {};

  ADASPLATS_HD LossSums& operator+=(const LossSums& other) {
    for (std::size_t k = 0; k < N; ++k) {
      lost[k] += other.lost[k];
      expected[k] += other.expected[k];
    }
    return *this;
  }
};

/// Shares of lost beams by range, and factors on them by incidence.
struct LossRates {
  std::array<float, ResponseNodes::kRanges> of_ranges;
  std::array<float, ResponseNodes::kCosines> of_cosines;

  ADASPLATS_HD double share(const Observation& seen) const {
    constexpr double kMost = 0.9;
    const double product = static_cast<double>(of_ranges[nearest_node(seen.range_position)]) *
                           static_cast<double>(of_cosines[nearest_node(seen.cosine_position)]);
    return product < kMost ? product : kMost;
  }
};

/// Expects the loss of every beam.
struct AddLossByRange {
  const Observation* observations;

  ADASPLATS_HD void operator()(std::size_t i, LossSums<ResponseNodes::kRanges>& sums) const {
    const std::size_t node = nearest_node(observations[i].range_position);
    sums.lost[node] += observations[i].lost() ? 1 : 0;
    sums.expected[node] += whole_units(1);
  }
};

/// Expects the losses by range.
struct AddLossByCosine {
  const Observation* observations;
  LossRates rates;

  ADASPLATS_HD void operator()(std::size_t i, LossSums<ResponseNodes::kCosines>& sums) const {
    const std::size_t node = nearest_node(observations[i].cosine_position);
    sums.lost[node] += observations[i].lost() ? 1 : 0;
    sums.expected[node] += whole_units(rates.share(observations[i]));
  }
};

/// Sets the log odds of a disk's losses relative to what the rates expect.
struct SetDropLogOdds {
  /// Rays that are added at the expected rate. Chosen on the even scans of kitti-0005, which give
  /// a disk 10 rays on average: 2 predict the odd ones as well.
  static constexpr double kPriorRays = 4;

  const Observation* observations;
  const std::uint64_t* begins;  ///< of the disks
  LossRates rates;
  float* log_odds;

  ADASPLATS_HD void operator()(std::size_t disk) const {
    std::int64_t lost = 0, expected = 0;
    for (std::uint64_t k = begins[disk]; k < begins[disk + 1]; ++k) {
      lost += observations[k].lost() ? 1 : 0;
      expected += whole_units(rates.share(observations[k]));
    }
    const auto rays = static_cast<double>(begins[disk + 1] - begins[disk]);
    if (rays == 0) {
      log_odds[disk] = 0;
      return;
    }
    const double usual = kShareUnit * static_cast<double>(expected) / rays;
    const double share = (static_cast<double>(lost) + kPriorRays * usual) / (rays + kPriorRays);
    log_odds[disk] = static_cast<float>(log_of(share * (1 - usual) / (usual * (1 - share))));
  }
};

/// Adds an observation to the fit of the range gains, with the other gains and the reflectances
/// fixed.
struct AddToRanges {
  const Observation* observations;
  const float* values;  ///< of the disks
  ResponseGains gains;
  double per_factor;  ///< 1 over the unit of values times gains, which is their upper bound

  ADASPLATS_HD void operator()(std::size_t i, RangeSums& sums) const {
    const Observation& seen = observations[i];
    if (seen.lost()) return;
    const auto gain = static_cast<double>(value_at(gains.of_cosines, seen.cosine_position));
    sums.add(seen.range_position, static_cast<double>(seen.intensity),
             static_cast<double>(values[seen.disk]) * gain * per_factor);
  }
};

/// Adds an observation to the fit of the incidence gains.
struct AddToCosines {
  const Observation* observations;
  const float* values;
  ResponseGains gains;
  double per_factor;

  ADASPLATS_HD void operator()(std::size_t i, CosineSums& sums) const {
    const Observation& seen = observations[i];
    if (seen.lost()) return;
    const auto gain = static_cast<double>(value_at(gains.of_ranges, seen.range_position));
    sums.add(seen.cosine_position, static_cast<double>(seen.intensity),
             static_cast<double>(values[seen.disk]) * gain * per_factor);
  }
};

}  // namespace adasplats
