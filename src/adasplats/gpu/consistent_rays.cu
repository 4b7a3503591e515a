// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "adasplats/gpu/consistent_rays.h"
#include "adasplats/gpu/cuda_scene.h"
#include "adasplats/gpu/launch.cuh"
#include "adasplats/gpu/sort_keys.h"
#include "adasplats/splats/measured_ray.h"
#include "adasplats/splats/present_disks.h"

namespace adasplats::gpu {
namespace {

constexpr std::size_t kHitBytes = std::size_t{1} << 28;  // of the hits at once
constexpr std::size_t kMostRays = std::size_t{1} << 22;  // at once

/// Adds to a number that is not negative, or to one that wraps: the same bits.
__device__ void add_to(std::int64_t& sum, std::int64_t value) {
  atomicAdd(reinterpret_cast<unsigned long long*>(&sum), static_cast<unsigned long long>(value));
}

/// Calls body(point, ray, hits) on the device for the rays of `casting`; `hits` are casting.depth
/// ones, behind the last of a ray's own stands one that is not valid.
template <class Body>
void cast(const Disk* disks, std::size_t count, const MeasuredPoints& points,
          const DeviceBuffer<std::uint32_t>& numbers, const RayCasting& casting,
          cudaStream_t stream, Body body) {
  if (numbers.size() <= casting.first) return;
  const std::unique_ptr<DeviceScene> scene = make_cuda_scene_of_device_disks(disks, count, stream);
  const std::size_t depth = static_cast<std::size_t>(casting.depth);
  const std::size_t wanted = (numbers.size() - casting.first + casting.stride - 1) / casting.stride;
  const std::size_t at_once =
      std::min({wanted, kMostRays, std::max<std::size_t>(1, kHitBytes / (depth * sizeof(Hit)))});
  const DeviceBuffer<Ray> rays(at_once, stream);
  const DeviceBuffer<Hit> hits(at_once * depth, stream);
  RaySource source;
  source.rays = rays.data();
  for (std::size_t done = 0; done < wanted; done += at_once) {
    const std::size_t batch = std::min(at_once, wanted - done);
    const std::uint32_t* first = numbers.data() + casting.first + done * casting.stride;
    for_each(batch, stream, "make rays",
             [points, first, casting, to = rays.data()] __device__(std::uint64_t k) {
               const std::uint32_t point = first[k * casting.stride];
               to[k] =
                   measured_ray(points.sensors[point], points.positions[point], casting.beyond_m);
             });
    scene->cast(source, batch, casting.depth, hits.data(), stream);
    for_each(batch, stream, "count rays",
             [first, stride = casting.stride, depth, from = rays.data(), found = hits.data(),
              body] __device__(std::uint64_t k) {
               body(first[k * stride], from[k], found + k * depth);
             });
  }
}

/// Whether any disk has a radius. Waits for the stream.
bool any_present(const Disk* disks, std::size_t count, cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> found(1, stream);
  found.fill_bytes(0);
  for_each(count, stream, "look for disks", [disks, to = found.data()] __device__(std::uint64_t i) {
    if (disks[i].radius > 0) *to = 1;
  });
  return read_value(found.data(), stream) != 0;
}

DeviceBuffer<std::uint32_t> points_of_rays(const MeasuredPoints& points, std::size_t count,
                                           double least_range_m, cudaStream_t stream) {
  DeviceBuffer<std::uint64_t> keys(count, stream);
  for_each(count, stream, "order rays", [points, to = keys.data()] __device__(std::uint64_t i) {
    to[i] = measured_ray_key(points.sensors[i], points.positions[i]);
  });
  const DeviceBuffer<std::uint32_t> order = sort_order(keys, stream);
  DeviceBuffer<std::uint8_t> has_ray(count, stream);
  for_each(count, stream, "order rays",
           [points, least_range_m, from = order.data(),
            to = has_ray.data()] __device__(std::uint64_t i) {
             const std::uint32_t k = from[i];
             to[i] = has_measured_ray(points.sensors[k], points.positions[k], least_range_m);
           });
  DeviceBuffer<std::uint32_t> numbers = flagged(has_ray.data(), count, stream);
  for_each(numbers.size(), stream, "order rays",
           [from = order.data(), to = numbers.data()] __device__(std::uint64_t i) {
             to[i] = from[to[i]];
           });
  return numbers;
}

}  // namespace

DeviceRays::DeviceRays(const MeasuredPoints& points, std::size_t count, double least_range_m,
                       cudaStream_t stream)
    : points_(points),
      point_count_(count),
      stream_(stream),
      numbers_(points_of_rays(points, count, least_range_m, stream)) {}

DeviceEvidence DeviceRays::evidence(const Disk* disks, std::size_t count,
                                    const EvidenceOptions& options) const {
  const std::size_t bins = count * EvidenceView::kBins;
  DeviceEvidence evidence{DeviceBuffer<std::uint32_t>(bins, stream_),
                          DeviceBuffer<std::uint32_t>(bins, stream_)};
  evidence.confirmed.fill_bytes(0);
  evidence.contradicted.fill_bytes(0);
  const RayCasting casting = {options.phase, options.stride, options.margin_m, options.depth};
  cast(disks, count, points_, numbers_, casting, stream_,
       [disks, counts = evidence.view(), margin_m = options.margin_m,
        depth = options.depth] __device__(std::uint32_t, const Ray& ray, const Hit* hits) {
         const float free_until = ray.t_max - 2 * margin_m;
         for (int h = 0; h < depth && hits[h].valid(); ++h) {
           const std::size_t disk = hits[h].primitive;
           const std::uint32_t ring = evidence_ring(disks[disk], ray, hits[h].t);
           auto* const rings = hits[h].t < free_until ? counts.contradicted : counts.confirmed;
           atomicAdd(rings + disk * EvidenceView::kBins + ring, 1U);
         }
       });
  return evidence;
}

DeviceBuffer<ShiftSums> DeviceRays::shifts(const Disk* disks, std::size_t count,
                                           const SettleOptions& options) const {
  DeviceBuffer<ShiftSums> sums(count, stream_);
  sums.fill_bytes(0);
  RayCasting casting;
  casting.beyond_m = static_cast<float>(options.reach_m);
  cast(disks, count, points_, numbers_, casting, stream_,
       [disks, options, points = points_, to = sums.data()] __device__(
           std::uint32_t point, const Ray& ray, const Hit* hits) {
         if (!hits[0].valid()) return;
         const float range_m = length(points.positions[point] - points.sensors[point]);
         const std::uint32_t disk = hits[0].primitive;
         const ShiftSums part = shift_of_ray(disks[disk], ray, hits[0].t, range_m, options);
         add_to(to[disk].weight, part.weight);
         add_to(to[disk].shift, part.shift);
         atomicAdd(&to[disk].rays, part.rays);
       });
  return sums;
}

DeviceBuffer<std::uint8_t> DeviceRays::missed(const Disk* disks, std::size_t count,
                                              float beyond_m) const {
  DeviceBuffer<std::uint8_t> missed(point_count_, stream_);
  missed.fill_bytes(0);
  if (!any_present(disks, count, stream_)) return missed;
  RayCasting casting;
  casting.beyond_m = beyond_m;
  cast(disks, count, points_, numbers_, casting, stream_,
       [to = missed.data()] __device__(std::uint32_t point, const Ray&, const Hit* hits) {
         if (!hits[0].valid()) to[point] = 1;
       });
  return missed;
}

}  // namespace adasplats::gpu
