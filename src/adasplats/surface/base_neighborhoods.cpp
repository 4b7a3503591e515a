// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/base_neighborhoods.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

LocalShape shape_of(std::span<const Vec3f> points, std::uint32_t rank,
                    const NeighborList& neighbors) {
  float extent_m = 0;
  for (std::uint32_t k = 0; k < neighbors.size; ++k)
    extent_m = std::max(extent_m, extent(points[neighbors.ranks[k]] - points[rank]));
  const ExactMoments exact(neighbors.size, extent_m);
  Moments moments;
  for (std::uint32_t k = 0; k < neighbors.size; ++k)
    moments.add(points[neighbors.ranks[k]] - points[rank], exact);
  return local_shape(moments);
}

PlaneDistances plane_distances(std::span<const Vec3f> points, std::uint32_t rank,
                               const NeighborList& neighbors, Vec3f normal) {
  const auto distance_m = [&](std::uint32_t k) {
    return distance_to_plane(points[neighbors.ranks[k]] - points[rank], normal);
  };
  float largest_m = 0;
  for (std::uint32_t k = 0; k < neighbors.size; ++k) largest_m = std::max(largest_m, distance_m(k));
  const ExactDistances exact(neighbors.size, largest_m);
  PlaneDistances distances;
  for (std::uint32_t k = 0; k < neighbors.size; ++k) distances.add(distance_m(k), exact);
  return distances;
}

void add_relaxed(std::uint32_t& counter, std::uint32_t value) {
  // Sums of integers do not depend on the order in which threads add.
  std::atomic_ref<std::uint32_t>(counter).fetch_add(value, std::memory_order_relaxed);
}

/// Computes the neighbourhoods one by one.
class Pass {
 public:
  Pass(std::span<const Vec3f> points, const BaseNeighborhoodOptions& options,
       BaseNeighborhoods& result)
      : points_(points),
        options_(options),
        result_(result),
        error_sums_(points.size()),
        error_counts_(points.size()) {}

  /// Sets the results of a point and counts its votes.
  void set(std::uint32_t rank, const NeighborList& neighbors) {
    const LocalShape shape = shape_of(points_, rank, neighbors);
    const PlaneDistances distances = plane_distances(points_, rank, neighbors, shape.normal);
    result_.normals[rank] = shape.normal;
    result_.kinds[rank] = kind_of(shape);
    error_sums_[rank] = static_cast<float>(distances.sum);
    error_counts_[rank] = neighbors.size;
    vote(rank, neighbors, shape.normal, distances.sigma(), 1);
  }

  /// Reverts the votes of set() for this point and these neighbours.
  void unset(std::uint32_t rank, const NeighborList& neighbors) {
    if (options_.denoise_sigmas <= 0) return;
    const Vec3f normal = result_.normals[rank];
    const PlaneDistances distances = plane_distances(points_, rank, neighbors, normal);
    vote(rank, neighbors, normal, distances.sigma(), static_cast<std::uint32_t>(-1));
  }

  /// E: mean over all pairs of point and neighbour.
  double mean_error(const Executor& executor) const {
    struct Sum {
      double error = 0, count = 0;
      Sum& operator+=(const Sum& other) {
        error += other.error;
        count += other.count;
        return *this;
      }
    };
    const Sum total = executor.sum_chunks(points_.size(), kFineGrain, Sum{},
                                          [&](std::size_t begin, std::size_t end) {
                                            Sum sum;
                                            for (std::size_t i = begin; i < end; ++i)
                                              sum += {error_sums_[i], double(error_counts_[i])};
                                            return sum;
                                          });
    return total.count > 0 ? total.error / total.count : 0.0;
  }

 private:
  void vote(std::uint32_t rank, const NeighborList& neighbors, Vec3f normal, double sigma,
            std::uint32_t weight) {
    if (options_.denoise_sigmas <= 0) return;
    const double limit = options_.denoise_sigmas * sigma;
    for (std::uint32_t k = 0; k < neighbors.size; ++k) {
      const std::uint32_t neighbor = neighbors.ranks[k];
      add_relaxed(result_.memberships[neighbor], weight);
      const Vec3f offset = points_[neighbor] - points_[rank];
      if (static_cast<double>(distance_to_plane(offset, normal)) > limit)
        add_relaxed(result_.votes[neighbor], weight);
    }
  }

