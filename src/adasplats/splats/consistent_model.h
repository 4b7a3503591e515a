// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "adasplats/cloud/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/measured_rays.h"
#include "adasplats/splats/ray_check.h"
#include "adasplats/splats/surface_cover.h"
#include "adasplats/surface/adaptive_planes.h"

namespace adasplats {

/// Splats that agree with the rays that were measured: beyond the paper (docs/fidelity.md).
struct ConsistentOptions {
  double cell_m = 0.05;  ///< side of the cells that points are fused in
  /// Cells with no plane around them beyond this scale (of `planes.scales`) are split...
  std::uint8_t split_scale = 1;
  double small_cell_m = 0.02;  ///< ...into these; 0: not split
  AdaptivePlaneOptions planes;
  double seed_spacing = 1.2;      ///< radius of a seed, times the distance to the 7th cell
  double least_radius_m = 0.015;  ///< of a seed
  /// Largest radius of a seed, times the median spacing of cells: per metre of distance to the
  /// sensor where that is known, as beams spread.
  double largest_spacing = 1.2;
  /// Where there are no rays to tell what is free, disks stay smaller and end where points end.
  double unchecked_largest_spacing = 0.6;
  int unchecked_sectors = 16;  ///< CoverOptions::sectors there
  double isolated = 3;         ///< a cell that wants so many times the largest has no splat
  double least_range_m = 2;    ///< nearer points have no ray: the vehicle itself
  int balance_rounds = 4;      ///< of shrinking and removing seeds; 0: no ray check
  JudgeOptions judge;          ///< of seeds
  EvidenceOptions evidence;    ///< its stride is the largest: of few rays more are taken
  std::size_t evidence_rays = 2'000'000;  ///< enough of them for a round
  CoverOptions cover;
  int strict_rounds = 5;            ///< of limiting chosen disks
  double most_contradicted = 0.05;  ///< of the rays that confirm a disk that was grown
  int settle_rounds = 2;
  SettleOptions settle;
  bool fill = true;        ///< where rays fall between splats, seeds are put back...
  float missed_m = 0.15F;  ///< ...if there is nothing up to so far behind the rays' ends
};

struct ConsistentDisks {
  std::vector<Disk> disks;
  std::vector<std::uint32_t> cells;  ///< of each disk, in `fused`
  FusedPoints fused;
  bool checked = false;  ///< against measured rays
};

/// Fuses, fits planes, checks, covers, settles. `cloud` in canonical order; without sensor
/// positions the steps with rays are left out. `begin_step` hears the name of every step.
ConsistentDisks consistent_disks(const PointCloud& cloud, const ConsistentOptions& options,
                                 const Executor& executor,
                                 const std::function<void(std::string_view)>& begin_step);

}  // namespace adasplats
