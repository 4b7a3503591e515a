// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/maths/ray.h"

/// Private to the OptiX programs: functions that the driver provides. The driver's compiler
/// resolves them by name, so calls in PTX need no library.
namespace adasplats::optix {

__device__ __forceinline__ std::uint32_t launch_index() {
  std::uint32_t index;
  asm volatile("call (%0), _optix_get_launch_index_x, ();" : "=r"(index));
  return index;
}

/// Index of the primitive that an intersection program tests.
__device__ __forceinline__ std::uint32_t primitive_index() {
  std::uint32_t index;
  asm volatile("call (%0), _optix_read_primitive_idx, ();" : "=r"(index));
  return index;
}

/// The current ray, with t_max shortened by the hits so far. With a single geometry structure, the
/// ray of the scene is also that of the structure.
__device__ __forceinline__ Ray current_ray() {
  Ray ray;
  asm volatile("call (%0), _optix_get_world_ray_origin_x, ();" : "=f"(ray.origin.x));
  asm volatile("call (%0), _optix_get_world_ray_origin_y, ();" : "=f"(ray.origin.y));
  asm volatile("call (%0), _optix_get_world_ray_origin_z, ();" : "=f"(ray.origin.z));
  asm volatile("call (%0), _optix_get_world_ray_direction_x, ();" : "=f"(ray.direction.x));
  asm volatile("call (%0), _optix_get_world_ray_direction_y, ();" : "=f"(ray.direction.y));
  asm volatile("call (%0), _optix_get_world_ray_direction_z, ();" : "=f"(ray.direction.z));
  asm volatile("call (%0), _optix_get_ray_tmin, ();" : "=f"(ray.t_min));
  asm volatile("call (%0), _optix_get_ray_tmax, ();" : "=f"(ray.t_max));
  return ray;
}

template <int kIndex>
__device__ __forceinline__ std::uint32_t payload() {
  std::uint32_t value;
  asm volatile("call (%0), _optix_get_payload, (%1);" : "=r"(value) : "r"(kIndex));
  return value;
}

template <int kIndex>
__device__ __forceinline__ void set_payload(std::uint32_t value) {
  asm volatile("call _optix_set_payload, (%0, %1);" ::"r"(kIndex), "r"(value));
}

/// Ends the search beyond `t`.
__device__ __forceinline__ void end_ray_at(float t) {
  [[maybe_unused]] std::uint32_t accepted;
  asm volatile("call (%0), _optix_report_intersection_0, (%1, %2);"
               : "=r"(accepted)
               : "f"(t), "r"(0));
}

/// The two payload registers of a ray.
struct Payload {
  std::uint32_t first, second;
};

/// Traces a ray with the intersection programs of `record_offset` only. The call has 32 payload
/// registers, of which the first two are used; record_stride is the number of ray kinds.
__device__ __forceinline__ Payload trace(std::uint64_t scene, const Ray& ray,
                                         std::uint32_t record_offset, std::uint32_t record_stride,
                                         Payload payload) {
  constexpr std::uint32_t kNoAnyHit = 1, kNoClosestHit = 8, kAllMasks = 255, kUsed = 2;
  Payload result;
  [[maybe_unused]] std::uint32_t unused[30];
  asm volatile(
      "call ("
      "%0, %1, %2, %3, %4, %5, %6, %7, %8, %9, %10, %11, %12, %13, %14, %15, %16, %17, "
      "%18, %19, %20, %21, %22, %23, %24, %25, %26, %27, %28, %29, %30, %31"
      "), _optix_trace_typed_32, ("
      "%32, %33, %34, %35, %36, %37, %38, %39, %40, %41, %42, %43, %44, %45, %46, %47, "
      "%48, %49, %50, %51, %52, %53, %54, %55, %56, %57, %58, %59, %60, %61, %62, %63, "
      "%64, %65, %66, %67, %68, %69, %70, %71, %72, %73, %74, %75, %76, %77, %78, %79, "
      "%80"
      ");"
      : "=r"(result.first), "=r"(result.second), "=r"(unused[0]), "=r"(unused[1]), "=r"(unused[2]),
        "=r"(unused[3]), "=r"(unused[4]), "=r"(unused[5]), "=r"(unused[6]), "=r"(unused[7]),
        "=r"(unused[8]), "=r"(unused[9]), "=r"(unused[10]), "=r"(unused[11]), "=r"(unused[12]),
        "=r"(unused[13]), "=r"(unused[14]), "=r"(unused[15]), "=r"(unused[16]), "=r"(unused[17]),
        "=r"(unused[18]), "=r"(unused[19]), "=r"(unused[20]), "=r"(unused[21]), "=r"(unused[22]),
        "=r"(unused[23]), "=r"(unused[24]), "=r"(unused[25]), "=r"(unused[26]), "=r"(unused[27]),
        "=r"(unused[28]), "=r"(unused[29])
      : "r"(0), "l"(scene), "f"(ray.origin.x), "f"(ray.origin.y), "f"(ray.origin.z),
        "f"(ray.direction.x), "f"(ray.direction.y), "f"(ray.direction.z), "f"(ray.t_min),
        "f"(ray.t_max), "f"(0.0F), "r"(kAllMasks), "r"(kNoAnyHit | kNoClosestHit),
        "r"(record_offset), "r"(record_stride), "r"(0), "r"(kUsed), "r"(payload.first),
        "r"(payload.second), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0),
        "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0),
        "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0), "r"(0)
      : "memory");
  return result;
}

}  // namespace adasplats::optix
