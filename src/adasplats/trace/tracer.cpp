// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/tracer.h"

#include <cstddef>
#include <utility>

namespace adasplats {

/// Most rays have few hits; the others are cast again for several times as many.
void Tracer::all_hits(std::span<const Ray> rays, HitsBody body) const {
  constexpr std::size_t kHitsAtFirst = 48, kTimesAsMany = 4;
  const Executor this_thread(1);
  std::vector<Ray> cast(rays.begin(), rays.end());
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < rays.size(); ++i) numbers.push_back(i);
  std::vector<Hit> found;
  std::vector<RayHit> hits;
  for (std::size_t depth = kHitsAtFirst; !cast.empty(); depth *= kTimesAsMany) {
    found.assign(cast.size() * depth, Hit{});
    nearest_hits(cast, static_cast<int>(depth), found, this_thread);
    std::vector<Ray> again;
    std::vector<std::uint32_t> of_again;
    hits.clear();
    for (std::size_t i = 0; i < cast.size(); ++i) {
      const auto own = std::span<const Hit>(found).subspan(i * depth, depth);
      if (own.back().valid()) {
        again.push_back(cast[i]);
        of_again.push_back(numbers[i]);
        continue;
      }
      for (std::size_t k = 0; own[k].valid(); ++k) hits.push_back({numbers[i], own[k]});
    }
    body(hits);
    cast = std::move(again);
    numbers = std::move(of_again);
  }
}

}  // namespace adasplats
