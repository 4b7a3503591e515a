// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/base/memory_account.h"

#include <algorithm>
#include <array>

#include "adasplats/gpu/base/cuda_check.h"
#include "adasplats/gpu/base/device.h"

namespace adasplats {
namespace gpu {

MemoryAccount& MemoryAccount::of(int device) {
  constexpr std::size_t kMostDevices = 64;
  static std::array<MemoryAccount, kMostDevices> accounts;
  return accounts.at(static_cast<std::size_t>(device));
}

MemoryAccount& MemoryAccount::current() {
  int device = 0;
  cuda_check(cudaGetDevice(&device), "ask for the current GPU");
  return of(device);
}

void MemoryAccount::take(std::size_t bytes, std::string_view doing) {
  const std::size_t held = held_ += bytes;
  const std::size_t limit = limit_;
  if (limit > 0 && held > limit) {
    held_ -= bytes;
    cuda_check(cudaErrorMemoryAllocation, doing);
  }
  std::size_t peak = peak_;
  while (held > peak && !peak_.compare_exchange_weak(peak, held)) continue;
}

}  // namespace gpu

void limit_gpu_memory(int device, std::size_t bytes) {
  gpu::MemoryAccount::of(device).set_limit(bytes);
}

std::size_t gpu_memory_limit(int device) { return gpu::MemoryAccount::of(device).limit(); }

std::size_t usable_gpu_memory(int device) {
  const gpu::MemoryAccount& account = gpu::MemoryAccount::of(device);
  const std::size_t free = free_memory_bytes(device), limit = account.limit();
  if (limit == 0) return free;
  return std::min(free, limit - std::min(limit, account.held()));
}

std::size_t peak_gpu_memory(int device) { return gpu::MemoryAccount::of(device).peak(); }

}  // namespace adasplats
#endif
