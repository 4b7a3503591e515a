// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>

#include "adasplats/core/maths/ray.h"

namespace adasplats {

/// Throws std::logic_error where there are not `depth` hits for every ray. Private to trace/.
inline void require_slots(std::span<const Ray> rays, int depth, std::span<Hit> hits) {
  if (depth < 1 || hits.size() != rays.size() * static_cast<std::size_t>(depth))
    throw std::logic_error("a tracer needs `depth` >= 1 hits for every ray");
}

/// Clears the hits of a query. Private to trace/. Throws as require_slots().
inline void clear_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits) {
  require_slots(rays, depth, hits);
  std::ranges::fill(hits, Hit{});
}

}  // namespace adasplats
