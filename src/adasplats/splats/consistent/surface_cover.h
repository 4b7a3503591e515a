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

/// Covers all seeds by few large disks where the surface is flat and by the small seeds elsewhere.
class SurfaceCover {
 public:
  /// Grows every seed over its neighbours. `seeds`: one near each point of `index`, in its order
  /// (radius 0: none). `unchecked`: flags of seeds without rays, which use
  /// options.unchecked_sectors; empty: no such seeds.
  SurfaceCover(std::span<const Disk> seeds, const PointIndex& index, const CoverOptions& options,
               const Executor& executor, std::span<const std::uint8_t> unchecked = {});

  /// Selects disks greedily: those that cover the most seeds first, ties by index. Returns all
  /// disks; those not chosen have radius 0.
  std::vector<Disk> choose(const Executor& executor) const;

  CoverLimits limits() { return {seeds_.data(), radii_m_.data()}; }
  /// Maximum radius of every disk: the grown radius, or its limit.
  const std::vector<float>& radii_m() const { return radii_m_; }

 private:
  /// The seeds that disk `i` can cover at any radius.
  std::span<const std::uint32_t> candidates(std::size_t i) const;
  bool covers(std::size_t i, std::uint32_t other) const;

  std::vector<Disk> seeds_;
  std::vector<float> radii_m_;
  double overlap_;
  /// Candidates: one vector per chunk of seeds, with the begin and length of each seed's list.
  std::vector<std::vector<std::uint32_t>> lists_;
  std::vector<std::uint32_t> begins_;
  std::vector<std::uint32_t> lengths_;
};

}  // namespace adasplats
