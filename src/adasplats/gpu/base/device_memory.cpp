// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/base/device_memory.h"

#include <cstdint>
#include <limits>
#include <map>
#include <mutex>

namespace adasplats::gpu {
namespace {

/// Guards of a pool nest: the last one releases the memory.
std::mutex guards_mutex;                 // NOLINT: shared by the guards alone
std::map<cudaMemPool_t, int> guards_of;  // NOLINT

void set_threshold(cudaMemPool_t pool, std::uint64_t bytes) {
  cuda_check(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &bytes),
             "set up the GPU's memory pool");
}

}  // namespace

MemoryPoolGuard::MemoryPoolGuard(int device) {
  cuda_check(cudaDeviceGetDefaultMemPool(&pool_, device), "find the GPU's memory pool");
  const std::scoped_lock lock(guards_mutex);
  if (guards_of[pool_]++ == 0) set_threshold(pool_, std::numeric_limits<std::uint64_t>::max());
}

MemoryPoolGuard::~MemoryPoolGuard() {
  const std::scoped_lock lock(guards_mutex);
  if (--guards_of[pool_] > 0) return;
  std::uint64_t none = 0;
  static_cast<void>(cudaMemPoolSetAttribute(pool_, cudaMemPoolAttrReleaseThreshold, &none));
  static_cast<void>(cudaMemPoolTrimTo(pool_, 0));
}

}  // namespace adasplats::gpu
#endif
