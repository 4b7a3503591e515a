// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// Adds to an integer that elements of a loop share and returns its previous value. The sum does
/// not depend on the order, the previous value does. Overflow wraps.
ADASPLATS_HD inline std::uint32_t fetch_add(std::uint32_t& number, std::uint32_t addend) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(&number, addend);
#else
  return std::atomic_ref<std::uint32_t>(number).fetch_add(addend, std::memory_order_relaxed);
#endif
}

}  // namespace adasplats
