// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/ray_drop_model.h"

namespace adasplats {

/// Minimum range difference of neighbouring beams of a ring at an edge.
inline constexpr float kRangeEdge_m = 0.5F;

/// Beams lost at range edges, for CPU and GPU: a footprint split by an edge gives two weak echoes.
/// shares[k]: share of the edges at which k + 1 consecutive beams are lost.
struct EdgeRunRules {
  bool on = false;
  double shares[kMaxEdgeRun] = {};
};

/// Input of the edge detection: the hits of firings [first, end) of a scan.
struct ScanHits {
  const Hit* hits = nullptr;  ///< of firing `first`
  std::size_t a_firing = 1;   ///< hits per firing, of which the first is used
  std::uint32_t first = 0, end = 0;

  ADASPLATS_HD const Hit& of(std::uint32_t firing) const {
    return hits[(firing - first) * a_firing];
  }
};

/// Whether firings i and i + 1 are neighbours of one ring with an edge between them.
ADASPLATS_HD inline bool is_edge(const Firing* firings, const ScanHits& hits, std::uint32_t i) {
  const Hit& a = hits.of(i);
  const Hit& b = hits.of(i + 1);
  if (!(std::fabs(b.t - a.t) > kRangeEdge_m) || !a.valid() || !b.valid()) return false;
  return firings[i].ring == firings[i + 1].ring && firings[i].column + 1 == firings[i + 1].column;
}

/// Whether ranges jump anywhere between firings first and last, regardless of rings: a quick test
/// without a branch per firing, since most beams are far from all edges.
ADASPLATS_HD inline bool ranges_jump(const ScanHits& hits, std::uint32_t first,
                                     std::uint32_t last) {
  int jumps = 0;
  for (std::uint32_t i = first; i < last; ++i)
    jumps |= std::fabs(hits.of(i + 1).t - hits.of(i).t) > kRangeEdge_m ? 1 : 0;
  return jumps != 0;
}

/// Whether a firing is lost at an edge next to it. Edges in the same column of four rings lose the
/// same beams.
ADASPLATS_HD inline bool lost_at_edge(const EdgeRunRules& rules, const Firing* firings,
                                      const ScanHits& hits, std::uint64_t seed,
                                      std::uint64_t scan_index, std::uint32_t firing) {
  constexpr std::uint32_t kRingsAlike = 4;
  const std::uint32_t first =
      firing >= hits.first + kMaxEdgeRun ? firing - kMaxEdgeRun : hits.first;
  const std::uint32_t last = firing + kMaxEdgeRun < hits.end ? firing + kMaxEdgeRun : hits.end - 1;
  if (!ranges_jump(hits, first, last)) return false;
  for (std::uint32_t i = first; i < last; ++i) {
    if (!is_edge(firings, hits, i)) continue;
    Random random(seed ^ 0x6564676573ULL, scan_index,
                  std::uint64_t{firings[i].ring / kRingsAlike} << 32 | firings[i].column);
    double drawn = random.uniform();
    for (std::uint32_t k = 0; k < kMaxEdgeRun; ++k) {
      drawn -= rules.shares[k];
      if (drawn >= 0) continue;
      // k + 1 beams are lost, `before` of them on this side of the edge.
      const auto before = static_cast<std::uint32_t>(random.uniform() * (k + 2));
      if (firing <= i ? i - firing < before : firing - i <= k + 1 - before) return true;
      break;
    }
  }
  return false;
}

}  // namespace adasplats
