// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/gpu/base/cuda_check.h"

namespace adasplats::gpu {

inline constexpr unsigned kBlockThreads = 256;

template <class F>
__global__ void __launch_bounds__(kBlockThreads) for_each_kernel(std::uint64_t count, F body) {
  const std::uint64_t i = std::uint64_t{blockIdx.x} * kBlockThreads + threadIdx.x;
  if (i < count) body(i);
}

/// Private to gpu/: calls body(i) for i in [0, count) on the stream, one thread per i.
template <class F>
void for_each(std::uint64_t count, cudaStream_t stream, const char* doing, F body) {
  if (count == 0) return;
  const auto blocks = static_cast<unsigned>((count + kBlockThreads - 1) / kBlockThreads);
  for_each_kernel<<<blocks, kBlockThreads, 0, stream>>>(count, body);
  cuda_check(cudaGetLastError(), doing);
}

}  // namespace adasplats::gpu
