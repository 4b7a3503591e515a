// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "adasplats/gpu/neighbors/neighborhoods_lists.cuh"
#include "adasplats/gpu/paper/paper_shapes.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats::gpu {
namespace {

/// Sum of the moments of all lanes.
__device__ Moments sum_of_lanes(Moments m) {
  m.count = warp_sum(m.count);
  for (int axis = 0; axis < 3; ++axis) m.sum[axis] = warp_sum(m.sum[axis]);
  m.squares = {warp_sum(m.squares.xx), warp_sum(m.squares.xy), warp_sum(m.squares.xz),
               warp_sum(m.squares.yy), warp_sum(m.squares.yz), warp_sum(m.squares.zz)};
  return m;
}

/// Moments of every list about its point. A separate kernel with one thread per list then does the
/// PCA, which is long and would be the same in all lanes of a warp.
DeviceBuffer<Moments> moments_of(const Vec3f* points, const DeviceLists& lists,
                                 cudaStream_t stream) {
  DeviceBuffer<Moments> moments(lists.size(), stream);
  for_each_warp(lists.size(), stream, "fit planes",
                [points, view = lists.view(), to = moments.data()] __device__(std::uint32_t i) {
                  const std::uint32_t* ranks = view.of(i);
                  const std::uint32_t size = view.sizes[i];
                  const Vec3f own = points[i];
                  float extent_m = 0;
                  for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes)
                    extent_m = std::max(extent_m, extent(points[ranks[k]] - own));
                  const ExactMoments exact(size, warp_largest(extent_m));
                  Moments part;
                  for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes)
                    part.add(points[ranks[k]] - own, exact);
                  const Moments whole = sum_of_lanes(part);
                  if (lane_of_thread() == 0) to[i] = whole;
                });
  return moments;
}

void fit_shapes(const Vec3f* points, const DeviceLists& lists, DeviceBase& base,
                cudaStream_t stream) {
  const DeviceBuffer<Moments> moments = moments_of(points, lists, stream);
  for_each(lists.size(), stream, "fit planes",
           [from = moments.data(), normals = base.normals.data(),
            kinds = base.kinds.data()] __device__(std::uint64_t i) {
             const LocalShape shape = local_shape(from[i]);
             normals[i] = shape.normal;
             kinds[i] = kind_of(shape);
           });
}

/// Output arrays: sums of distances of neighbourhoods to their planes.
struct PlaneSums {
  float* errors;               ///< of each point: sum over its neighbours
  std::uint32_t* memberships;  ///< nullptr: no votes
  std::uint32_t* votes;
  double sigmas;
};

/// Sums the distances of each list to its plane, and votes.
void measure_planes(const Vec3f* points, const DeviceLists& lists, const Vec3f* normals,
                    PlaneSums sums, cudaStream_t stream) {
  for_each_warp(lists.size(), stream, "measure distances to planes",
                [points, normals, sums, view = lists.view()] __device__(std::uint32_t i) {
                  const std::uint32_t* ranks = view.of(i);
                  const std::uint32_t size = view.sizes[i];
                  const Vec3f own = points[i], normal = normals[i];
                  const auto distance_m = [&](std::uint32_t k) {
                    return distance_to_plane(points[ranks[k]] - own, normal);
                  };
                  float largest_m = 0;
                  for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes)
                    largest_m = std::max(largest_m, distance_m(k));
                  const ExactDistances exact(size, warp_largest(largest_m));
                  PlaneDistances part;
                  for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes)
                    part.add(distance_m(k), exact);
                  const PlaneDistances whole{warp_sum(part.sum), warp_sum(part.sum_of_squares),
                                             warp_sum(part.count)};
                  if (lane_of_thread() == 0) sums.errors[i] = static_cast<float>(whole.sum);
                  if (sums.votes == nullptr) return;
                  const double limit = sums.sigmas * whole.sigma();
                  for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes) {
                    const std::uint32_t other = ranks[k];
                    atomicAdd(sums.memberships + other, 1U);
                    if (static_cast<double>(distance_to_plane(points[other] - own, normal)) > limit)
                      atomicAdd(sums.votes + other, 1U);
                  }
                });
}