  std::span<const Vec3f> points_;
  const BaseNeighborhoodOptions& options_;
  BaseNeighborhoods& result_;
  std::vector<float> error_sums_;
  std::vector<std::uint32_t> error_counts_;
};

float squared_radius_of(double radius_m) {
  const float radius = static_cast<float>(radius_m);
  return radius * radius;
}

double mean_of(const std::vector<float>& values, const Executor& executor) {
  const double sum =
      executor.sum_chunks(values.size(), kFineGrain, 0.0, [&](std::size_t begin, std::size_t end) {
        double part = 0;
        for (std::size_t i = begin; i < end; ++i) part += static_cast<double>(values[i]);
        return part;
      });
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// R depends on all K-th distances, but for most points the K nearest are within it. So the first
/// search assumes that they are, and the few neighbourhoods that R cuts are searched again.
void speculate_then_correct(const PointIndex& index, std::uint32_t neighbors, Pass& pass,
                            BaseNeighborhoods& result, const Executor& executor) {
  std::vector<float> kth_distances(index.size());
  {
    const ProgressPass speculating(executor, index.size());
    index.for_each_neighborhood(
        executor, [&](std::uint32_t) { return NeighborLimit{neighbors}; },
        [&](std::uint32_t rank, const NeighborList& found) {
          float farthest = 0.0F;
          for (std::uint32_t k = 0; k < found.size; ++k)
            farthest = std::max(farthest, found.squared_distances[k]);
          kth_distances[rank] = std::sqrt(farthest);
          pass.set(rank, found);
        });
  }
  result.radius_m = mean_of(kth_distances, executor);
  const float squared_radius = squared_radius_of(result.radius_m);
  const ProgressPass correcting(executor, index.size());
  index.for_each_neighborhood(
      executor,
      [&](std::uint32_t rank) {
        const bool cut = kth_distances[rank] * kth_distances[rank] > squared_radius;
        return cut ? NeighborLimit{neighbors} : NeighborLimit{0, -1.0F};
      },
      [&](std::uint32_t rank, const NeighborList& found) {
        if (found.empty()) return;
        pass.unset(rank, found);
        std::vector<float> distances;
        std::vector<std::uint32_t> ranks;
        for (std::uint32_t k = 0; k < found.size; ++k) {
          if (found.squared_distances[k] > squared_radius) continue;
          distances.push_back(found.squared_distances[k]);
          ranks.push_back(found.ranks[k]);
        }
        pass.set(rank, {distances.data(), ranks.data(), static_cast<std::uint32_t>(ranks.size())});
      });
}

}  // namespace

BaseNeighborhoods base_neighborhoods(std::span<const Vec3f> points, const PointIndex& index,
                                     const BaseNeighborhoodOptions& options,
                                     const Executor& executor) {
  BaseNeighborhoods result;
  result.normals.resize(points.size());
  result.kinds.resize(points.size());
  if (options.denoise_sigmas > 0) {
    result.memberships.resize(points.size());
    result.votes.resize(points.size());
  }
  Pass pass(points, options, result);
  if (options.radius_m) {
    result.radius_m = *options.radius_m;
    const NeighborLimit limit{options.neighbors, squared_radius_of(result.radius_m)};
    const ProgressPass only(executor, points.size());
    index.for_each_neighborhood(
        executor, [&](std::uint32_t) { return limit; },
        [&](std::uint32_t rank, const NeighborList& found) { pass.set(rank, found); });
  } else {
    speculate_then_correct(index, options.neighbors, pass, result, executor);
  }
  result.error_m = pass.mean_error(executor);
  return result;
}

void refine_normals(std::span<const Vec3f> points, const PointIndex& index,
                    FunctionRef<NeighborLimit(std::uint32_t)> limit, std::span<Vec3f> normals,
                    const Executor& executor) {
  const ProgressPass only(executor, points.size());
  index.for_each_neighborhood(executor, limit, [&](std::uint32_t rank, const NeighborList& found) {
    if (!found.empty()) normals[rank] = shape_of(points, rank, found).normal;
  });
}

}  // namespace adasplats
