// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <memory>
#include <span>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/consistent/consistent_rays.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"
#include "adasplats/gpu/trace/cuda_scene.h"
#include "adasplats/gpu/trace/wide_traversal.cuh"
#include "adasplats/splats/rays/measured_ray.h"
#include "adasplats/trace/castable.h"

namespace adasplats::gpu {
namespace {

constexpr std::size_t kMaxRays = std::size_t{1} << 22;  // per batch
constexpr std::size_t kMaxDeepRays = kMaxRays / 8;      // the same with kExtentHits hits
constexpr int kPostponeInCheck = 10;                    // as for scans, cuda_scene.cu

/// Adds as unsigned integers, also for signed numbers: the bits are the same.
__device__ void add_to(std::int64_t& sum, std::int64_t value) {
  atomicAdd(reinterpret_cast<unsigned long long*>(&sum), static_cast<unsigned long long>(value));
}

/// Calls body(i, point, ray, hit) on the device for every ray i, with its nearest hit within
/// `reach` or none.
template <class Body>
void cast_nearest(const Disk* disks, std::size_t count, const MeasuredPoints& points,
                  const DeviceBuffer<std::uint32_t>& numbers, RayReach reach, cudaStream_t stream,
                  Body body) {
  const std::size_t wanted = numbers.size();
  if (wanted == 0) return;
  const std::unique_ptr<DeviceScene> scene = make_cuda_scene_of_device_disks(disks, count, stream);
  const std::size_t at_once = std::min(wanted, kMaxRays);
  const DeviceBuffer<Ray> rays(at_once, stream);
  const DeviceBuffer<Hit> hits(at_once, stream);
  RaySource source;
  source.rays = rays.data();
  for (std::size_t done = 0; done < wanted; done += at_once) {
    const std::size_t batch = std::min(at_once, wanted - done);
    const std::uint32_t* first = numbers.data() + done;
    for_each(batch, stream, "make rays",
             [points, first, reach, to = rays.data()] __device__(std::uint64_t k) {
               const std::uint32_t point = first[k];
               to[k] = measured_ray(points.sensors[point], points.positions[point], reach);
             });
    scene->cast(source, batch, 1, hits.data(), stream);
    for_each(batch, stream, "count rays",
             [first, done, from = rays.data(), found = hits.data(),
              body] __device__(std::uint64_t k) { body(done + k, first[k], from[k], found[k]); });
  }
}

/// Adds what `rays` show about the extents of the disks of `scene`.
void add_extents(const DeviceScene& scene, const Disk* disks, const DiskExtent* extents,
                 const DeviceRays& rays, const ExtentOptions& options, ExtentSums* sums,
                 cudaStream_t stream) {
  const MeasuredPoints points = rays.measured();
  const bool nowhere = rays.ends() == RayEnds::nowhere;
  const RayReach reach = {nowhere ? 0 : options.beyond_m};
  const std::size_t at_once = std::min(rays.size(), kMaxDeepRays);
  const DeviceBuffer<Ray> batch_rays(at_once, stream);
  const DeviceBuffer<Hit> hits(at_once * kExtentHits, stream);
  RaySource source;
  source.rays = batch_rays.data();
  const std::span<const std::uint32_t> cast = rays.points_of(options.parts, options.part);
  for (std::size_t done = 0; done < cast.size(); done += at_once) {
    const std::size_t batch = std::min(at_once, cast.size() - done);
    const std::uint32_t* first = cast.data() + done;
    for_each(batch, stream, "make rays",
             [points, first, reach, to = batch_rays.data()] __device__(std::uint64_t k) {
               const std::uint32_t point = first[k];
               to[k] = measured_ray(points.sensors[point], points.positions[point], reach);
             });
    scene.cast(source, batch, kExtentHits, hits.data(), stream);
    for_each(batch, stream, "refine disks",
             [points, first, nowhere, disks, extents, options, sums, from = batch_rays.data(),
              found = hits.data()] __device__(std::uint64_t k) {
               const std::uint32_t point = first[k];
               const float range_m = nowhere
                                         ? std::numeric_limits<float>::infinity()
                                         : length(points.positions[point] - points.sensors[point]);
               const Hit* own = found + k * kExtentHits;
               std::size_t count = 0;
               while (count < kExtentHits && own[count].valid()) ++count;
               add_extents_of_ray(disks, extents, from[k], range_m, {own, count}, options,
                                  [sums](std::uint32_t id, const ExtentSums& part) {
                                    add_to(sums[id].opacity, part.opacity);
                                    add_to(sums[id].opacity_weight, part.opacity_weight);
                                    add_to(sums[id].scale, part.scale);
                                    add_to(sums[id].scale_weight, part.scale_weight);
                                  });
             });
  }
}

/// Counts every disk that one ray crosses, as the tree traversal visits them.
struct EvidenceOfRay {
  const Disk* disks;
  EvidenceView counts;
  EvidenceOptions options;
  Ray ray;
  float range_m;