double mean_error(const DeviceBuffer<float>& sums, const DeviceLists& lists, cudaStream_t stream) {
  const double sum = sum_in_chunks(sums.data(), sums.size(), stream);
  const auto count = static_cast<double>(sum_of(lists.sizes.data(), lists.size(), stream));
  return count > 0 ? sum / count : 0.0;
}

float squared(double radius_m) {
  const auto radius = static_cast<float>(radius_m);
  return radius * radius;
}

/// The K nearest neighbours of every point, and the distance of the last one.
DeviceLists nearest_lists(const DevicePointIndex& index, std::uint32_t neighbors,
                          float squared_radius, float* distances, cudaStream_t stream) {
  const NeighborLimit limit{neighbors, squared_radius};
  return find_lists(
      index, neighbors, stream, "find neighbours",
      [limit] __device__(std::uint32_t) { return limit; },
      [distances] __device__(std::uint32_t rank, const std::uint64_t* keys, std::uint32_t size) {
        std::uint32_t farthest = 0;
        for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes)
          farthest = ::max(farthest, static_cast<std::uint32_t>(keys[k] >> 32));
        farthest = warp_max(farthest);
        if (lane_of_thread() == 0) distances[rank] = std::sqrt(__uint_as_float(farthest));
      });
}

/// Shortens the lists whose K-th neighbour is not within R.
void cut_lists(const Vec3f* points, const float* distances, float squared_radius,
               const DeviceLists& lists, cudaStream_t stream) {
  for_each_warp(lists.size(), stream, "find neighbours",
                [=, view = lists.view()] __device__(std::uint32_t i) {
                  if (!(distances[i] * distances[i] > squared_radius)) return;
                  const Vec3f own = points[i];
                  keep_in_list(view, i, [&](std::uint32_t other) {
                    return !(squared_distance(points[other], own) > squared_radius);
                  });
                });
}

}  // namespace

DeviceBase base_neighborhoods(const Vec3f* points, const DevicePointIndex& index,
                              const BaseNeighborhoodOptions& options, cudaStream_t stream) {
  const std::size_t size = index.size();
  DeviceBase base;
  DeviceBuffer<float> distances(size, stream);
  const DeviceLists lists = nearest_lists(index, options.neighbors,
                                          options.radius_m ? squared(*options.radius_m) : FLT_MAX,
                                          distances.data(), stream);
  if (options.radius_m) {
    base.radius_m = *options.radius_m;
  } else {
    // R depends on all K-th distances.
    const double sum = sum_in_chunks(distances.data(), size, stream);
    base.radius_m = size == 0 ? 0.0 : sum / static_cast<double>(size);
    cut_lists(points, distances.data(), squared(base.radius_m), lists, stream);
  }
  base.normals = DeviceBuffer<Vec3f>(size, stream);
  base.kinds = DeviceBuffer<ShapeKind>(size, stream);
  fit_shapes(points, lists, base, stream);
  if (options.denoise_sigmas > 0) {
    base.memberships = DeviceBuffer<std::uint32_t>(size, stream);
    base.votes = DeviceBuffer<std::uint32_t>(size, stream);
    base.memberships.fill_bytes(0);
    base.votes.fill_bytes(0);
  }
  DeviceBuffer<float>& errors = distances;  // reuses their memory
  measure_planes(
      points, lists, base.normals.data(),
      {errors.data(), base.memberships.data(), base.votes.data(), options.denoise_sigmas}, stream);
  base.error_m = mean_error(errors, lists, stream);
  return base;
}

void refine_normals(const Vec3f* points, const DeviceLists& lists, const std::uint8_t* wanted,
                    DeviceBuffer<Vec3f>& normals, cudaStream_t stream) {
  const DeviceBuffer<Moments> moments = moments_of(points, lists, stream);
  for_each(lists.size(), stream, "fit planes",
           [wanted, from = moments.data(), view = lists.view(),
            normals = normals.data()] __device__(std::uint64_t i) {
             if (wanted[i] != 0 && view.sizes[i] > 0) normals[i] = local_shape(from[i]).normal;
           });
}

}  // namespace adasplats::gpu
