// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/gpu/base/launch.cuh"

namespace adasplats::gpu {

/// Private to gpu/: reductions over the 32 threads of a warp. All lanes call them, and all get the
/// same bits.

inline constexpr std::uint32_t kWarpLanes = 32;
inline constexpr std::uint32_t kAllLanes = 0xffffffffU;

__device__ inline std::uint32_t lane_of_thread() { return threadIdx.x % kWarpLanes; }

/// Number of set lanes before this one.
__device__ inline std::uint32_t lanes_before(std::uint32_t mask) {
  return __popc(mask & ((1U << lane_of_thread()) - 1U));
}

/// Adds pairs 16, 8, 4, 2 and 1 lanes apart: always the same order.
__device__ inline double warp_sum(double value) {
  for (int apart = kWarpLanes / 2; apart > 0; apart /= 2)
    value += __shfl_xor_sync(kAllLanes, value, apart);
  return value;
}

__device__ inline std::uint32_t warp_sum(std::uint32_t value) {
#if __CUDA_ARCH__ >= 800
  return __reduce_add_sync(kAllLanes, value);
#else
  for (int apart = kWarpLanes / 2; apart > 0; apart /= 2)
    value += __shfl_xor_sync(kAllLanes, value, apart);
  return value;
#endif
}

__device__ inline std::uint32_t warp_min(std::uint32_t value) {
#if __CUDA_ARCH__ >= 800
  return __reduce_min_sync(kAllLanes, value);
#else
  for (int apart = kWarpLanes / 2; apart > 0; apart /= 2)
    value = ::min(value, __shfl_xor_sync(kAllLanes, value, apart));
  return value;
#endif
}

__device__ inline std::uint32_t warp_max(std::uint32_t value) { return ~warp_min(~value); }

/// For non-negative floats, whose bits have the same order.
__device__ inline float warp_largest(float value) {
  return __uint_as_float(warp_max(__float_as_uint(value)));
}
__device__ inline float warp_smallest(float value) {
  return __uint_as_float(warp_min(__float_as_uint(value)));
}

__device__ inline std::uint64_t warp_min(std::uint64_t value) {
  const std::uint32_t high = warp_min(static_cast<std::uint32_t>(value >> 32));
  const bool is_low = value >> 32 == high;
  const std::uint32_t low = warp_min(is_low ? static_cast<std::uint32_t>(value) : ~0U);
  return std::uint64_t{high} << 32 | low;
}

__device__ inline std::uint64_t warp_max(std::uint64_t value) { return ~warp_min(~value); }

template <class F>
__global__ void __launch_bounds__(kBlockThreads) for_each_warp_kernel(std::uint64_t count, F body) {
  constexpr std::uint32_t kWarps = kBlockThreads / kWarpLanes;
  const std::uint64_t i = std::uint64_t{blockIdx.x} * kWarps + threadIdx.x / kWarpLanes;
  if (i < count) body(static_cast<std::uint32_t>(i));
}

/// Private to gpu/: calls body(i) for i in [0, count) with all 32 lanes of a warp for each.
template <class F>
void for_each_warp(std::uint64_t count, cudaStream_t stream, const char* doing, F body) {
  if (count == 0) return;
  constexpr std::uint32_t kWarps = kBlockThreads / kWarpLanes;
  const auto blocks = static_cast<unsigned>((count + kWarps - 1) / kWarps);
  for_each_warp_kernel<<<blocks, kBlockThreads, 0, stream>>>(count, body);
  cuda_check(cudaGetLastError(), doing);
}

}  // namespace adasplats::gpu