  /// No hit ends the search.
  __device__ float reach(float t_max) const { return t_max; }
  __device__ void offer(float t, std::uint32_t disk) const {
    const RayVerdict word = verdict_of_ray(disks[disk], ray, t, range_m, options);
    if (word == RayVerdict::nothing) return;
    auto* const rings = word == RayVerdict::confirms ? counts.confirmed : counts.contradicted;
    atomicAdd(rings + disk * EvidenceView::kBins + evidence_ring(disks[disk], ray, t), 1U);
  }
};

/// Counts the disks of `tree` that rays cross.
void count_rays(const DeviceRays& rays, const Disk* disks, const WideTree<LeafDisk>& tree,
                const EvidenceOptions& options, EvidenceView counts, cudaStream_t stream) {
  const bool nowhere = rays.ends() == RayEnds::nowhere;
  const float beyond_m = nowhere ? 0 : options.max_margin_m();
  const std::span<const std::uint32_t> cast = rays.points_of(options.parts, options.part);
  for_each(cast.size(), stream, "count rays",
           [disks, counts, points = rays.measured(), options, nowhere, beyond_m, tree = tree.view(),
            numbers = cast.data()] __device__(std::uint64_t k) {
             const std::uint32_t point = numbers[k];
             const Vec3f sensor = points.sensors[point], end = points.positions[point];
             const Ray ray = measured_ray(sensor, end, {beyond_m});
             if (!castable(ray)) return;
             const float range_m =
                 nowhere ? std::numeric_limits<float>::infinity() : length(end - sensor);
             EvidenceOfRay of_ray = {disks, counts, options, ray, range_m};
             walk<kPostponeInCheck>(tree, ray, box_ray(ray), of_ray);
           });
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
                                           double min_range_m, cudaStream_t stream) {
  DeviceBuffer<std::uint64_t> keys(count, stream);
  for_each(count, stream, "order rays", [points, to = keys.data()] __device__(std::uint64_t i) {
    to[i] = measured_ray_key(points.sensors[i], points.positions[i]);
  });
  const DeviceBuffer<std::uint32_t> order = sort_order(keys, stream);
  DeviceBuffer<std::uint8_t> has_ray(count, stream);
  for_each(
      count, stream, "order rays",
      [points, min_range_m, from = order.data(), to = has_ray.data()] __device__(std::uint64_t i) {
        const std::uint32_t k = from[i];
        to[i] = is_beam(points.kind(k)) &&
                has_measured_ray(points.sensors[k], points.positions[k], min_range_m);
      });
  DeviceBuffer<std::uint32_t> numbers = flagged(has_ray.data(), count, stream);
  for_each(numbers.size(), stream, "order rays",
           [from = order.data(), to = numbers.data()] __device__(std::uint64_t i) {
             to[i] = from[to[i]];
           });
  return numbers;
}

/// The points of the rays of one part, in the order of the rays.
DeviceBuffer<std::uint32_t> points_of_part(const MeasuredPoints& points,
                                           const DeviceBuffer<std::uint32_t>& numbers,
                                           std::uint32_t part, cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> is_in(numbers.size(), stream);
  for_each(numbers.size(), stream, "order rays",
           [points, part, from = numbers.data(), to = is_in.data()] __device__(std::uint64_t i) {
             const std::uint32_t point = from[i];
             to[i] = ray_part(points.sensors[point], points.positions[point]) == part;
           });
  return gather(numbers, flagged(is_in.data(), is_in.size(), stream), stream);
}

}  // namespace

DeviceRays::DeviceRays(const MeasuredPoints& points, std::size_t count, double min_range_m,
                       cudaStream_t stream, RayEnds ends)
    : measured_(points),
      point_count_(count),
      stream_(stream),
      ends_(ends),
      numbers_(points_of_rays(points, count, min_range_m, stream)),
      by_part_(numbers_.size(), stream) {
  for (std::uint32_t part = 0; part < kRayParts; ++part) {
    const DeviceBuffer<std::uint32_t> own = points_of_part(measured_, numbers_, part, stream_);
    cuda_check(cudaMemcpyAsync(by_part_.data() + begins_.at[part], own.data(), own.bytes(),
                               cudaMemcpyDeviceToDevice, stream_),
               "order rays");
    begins_.at[part + 1] = begins_.at[part] + own.size();
  }
}

std::span<const std::uint32_t> DeviceRays::points_of(std::uint32_t parts,
                                                     std::uint32_t part) const {
  if (parts == 1) return {numbers_.data(), numbers_.size()};
  return {by_part_.data() + begins_.first(parts, part), begins_.count(parts, part)};
}

DeviceBuffer<ExtentSums> extents_on_device(const Disk* disks, const DiskExtent* extents,
                                           std::size_t count,
                                           std::span<const DeviceRays* const> rays,
                                           const ExtentOptions& options, cudaStream_t stream) {
  DeviceBuffer<ExtentSums> sums(count, stream);
  sums.fill_bytes(0);
  if (!any_present(disks, count, stream)) return sums;
  const std::unique_ptr<DeviceScene> scene = make_cuda_scene_of_device_disks(disks, count, stream);
  for (const DeviceRays* cast : rays)
    add_extents(*scene, disks, extents, *cast, options, sums.data(), stream);
  return sums;
}

DeviceEvidence evidence_on_device(const Disk* disks, std::size_t count,
                                  std::span<const DeviceRays* const> rays,
                                  const EvidenceOptions& options, cudaStream_t stream) {
  const std::size_t bins = count * EvidenceView::kBins;
  DeviceEvidence evidence{DeviceBuffer<std::uint32_t>(bins, stream),
                          DeviceBuffer<std::uint32_t>(bins, stream)};
  evidence.confirmed.fill_bytes(0);
  evidence.contradicted.fill_bytes(0);
  const WideTree<LeafDisk> tree = build_tree(disks, count, TreeOptions{}, stream);
  for (const DeviceRays* cast : rays)
    count_rays(*cast, disks, tree, options, evidence.view(), stream);
  return evidence;
}

DeviceBuffer<ShiftSums> DeviceRays::shifts(const Disk* disks, std::size_t count,
                                           const SettleOptions& options) const {
  DeviceBuffer<ShiftSums> sums(count, stream_);
  sums.fill_bytes(0);
  cast_nearest(disks, count, measured_, numbers_, settling_reach(options), stream_,
               [disks, options, points = measured_, to = sums.data()] __device__(
                   std::uint64_t, std::uint32_t point, const Ray& ray, Hit hit) {
                 if (!hit.valid()) return;
                 const float range_m = length(points.positions[point] - points.sensors[point]);
                 const std::uint32_t disk = hit.primitive;
                 const ShiftSums part = shift_of_ray(disks[disk], ray, hit.t, range_m, options);
                 add_to(to[disk].weight, part.weight);
                 add_to(to[disk].shift, part.shift);
                 atomicAdd(&to[disk].rays, part.rays);
               });
  return sums;
}

DeviceBuffer<std::uint8_t> DeviceRays::missed(const Disk* disks, std::size_t count,
                                              RayReach reach) const {
  DeviceBuffer<std::uint8_t> missed(point_count_, stream_);
  missed.fill_bytes(0);
  if (!any_present(disks, count, stream_)) return missed;
  cast_nearest(
      disks, count, measured_, numbers_, reach, stream_,
      [to = missed.data()] __device__(std::uint64_t, std::uint32_t point, const Ray&, Hit hit) {
        if (!hit.valid()) to[point] = 1;
      });
  return missed;
}

void DeviceRays::observe(const Disk* disks, std::size_t count, const ObserveRay& observe) const {
  cast_nearest(disks, count, measured_, numbers_, RayReach{ObserveRay::kBeyond_m}, stream_,
               [observe, points = measured_] __device__(std::uint64_t i, std::uint32_t point,
                                                        const Ray& ray, Hit hit) {
                 const float range_m = length(points.positions[point] - points.sensors[point]);
                 observe(i, point, ray, range_m, hit);
               });
}

}  // namespace adasplats::gpu
