// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/base_neighborhoods.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "adasplats/core/progress_meter.h"
#include "adasplats/surface/local_shape.h"
#include "adasplats/surface/shape_lanes.h"

namespace adasplats {
namespace {

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

constexpr std::size_t kMostInGroup = PointIndex::kLeafPoints;

/// The shapes of a group of PointIndex::for_each_group().
std::span<const LocalShape> shapes_of(std::span<const Vec3f> points, std::uint32_t first_rank,
                                      std::span<const NeighborList> lists) {
  thread_local ShapeLanes lanes;  // reused memory
  thread_local std::array<LocalShape, kMostInGroup> shapes;
  lanes.find(points, first_rank, lists, shapes);
  return std::span(shapes).first(lists.size());
}

/// Computes the neighbourhoods group by group.
class Pass {
 public:
  Pass(std::span<const Vec3f> points, const BaseNeighborhoodOptions& options,
       BaseNeighborhoods& result)
      : points_(points),
        options_(options),
        result_(result),
        error_sums_(points.size()),
        error_counts_(points.size()) {}

  /// Sets the results of consecutive points and counts their votes.
  void set(std::uint32_t first_rank, std::span<const NeighborList> lists) {
    const std::span<const LocalShape> shapes = shapes_of(points_, first_rank, lists);
    for (std::uint32_t k = 0; k < lists.size(); ++k) set(first_rank + k, lists[k], shapes[k]);
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
  void set(std::uint32_t rank, const NeighborList& neighbors, const LocalShape& shape) {
    const PlaneDistances distances = plane_distances(points_, rank, neighbors, shape.normal);
    result_.normals[rank] = shape.normal;
    result_.kinds[rank] = kind_of(shape);
    error_sums_[rank] = static_cast<float>(distances.sum);
    error_counts_[rank] = neighbors.size;
    vote(rank, neighbors, shape.normal, distances.sigma(), 1);
  }

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
    index.for_each_group(
        executor, [&](std::uint32_t) { return NeighborLimit{neighbors}; },
        [&](std::uint32_t first_rank, std::span<const NeighborList> lists) {
          for (std::size_t i = 0; i < lists.size(); ++i) {
            float farthest = 0.0F;
            for (std::uint32_t k = 0; k < lists[i].size; ++k)
              farthest = std::max(farthest, lists[i].squared_distances[k]);
            kth_distances[first_rank + i] = std::sqrt(farthest);
          }
          pass.set(first_rank, lists);
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
        const NeighborList within = {distances.data(), ranks.data(),
                                     static_cast<std::uint32_t>(ranks.size())};
        pass.set(rank, std::span(&within, 1));
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
    index.for_each_group(
        executor, [&](std::uint32_t) { return limit; },
        [&](std::uint32_t first_rank, std::span<const NeighborList> lists) {
          pass.set(first_rank, lists);
        });
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
  index.for_each_group(
      executor, limit, [&](std::uint32_t first_rank, std::span<const NeighborList> lists) {
        if (std::ranges::all_of(lists, &NeighborList::empty)) return;
        const std::span<const LocalShape> shapes = shapes_of(points, first_rank, lists);
        for (std::size_t i = 0; i < lists.size(); ++i)
          if (!lists[i].empty()) normals[first_rank + i] = shapes[i].normal;
      });
}

}  // namespace adasplats
