// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/consistent/consistent_model.h"
#include "adasplats/splats/consistent/origin_check.h"
#include "adasplats/splats/consistent/seed_disk.h"
#include "adasplats/splats/consistent/seed_growth.h"
#include "adasplats/splats/rays/disk_evidence.h"
#include "adasplats/splats/rays/disk_shift.h"
#include "adasplats/splats/rays/measured_ray.h"
#include "adasplats/surface/adaptive_planes.h"
#include "adasplats/surface/fused_points.h"

namespace adasplats {

// The work of the consistent method for one element, in the order of the steps. Each functor reads
// and writes only data of element `i`, so any loop may run it (for_each of a backend).

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

/// Sums of flags.
struct FlagCount {
  std::uint64_t flags = 0;

  ADASPLATS_HD FlagCount& operator+=(const FlagCount& other) {
    flags += other.flags;
    return *this;
  }
};

/// Counts planes that are farther from their cells than the maximum shift.
struct CountLimitedPlanes {
  const LocalPlane* planes;

  ADASPLATS_HD void operator()(std::size_t cell, FlagCount& count) const {
    count.flags += planes[cell].limited ? 1 : 0;
  }
};

/// Flags cells without a plane larger than the smallest scales: leaves, poles and wires are smaller
/// than a cell.
struct FlagNotFlat {
  const LocalPlane* planes;
  std::uint8_t split_scale;
  std::uint8_t* flags;

  ADASPLATS_HD void operator()(std::size_t cell) const {
    flags[cell] = planes[cell].scale <= split_scale ? 1 : 0;
  }
};

/// Orients the normal of a plane towards the sensors and makes a seed.
struct MakeSeed {
  MeasuredPoints points;
  CellsView cells;
  TypicalSpacing typical;
  ConsistentOptions options;
  LocalPlane* planes;
  Disk* seeds;
  std::uint8_t* limited;  ///< flags of centres that were moved by the maximum

  ADASPLATS_HD void operator()(std::size_t cell) const {
    LocalPlane& plane = planes[cell];
    const auto members = cells.points_of(cell);
    plane.normal = seed_normal(plane.normal, points, members);
    const double largest_m = largest_seed_m(points, members, typical, options);
    const auto spacing_m = static_cast<double>(plane.spacing_m);
    seeds[cell] = {plane.center, seed_radius(spacing_m, largest_m, options), plane.normal};
    limited[cell] = plane.limited ? 1 : 0;
  }
};

/// Selects every n-th seed.
struct ThinSeeds {
  const Disk* seeds;
  std::size_t every;
  Disk* some;

  ADASPLATS_HD void operator()(std::size_t i) const { some[i] = seeds[i * every]; }
};

/// Shifts the origin of a beam, unless that would leave the beam without a length.
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

/// Counts seeds that rays cross, and those that more rays contradict than confirm.
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

/// Shrinks a seed to the radius that the rays support.
struct ShrinkSeed {
  Disk* seeds;
  EvidenceView evidence;
  SeedCheckOptions options;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const DiskEvidence own = evidence.of(i);
    if (seeds[i].radius > 0 && own.seen())
      seeds[i].radius = supported_radius(own, seeds[i].radius, options);
  }
};

/// Flags cells without any point that has a beam.
struct FlagWithoutBeam {
  MeasuredPoints points;
  CellsView cells;
  std::uint8_t* flags;

  ADASPLATS_HD void operator()(std::size_t cell) const {
    flags[cell] = has_beam(points, cells.points_of(cell)) ? 0 : 1;
  }
};

/// Limits a chosen disk that overhangs an edge.
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

/// Limits disks that were not chosen: their grown size was not checked against rays.
struct LimitUnchosen {
  CoverLimits cover;
  const Disk* chosen;

  ADASPLATS_HD void operator()(std::size_t i) const {
    if (!(chosen[i].radius > 0)) cover.limit(i, cover.seeds[i].radius);
  }
};

/// Moves a disk to the surface that the rays which meet it show.
struct SettleDisk {
  Disk* disks;
  const ShiftSums* sums;
  SettleOptions options;
  std::uint8_t* limited;  ///< as of MakeSeed

  ADASPLATS_HD void operator()(std::size_t i) const {
    disks[i] = settled(disks[i], sums[i], options);
    if (sums[i].rays >= options.min_rays) limited[i] = is_limited(sums[i], options) ? 1 : 0;
  }
};

/// Counts splats whose centres were moved by the maximum.
struct CountLimitedSplats {
  const Disk* chosen;
  const std::uint8_t* limited;

  ADASPLATS_HD void operator()(std::size_t i, FlagCount& count) const {
    count.flags += chosen[i].radius > 0 && limited[i] != 0 ? 1 : 0;
  }
};

/// Restores the seed of a cell if a ray of its points meets no disk: chosen disks cover the centres
/// of all seeds, but not every gap between them.
struct PutBackSeed {
  Disk* chosen;
  const Disk* seeds;
  CellsView cells;
  const std::uint8_t* missed;  ///< one flag per point

  ADASPLATS_HD void operator()(std::size_t cell) const {
    if (chosen[cell].radius > 0) return;
    for (const std::uint32_t i : cells.points_of(cell)) {
      if (missed[i] == 0) continue;
      chosen[cell] = seeds[cell];
      return;
    }
  }
};

/// Sets the extent of disks before they are refined.
struct BeginExtent {
  DiskExtent* extents;
  ExtentOptions options;

  ADASPLATS_HD void operator()(std::size_t i) const { extents[i] = {options.first_opacity, 1}; }
};

/// Soft disks with the given extents.
struct SoftenDisk {
  const Disk* disks;
  const DiskExtent* extents;
  Disk* soft;

  ADASPLATS_HD void operator()(std::size_t i) const {
    soft[i] = disks[i];
    soft[i].radius *= extents[i].scale * kRimReach;
  }
};

struct RefineExtent {
  DiskExtent* extents;
  const ExtentSums* sums;
  ExtentOptions options;

  ADASPLATS_HD void operator()(std::size_t i) const {
    extents[i] = refined(extents[i], sums[i], options);
  }
};

/// Removes disks that hardly any ray stops at.
struct RemoveFaint {
  Disk* disks;
  const DiskExtent* extents;
  ExtentOptions options;

  ADASPLATS_HD void operator()(std::size_t i) const {
    if (extents[i].opacity < options.min_opacity) disks[i].radius = 0;
  }
};

/// The most frequent of the classes, which are sorted; the smallest of equally frequent ones.
ADASPLATS_HD inline std::uint16_t majority_class(std::span<const std::uint16_t> ascending) {
  std::uint16_t best = 0;
  std::size_t most = 0, run = 0;
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    run = i > 0 && ascending[i] == ascending[i - 1] ? run + 1 : 1;
    if (run > most) {
      most = run;
      best = ascending[i];
    }
  }
  return best;
}

/// Mean intensity of a cell's points, added in their order; NaN if none has an intensity.
ADASPLATS_HD inline float mean_intensity(const float* intensities,
                                         std::span<const std::uint32_t> members) {
  double sum = 0;
  std::size_t known = 0;
  for (const std::uint32_t i : members) {
    if (intensities[i] != intensities[i]) continue;  // NaN: unknown
    sum += static_cast<double>(intensities[i]);
    ++known;
  }
  return static_cast<float>(sum / static_cast<double>(known));
}

}  // namespace adasplats
