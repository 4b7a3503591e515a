// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/core/host_device.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/consistent/consistent_model.h"
#include "adasplats/splats/consistent/origin_check.h"
#include "adasplats/splats/consistent/seed_disk.h"
#include "adasplats/splats/consistent/seed_growth.h"
#include "adasplats/splats/rays/disk_evidence.h"
#include "adasplats/splats/rays/disk_shift.h"
#include "adasplats/splats/rays/measured_ray.h"
#include "adasplats/surface/fused_points.h"
#include "adasplats/surface/plane_fit.h"

namespace adasplats {

// What the steps of the consistent method do with one element, in the steps' order. Each reads and
// writes only what belongs to element `i`, so a loop on any device runs it (for_each of a place).

/// spacing_unit_m() of every cell.
struct FindSpacingUnit {
  MeasuredPoints points;
  CellsView cells;
  bool with_beam;
  float* units_m;

  ADASPLATS_HD void operator()(std::size_t cell) const {
    units_m[cell] = spacing_unit_m(points, cells.points_of(cell), with_beam);
  }
};

/// Flags cells around which no plane is larger than the smallest scales: leaves, poles, wires are
/// smaller than a cell.
struct FlagNotFlat {
  const LocalPlane* planes;
  std::uint8_t split_scale;
  std::uint8_t* flags;

  ADASPLATS_HD void operator()(std::size_t cell) const {
    flags[cell] = planes[cell].scale <= split_scale ? 1 : 0;
  }
};

/// Turns a plane's normal to the sensors and makes a seed of it.
struct MakeSeed {
  MeasuredPoints points;
  CellsView cells;
  TypicalSpacing typical;
  ConsistentOptions options;
  LocalPlane* planes;
  Disk* seeds;

  ADASPLATS_HD void operator()(std::size_t cell) const {
    LocalPlane& plane = planes[cell];
    const auto members = cells.points_of(cell);
    plane.normal = seed_normal(plane.normal, points, members);
    const double largest_m = largest_seed_m(points, members, typical, options);
    const auto spacing_m = static_cast<double>(plane.spacing_m);
    seeds[cell] = {plane.center, seed_radius(spacing_m, largest_m, options), plane.normal};
  }
};

/// Every n-th seed.
struct ThinSeeds {
  const Disk* seeds;
  std::size_t every;
  Disk* some;

  ADASPLATS_HD void operator()(std::size_t i) const { some[i] = seeds[i * every]; }
};

/// Moves where a beam started; a beam of no length stays.
struct MoveOrigin {
  const Vec3f* points;
  const Vec3f* given;
  Vec3f move_m;
  double min_range_m;
  Vec3f* origins;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const Vec3f moved = given[i] + move_m;
    origins[i] = has_measured_ray(moved, points[i], min_range_m) ? moved : given[i];
  }
};

/// Counts seeds, from one of them on, by what the rays that cross them say.
struct CountCrossed {
  std::size_t first;
  EvidenceView evidence;

  ADASPLATS_HD void operator()(std::size_t i, CrossedSeeds& sums) const {
    const DiskEvidence own = evidence.of(first + i);
    std::uint64_t yes = 0, no = 0;
    for (std::size_t bin = 0; bin < EvidenceView::kBins; ++bin) {
      yes += own.confirmed[bin];
      no += own.contradicted[bin];
    }
    sums.crossed += yes + no > 0 ? 1 : 0;
    sums.contradicted += no > yes ? 1 : 0;
  }
};

/// Shrinks a seed to what the rays leave of it.
struct JudgeSeed {
  Disk* seeds;
  EvidenceView evidence;
  JudgeOptions options;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const DiskEvidence own = evidence.of(i);
    if (seeds[i].radius > 0 && own.seen())
      seeds[i].radius = judged_radius(own, seeds[i].radius, options);
  }
};

/// Flags cells none of whose points has a beam.
struct FlagWithoutBeam {
  MeasuredPoints points;
  CellsView cells;
  std::uint8_t* flags;

  ADASPLATS_HD void operator()(std::size_t cell) const {
    flags[cell] = has_beam(points, cells.points_of(cell)) ? 0 : 1;
  }
};

/// Limits a chosen disk that hangs over an edge.
struct LimitOverhang {
  CoverLimits cover;
  const Disk* chosen;
  EvidenceView evidence;
  double max_contradicted;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const DiskEvidence own = evidence.of(i);
    const float radius_m = chosen[i].radius;
    if (!(radius_m > 0) || !own.seen()) return;
    cover.limit(i, overhang_limit(own, radius_m, cover.seeds[i].radius, max_contradicted));
  }
};

/// What is chosen next instead of limited disks was not checked in its large size.
struct LimitUnchosen {
  CoverLimits cover;
  const Disk* chosen;

  ADASPLATS_HD void operator()(std::size_t i) const {
    if (!(chosen[i].radius > 0)) cover.limit(i, cover.seeds[i].radius);
  }
};

/// Moves a disk to where the rays that meet it say the surface is.
struct SettleDisk {
  Disk* disks;
  const ShiftSums* sums;
  SettleOptions options;

  ADASPLATS_HD void operator()(std::size_t i) const {
    disks[i] = settled(disks[i], sums[i], options);
  }
};

/// Puts a seed back at a cell whose rays find nothing where they ended: chosen disks cover the
/// middles of all seeds, not all that is between them.
struct PutBackSeed {
  Disk* chosen;
  const Disk* seeds;
  CellsView cells;
  const std::uint8_t* missed;  ///< one flag a point

  ADASPLATS_HD void operator()(std::size_t cell) const {
    if (chosen[cell].radius > 0) return;
    for (const std::uint32_t i : cells.points_of(cell)) {
      if (missed[i] == 0) continue;
      chosen[cell] = seeds[cell];
      return;
    }
  }
};

}  // namespace adasplats
