// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>

#include "adasplats/core/maths/ray.h"

namespace adasplats {

/// Clears the hits of a query. Private to trace/. Throws std::logic_error where there are not
/// `depth` hits for every ray.
inline void clear_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits) {
  if (depth < 1 || hits.size() != rays.size() * static_cast<std::size_t>(depth))
    throw std::logic_error("a tracer needs `depth` >= 1 hits for every ray");
  std::ranges::fill(hits, Hit{});
}

}  // namespace adasplats
