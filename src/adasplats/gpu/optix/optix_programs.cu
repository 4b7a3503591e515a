// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Compiled separately for the driver (cmake/Optix.cmake), which finds the programs by name. OptiX
// traverses its tree and calls an intersection program for every box that a ray enters. The
// programs store the hits themselves and report only the remaining search distance to OptiX. So we
// define the order of equal distances, and a primitive may be tested twice.

#include "adasplats/gpu/optix/optix_device.cuh"
#include "adasplats/gpu/optix/optix_params.h"
#include "adasplats/trace/castable.h"

using adasplats::Hit;
using adasplats::Ray;
using adasplats::gpu::DiskRecord;
using adasplats::gpu::OptixParams;
using adasplats::gpu::OptixQuery;
using adasplats::gpu::TriangleRecord;
namespace optix = adasplats::optix;

extern "C" {
__constant__ OptixParams params;
}

namespace {

constexpr float kLargest = 3.402823466e+38F;

/// Reads a record in loads of 16 bytes.
__device__ __forceinline__ adasplats::Disk disk_of(const DiskRecord* record) {
  const float4 a = __ldg(reinterpret_cast<const float4*>(record));
  const float4 b = __ldg(reinterpret_cast<const float4*>(record) + 1);
  return {{a.x, a.y, a.z}, a.w, {b.x, b.y, b.z}};
}

__device__ __forceinline__ adasplats::Triangle triangle_of(const TriangleRecord* record) {
  const float4 a = __ldg(reinterpret_cast<const float4*>(record));
  const float4 b = __ldg(reinterpret_cast<const float4*>(record) + 1);
  const float4 c = __ldg(reinterpret_cast<const float4*>(record) + 2);
  return {{a.x, a.y, a.z}, {a.w, b.x, b.y}, {b.z, b.w, c.x}};
}

__device__ __forceinline__ Hit disk_hit() {
  const std::uint32_t index = optix::primitive_index();
  return {intersect_disk(optix::current_ray(), disk_of(params.disks + index)), index};
}

__device__ __forceinline__ Hit triangle_hit() {
  const std::uint32_t index = optix::primitive_index();
  const auto triangle = triangle_of(params.triangles + (index - params.disk_count));
  return {intersect_triangle(optix::current_ray(), triangle), index};
}

__device__ __forceinline__ void keep_nearest(Hit hit) {
  const Hit nearest = {__uint_as_float(optix::payload<0>()), optix::payload<1>()};
  if (!(hit.t < HUGE_VALF) || !(hit < nearest)) return;
  optix::set_payload<0>(__float_as_uint(hit.t));
  optix::set_payload<1>(hit.primitive);
  if (hit.t < nearest.t) optix::end_ray_at(hit.t);
}

__device__ __forceinline__ Hit* unpack(std::uint32_t low, std::uint32_t high) {
  return reinterpret_cast<Hit*>(std::uint64_t{high} << 32U | low);
}

/// Inserts a hit into the ascending list of `depth` hits; the last one is dropped.
__device__ __forceinline__ void keep_several(Hit hit) {
  if (!(hit.t < HUGE_VALF)) return;
  Hit* const list = unpack(optix::payload<0>(), optix::payload<1>());
  std::uint32_t place = params.depth - 1;
  const float old_end = list[place].t;
  if (!(hit < list[place])) return;
  std::uint32_t before = place;  // number of hits before it
  while (before > 0 && hit < list[before - 1]) --before;
  if (before > 0 && list[before - 1] == hit) return;
  for (; place > before; --place) list[place] = list[place - 1];
  list[before] = hit;
  const float new_end = list[params.depth - 1].t;
  if (new_end < old_end) optix::end_ray_at(new_end);
}

/// Position of the hits of ray i of the source.
__device__ __forceinline__ Hit* hits_of(std::uint64_t i) {
  return params.hits + (place_of_ray(params.source, i) - params.first_place) * params.depth;
}

__device__ __forceinline__ optix::Payload trace(Ray ray, OptixQuery query, optix::Payload payload) {
  if (!castable(ray)) return payload;
  ray.t_min = first_t(ray);
  ray.t_max = fminf(ray.t_max, kLargest);  // OptiX wants finite numbers
  if (!(ray.t_min <= ray.t_max)) return payload;
  return optix::trace(params.scene, ray, static_cast<std::uint32_t>(query),
                      adasplats::gpu::kOptixQueries, payload);
}

}  // namespace

extern "C" __global__ void __intersection__nearest_disk() { keep_nearest(disk_hit()); }
extern "C" __global__ void __intersection__nearest_triangle() { keep_nearest(triangle_hit()); }
extern "C" __global__ void __intersection__several_disk() { keep_several(disk_hit()); }
extern "C" __global__ void __intersection__several_triangle() { keep_several(triangle_hit()); }

extern "C" __global__ void __raygen__nearest() {
  const std::uint64_t i = params.first_ray + optix::launch_index();
  const Hit none;
  const optix::Payload found = trace(ray_of(params.source, i), OptixQuery::nearest,
                                     {__float_as_uint(none.t), none.primitive});
  *hits_of(i) = {__uint_as_float(found.first), found.second};
}

extern "C" __global__ void __raygen__several() {
  const std::uint64_t i = params.first_ray + optix::launch_index();
  Hit* const list = hits_of(i);
  for (std::uint32_t k = 0; k < params.depth; ++k) list[k] = Hit{};
  const auto address = reinterpret_cast<std::uint64_t>(list);
  trace(ray_of(params.source, i), OptixQuery::several,
        {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32U)});
}
