// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/reflectance/reflectance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "adasplats/core/progress_meter.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {
namespace {

/// Nodes of the response's tables. Choices: denser near the sensor, where echoes change most with
/// range; finer ones follow noise and what chanced to stand there, coarser ones miss the bends.
constexpr std::array<float, 18> kRanges_m = {2,  4,  6,  8,  10, 12, 14, 16, 18,
                                             20, 25, 30, 35, 40, 50, 60, 80, 100};
constexpr std::size_t kUnitRange = 4;  // whose gain is 1, by definition: 10 m (docs/noise.md)
constexpr std::array<float, 11> kCosines = {0.0F, 0.1F, 0.2F, 0.3F, 0.4F, 0.5F,
                                            0.6F, 0.7F, 0.8F, 0.9F, 1.0F};
constexpr std::size_t kUnitCosine = kCosines.size() - 1;
constexpr std::size_t kMostNodes = 18;  // of the two tables
/// A choice: some 35 rays a node of the tables. Fewer say more of their noise than of the sensor.
constexpr std::size_t kLeastRays = 1000;
/// Of both fits. A choice: each takes a pass over all rays.
constexpr int kTurns = 5;

/// Rays that count where a splat has few: of the splats in the same cell, and of all splats there.
/// Intensities scatter by a third from ray to ray; with kitti-0005, 1 to 8 do equally well.
constexpr double kCellRays = 3;
constexpr double kModelRays = 4;
/// A choice: larger cells mix materials, smaller ones have no more rays than the splat itself.
constexpr float kCell_m = 0.4F;

/// The node below `value` and how far it is from there to the next, 0..1.
struct NodePlace {
  std::size_t below;
  float share;
};

NodePlace place_of(std::span<const float> nodes, float value) {
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, value);
  const auto below = static_cast<std::size_t>(above - nodes.begin()) - 1;
  const float share = (value - nodes[below]) / (nodes[below + 1] - nodes[below]);
  return {below, std::clamp(share, 0.0F, 1.0F)};
}

float table_value(std::span<const float> nodes, std::span<const float> values, float at) {
  if (values.size() < 2 || nodes.size() != values.size()) return values.empty() ? 1.0F : values[0];
  const NodePlace place = place_of(nodes, at);
  return values[place.below] + place.share * (values[place.below + 1] - values[place.below]);
}

/// What one measured ray says of the disk that it met.
struct Observation {
  float intensity;
  float range_m;
  float cos_incidence;
};

/// Observations disk by disk.
struct Observations {
  std::vector<Observation> rays;
  std::vector<std::uint32_t> first;  ///< rays[first[d]] to rays[first[d + 1]] met disk d

  std::span<const Observation> of(std::size_t disk) const {
    return std::span(rays).subspan(first[disk], first[disk + 1] - first[disk]);
  }
};

/// Casts the rays of `cloud` in batches and keeps those that meet the model where they ended.
class RayCollector {
 public:
  RayCollector(std::span<const Disk> disks, const Tracer& tracer, const PointCloud& cloud,
               Vec3d model_origin, const Executor& executor)
      : disks_(disks),
        tracer_(tracer),
        cloud_(cloud),
        model_from_cloud_(vec_cast<float>(cloud.origin - model_origin)),
        executor_(executor) {}

  Observations collect() {
    constexpr std::size_t kBatch = 1 << 20;  // rays: bounds the memory, does not change values
    constexpr double kLeastRange_m = 1e-3;   // a ray has a direction
    const MeasuredRays measured(cloud_, kLeastRange_m, executor_);
    const ProgressPass pass(executor_, 2 * measured.size());  // made, cast
    for (std::size_t begin = 0; begin < measured.size(); begin += kBatch) {
      add_batch(measured, begin, std::min(begin + kBatch, measured.size()));
    }
    return by_disk();
  }

 private:
  void add_batch(const MeasuredRays& measured, std::size_t begin, std::size_t end) {
    std::vector<Ray> rays(end - begin);
    std::vector<Hit> hits(end - begin);
    executor_.for_chunks(rays.size(), kCoarseGrain, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) {
        rays[k] = measured.ray(begin + k, 1.0F);
        rays[k].origin = rays[k].origin + model_from_cloud_;
      }
    });
    tracer_.nearest(rays, hits, executor_);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const float intensity = cloud_.intensities[measured.point(begin + k)];
      const float range_m = measured.range_m(begin + k);
      // A choice, well beyond the model's errors (a median of 3 cm, docs/fidelity.md): a ray that
      // ends farther away met something else.
      const float tolerance_m = 0.2F + 0.005F * range_m;
      if (!hits[k].valid() || !std::isfinite(intensity)) continue;
      if (!(std::fabs(hits[k].t - range_m) < tolerance_m)) continue;
      const Vec3f normal = disks_[hits[k].primitive].normal;
      met_.push_back(hits[k].primitive);
      found_.push_back({std::max(intensity, 0.0F), range_m,
                        std::min(std::fabs(dot(rays[k].direction, normal)), 1.0F)});
    }
  }

  Observations by_disk() {
    Observations result;
    result.first.assign(disks_.size() + 1, 0);
    for (const std::uint32_t disk : met_) ++result.first[disk + 1];
    for (std::size_t d = 0; d < disks_.size(); ++d) result.first[d + 1] += result.first[d];
    std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
    result.rays.resize(found_.size());
    for (std::size_t k = 0; k < found_.size(); ++k) result.rays[next[met_[k]]++] = found_[k];
    return result;
  }

  std::span<const Disk> disks_;
  const Tracer& tracer_;
  const PointCloud& cloud_;
  Vec3f model_from_cloud_;
  const Executor& executor_;
  std::vector<std::uint32_t> met_;
  std::vector<Observation> found_;
};

