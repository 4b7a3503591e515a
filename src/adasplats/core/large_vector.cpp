// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/large_vector.h"

#include <sys/mman.h>

#include <cstdint>

namespace adasplats {

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  // Of x86 and most ARM; elsewhere the system refuses, which changes nothing. Arrays of less than
  // eight would lose more to the ends that fill no page.
  constexpr std::uintptr_t kPage = std::uintptr_t{2} << 20U;
  if (bytes < 8 * kPage) return;
  const std::uintptr_t first =
      (reinterpret_cast<std::uintptr_t>(memory) + kPage - 1) & ~(kPage - 1);
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) & ~(kPage - 1);
  if (first < end)
    static_cast<void>(::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE));
#endif
}

}  // namespace adasplats
