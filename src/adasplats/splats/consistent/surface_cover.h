// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/consistent/seed_growth.h"

namespace adasplats {

/// Few large disks where the surface is flat, the small seeds where it is not: every seed is
/// covered by a disk that was chosen.
class SurfaceCover {
 public:
  /// `seeds` are disks small enough to be right, one a point of `index` in its order (no radius:
  /// not there). Grows every one over its neighbours. `unchecked`: flags of seeds that no rays
  /// check, which have options.unchecked_sectors; empty: none.
  SurfaceCover(std::span<const Disk> seeds, const PointIndex& index, const CoverOptions& options,
               const Executor& executor, std::span<const std::uint8_t> unchecked = {});

  /// Greedy: those that cover most first, ties by index. The chosen disks, the others with no
  /// radius.
  std::vector<Disk> choose(const Executor& executor) const;

  CoverLimits limits() { return {seeds_.data(), radii_m_.data()}; }
  /// How large every disk may be: what it grew to, or its limit.
  const std::vector<float>& radii_m() const { return radii_m_; }

 private:
  /// The seeds that disk `i` may cover, whatever its radius.
  std::span<const std::uint32_t> candidates(std::size_t i) const;
  bool covers(std::size_t i, std::uint32_t other) const;

  std::vector<Disk> seeds_;
  std::vector<float> radii_m_;
  double overlap_;
  /// Lists of consecutive seeds stand in one vector; where each begins in it, and how long it is.
  std::vector<std::vector<std::uint32_t>> lists_;
  std::vector<std::uint32_t> begins_;
  std::vector<std::uint32_t> lengths_;
};

}  // namespace adasplats
