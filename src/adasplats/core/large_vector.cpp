// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/large_vector.h"

#include <sys/mman.h>

#include <memory>

namespace adasplats {

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  // Of x86 and most ARM; elsewhere the system refuses, which changes nothing. Arrays of less than
  // eight would lose more to the ends that fill no page.
  constexpr std::size_t kPage = std::size_t{2} << 20U;
  if (bytes < 8 * kPage) return;
  void* first = memory;
  std::size_t left = bytes;
  if (std::align(kPage, kPage, first, left) == nullptr) return;
  static_cast<void>(::madvise(first, left / kPage * kPage, MADV_HUGEPAGE));
#endif
}

}  // namespace adasplats