/// Splats that lie near each other and face alike: cells[d] of disk d, numbered from 0.
struct DiskCells {
  std::vector<std::uint32_t> of_disk;
  std::size_t count = 0;
};

std::uint64_t cell_key(const Disk& disk) {
  constexpr std::uint64_t kMask = (1 << 20) - 1;
  const Vec3f n = {std::fabs(disk.normal.x), std::fabs(disk.normal.y), std::fabs(disk.normal.z)};
  std::uint64_t key = 2;
  if (n.x >= n.y && n.x >= n.z) {
    key = 0;
  } else if (n.y >= n.z) {
    key = 1;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(disk.center[axis] / kCell_m));
    key = key << 20 | (static_cast<std::uint64_t>(cell) & kMask);
  }
  return key;
}

DiskCells cells_of(std::span<const Disk> disks, const Executor& executor) {
  std::vector<std::uint64_t> keys(disks.size());
  for (std::size_t d = 0; d < disks.size(); ++d) keys[d] = cell_key(disks[d]);
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);
  DiskCells cells;
  cells.of_disk.resize(disks.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || keys[k] != keys[k - 1]) ++cells.count;
    cells.of_disk[order[k]] = static_cast<std::uint32_t>(cells.count - 1);
  }
  return cells;
}

/// Least squares of one value: intensity = value * gain.
struct Fit {
  double product = 0;  ///< of intensities and gains
  double square = 0;   ///< of gains

  Fit& operator+=(const Fit& other) {
    product += other.product;
    square += other.square;
    return *this;
  }
  /// As if `rays` more had said `otherwise`.
  double value(double otherwise, double rays) const {
    return (product + rays * otherwise) / (square + rays);
  }
};

/// The reflectances for a known response.
std::vector<float> fit_reflectances(const Observations& observations, const DiskCells& cells,
                                    const IntensityResponse& response,
                                    std::span<const float> fallback, const Executor& executor) {
  const std::size_t disks = cells.of_disk.size();
  std::vector<Fit> of_disk(disks), of_cell(cells.count);
  executor.for_chunks(disks, kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t d = begin; d < end; ++d) {
      for (const Observation& ray : observations.of(d)) {
        const auto gain = static_cast<double>(response.gain(ray.range_m, ray.cos_incidence));
        of_disk[d] += {static_cast<double>(ray.intensity) * gain, gain * gain};
      }
    }
  });
  Fit of_all;
  for (std::size_t d = 0; d < disks; ++d) {
    of_cell[cells.of_disk[d]] += of_disk[d];
    of_all += of_disk[d];
  }
  const double usual = of_all.square > 0 ? of_all.product / of_all.square : 0.0;
  std::vector<float> values(disks);
  for (std::size_t d = 0; d < disks; ++d) {
    const Fit& cell = of_cell[cells.of_disk[d]];
    if (cell.square > 0) {
      values[d] = static_cast<float>(of_disk[d].value(cell.value(usual, kModelRays), kCellRays));
    } else {
      values[d] =
          std::isfinite(fallback[d]) ? std::max(fallback[d], 0.0F) : static_cast<float>(usual);
    }
  }
  return values;
}

/// Normal equations of a table that is linear between its nodes: three diagonals.
struct TableFit {
  std::array<double, kMostNodes> diagonal = {};
  std::array<double, kMostNodes> beside = {};  ///< of node k and the next
  std::array<double, kMostNodes> right = {};

  TableFit& operator+=(const TableFit& other) {
    for (std::size_t k = 0; k < kMostNodes; ++k) {
      diagonal[k] += other.diagonal[k];
      beside[k] += other.beside[k];
      right[k] += other.right[k];
    }
    return *this;
  }
  /// A ray with `intensity` = `factor` * table value at `place`.
  void add(NodePlace place, double intensity, double factor) {
    const auto upper = static_cast<double>(place.share);
    const double low = (1 - upper) * factor, high = upper * factor;
    diagonal[place.below] += low * low;
    diagonal[place.below + 1] += high * high;
    beside[place.below] += low * high;
    right[place.below] += low * intensity;
    right[place.below + 1] += high * intensity;
  }
  /// Node values, scaled so that that of `unit` is 1. Neighbours pull each other a little, so that
  /// a node that no ray is near has its neighbour's value.
  std::vector<float> solve(std::size_t nodes, std::size_t unit) const;
};

std::vector<float> TableFit::solve(std::size_t nodes, std::size_t unit) const {
  double sum = 0;
  for (std::size_t k = 0; k < nodes; ++k) sum += diagonal[k];
  std::vector<float> values(nodes, 1.0F);
  if (!(sum > 0)) return values;
  // A choice: less leaves nodes without rays undetermined, more flattens the table.
  const double pull = 2e-4 * sum;
  std::array<double, kMostNodes> d = diagonal, x = right;
  const auto link = [&](std::size_t k) { return beside[k] - pull; };
  for (std::size_t k = 0; k < nodes; ++k) d[k] += (k == 0 || k + 1 == nodes) ? pull : 2 * pull;
  for (std::size_t k = 1; k < nodes; ++k) {
    const double factor = link(k - 1) / d[k - 1];
    d[k] -= factor * link(k - 1);
    x[k] -= factor * x[k - 1];
  }
  x[nodes - 1] /= d[nodes - 1];
  for (std::size_t k = nodes - 1; k-- > 0;) x[k] = (x[k] - link(k) * x[k + 1]) / d[k];
  if (!(x[unit] > 0)) return values;
  for (std::size_t k = 0; k < nodes; ++k) {
    values[k] = static_cast<float>(std::max(x[k] / x[unit], 0.0));
  }
  return values;
}

/// Sums over the disks in fixed chunks; `add` takes a disk's reflectance, a ray and the table.
template <class Add>
TableFit fit_table(const Observations& observations, std::span<const float> values,
                   const Executor& executor, const Add& add) {
  return executor.sum_chunks(values.size(), kCoarseGrain, TableFit{},
                             [&](std::size_t begin, std::size_t end) {
                               TableFit fit;
                               for (std::size_t d = begin; d < end; ++d) {
                                 for (const Observation& ray : observations.of(d)) {
                                   add(fit, static_cast<double>(values[d]), ray);
                                 }
                               }
                               return fit;
                             });
}

/// The response for known reflectances: its tables one after the other.
void fit_response(IntensityResponse& response, const Observations& observations,
                  std::span<const float> values, const Executor& executor) {
  const auto incidence_gain = [&](const Observation& ray) {
    return static_cast<double>(table_value(kCosines, response.incidence_gains, ray.cos_incidence));
  };
  const auto range_gain = [&](const Observation& ray) {
    return static_cast<double>(table_value(kRanges_m, response.range_gains, ray.range_m));
  };
  response.range_gains =
      fit_table(observations, values, executor,
                [&](TableFit& fit, double reflectance, const Observation& ray) {
                  fit.add(place_of(kRanges_m, ray.range_m), static_cast<double>(ray.intensity),
                          reflectance * incidence_gain(ray));
                })
          .solve(kRanges_m.size(), kUnitRange);
  response.incidence_gains =
      fit_table(observations, values, executor,
                [&](TableFit& fit, double reflectance, const Observation& ray) {
                  fit.add(place_of(kCosines, ray.cos_incidence), static_cast<double>(ray.intensity),
                          reflectance * range_gain(ray));
                })
          .solve(kCosines.size(), kUnitCosine);
}

}  // namespace

float IntensityResponse::gain(float range_m, float cos_incidence) const {
  return table_value(ranges_m, range_gains, range_m) *
         table_value(cos_incidences, incidence_gains, cos_incidence);
}

Reflectances measure_reflectances(std::span<const Disk> disks, const Tracer& tracer,
                                  const PointCloud& cloud, Vec3d model_origin,
                                  std::span<const float> fallback, const Executor& executor) {
  Reflectances result{{fallback.begin(), fallback.end()}, {}};
  if (!cloud.has_beams() || cloud.intensities.empty()) return result;
  const Observations observations =
      RayCollector(disks, tracer, cloud, model_origin, executor).collect();
  if (observations.rays.size() < kLeastRays) return result;
  IntensityResponse& response = result.response;
  response.ranges_m.assign(kRanges_m.begin(), kRanges_m.end());
  response.range_gains.assign(kRanges_m.size(), 1.0F);
  response.cos_incidences.assign(kCosines.begin(), kCosines.end());
  response.incidence_gains.assign(kCosines.size(), 1.0F);
  const DiskCells cells = cells_of(disks, executor);
  const ProgressPass pass(executor, (1 + 3 * kTurns) * disks.size());  // a fit, then three a turn
  result.values = fit_reflectances(observations, cells, response, fallback, executor);
  for (int turn = 0; turn < kTurns; ++turn) {
    fit_response(response, observations, result.values, executor);
    result.values = fit_reflectances(observations, cells, response, fallback, executor);
  }
  return result;
}

}  // namespace adasplats
