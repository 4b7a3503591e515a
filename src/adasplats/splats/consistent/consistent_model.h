// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "adasplats/core/host_device.h"
#include "adasplats/core/setting.h"
#include "adasplats/splats/consistent/origin_check.h"
#include "adasplats/splats/consistent/seed_growth.h"
#include "adasplats/splats/rays/disk_evidence.h"
#include "adasplats/splats/rays/disk_shift.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/surface/plane_fit.h"

namespace adasplats {

/// Splats that agree with measured rays (docs/fidelity.md, also where each number comes from).
struct ConsistentOptions {
  double cell_m = 0.05;  ///< side of the cells that points are fused in
  /// Cells with no plane around them beyond this scale (of `planes.scales`) are split...
  std::uint8_t split_scale = 1;
  double small_cell_m = 0.02;  ///< ...into these; 0: not split
  AdaptivePlaneOptions planes;
  double seed_spacing = 1.2;    ///< radius of a seed, times the distance to the 7th cell
  double min_radius_m = 0.015;  ///< of a seed
  /// Largest radius of a seed, times the median spacing of cells: per metre of distance to the
  /// sensor where that is known, as beams spread.
  double largest_spacing = 1.2;
  /// Where there are no rays to say what is free, disks stay smaller and end where points end.
  double unchecked_largest_spacing = 0.6;
  double isolated = 3;       ///< a cell that wants so many times the largest has no splat
  double min_range_m = 0.1;  ///< nearer points have no ray: no LiDAR measures them
  int balance_rounds = 4;    ///< of shrinking and removing seeds; 0: no ray check
  JudgeOptions judge;        ///< of seeds
  EvidenceOptions evidence;  ///< its parts are the most: of few rays more are taken
  std::size_t evidence_rays = 2'000'000;  ///< enough of them for a round
  CoverOptions cover;
  int strict_rounds = 5;           ///< of limiting chosen disks
  double max_contradicted = 0.05;  ///< of the rays that confirm a disk that was grown
  int settle_rounds = 2;
  SettleOptions settle;
  bool empty_beams = true;  ///< that are known say what is free
  /// Beams are taken to have started where they are said to; else origin_objection() is an error.
  bool trust_origins = false;
  bool fill = true;        ///< where rays fall between splats, seeds are put back...
  float missed_m = 0.15F;  ///< ...if there is nothing up to so far behind the rays' ends...
  float met_m = 0.4F;      ///< ...and so far before them

  double smallest_cell_m() const { return small_cell_m > 0 ? small_cell_m : cell_m; }
  /// Cells are split up to `split_scale`: planes at larger scales than the first that decides need
  /// not be looked at.
  AdaptivePlaneOptions planes_for_splitting() const;
  /// Largest radius of a seed in median spacings; `has_rays`: of a cell with a beam.
  ADASPLATS_HD double largest_seed(bool has_rays) const {
    return has_rays ? largest_spacing : unchecked_largest_spacing;
  }
  /// As many rays as a round needs, of so many; other ones every round.
  EvidenceOptions evidence_of_round(int round, std::size_t rays) const;
  /// Of growing disks; `checked`: rays say where surfaces end.
  CoverOptions cover_options(bool checked) const;
};

template <class Visit>
void visit_settings(ConsistentOptions& consistent, Visit&& visit) {
  constexpr const char* kGroup = "Method consistent";
  visit(Setting{.name = "cell",
                .help = "Size of the cells in which points are fused, m",
                .key = "cell_m",
                .group = kGroup,
                .min = 0,
                .exclusive_min = true,
                .basic = true},
        consistent.cell_m);
  visit(Setting{.name = "small_cell",
                .help = "Cell size where the surface is not flat, m; 0: that of --cell",
                .key = "small_cell_m",
                .group = kGroup,
                .min = 0},
        consistent.small_cell_m);
  visit(Setting{.name = "largest_radius",
                .help = "Maximum splat radius, m; 0: splats do not grow over their neighbours",
                .key = "largest_radius_m",
                .group = kGroup,
                .min = 0},
        consistent.cover.largest_radius_m);
  visit(
      Setting{
          .name = "balance_rounds",
          .help =
              "Rounds of the visibility check of small splats against measured rays; 0: no check",
          .group = kGroup,
          .min = 0},
      consistent.balance_rounds);
  visit(Setting{.name = "strict_rounds",
                .help = "Rounds of limiting grown splats that measured rays pass through",
                .group = kGroup,
                .min = 0},
        consistent.strict_rounds);
  visit(Setting{.name = "settle_rounds",
                .help = "Rounds of moving splats to where rays end",
                .group = kGroup,
                .min = 0},
        consistent.settle_rounds);
  visit(Setting{.name = "empty_beams",
                .help = "Use beams without return as free-space evidence, if a drive shows which "
                        "beams those were",
                .group = kGroup},
        consistent.empty_beams);
  visit(Setting{.name = "fill",
                .help = "Add small splats where measured rays pass through the surface",
                .group = kGroup},
        consistent.fill);
}

/// Errors: usage (an option out of range).
void check(const ConsistentOptions& consistent);

/// What consistent_disks() did, in numbers.
struct ConsistentReport {
  bool checked = false;                ///< measured rays judged the disks
  std::optional<OriginCheck> origins;  ///< nothing: they were not checked
  std::size_t cells = 0;               ///< that the points were fused in
  std::size_t seeds = 0;               ///< of these cells, those with a disk to begin with
  std::size_t rays = 0;                ///< measured ones, where they judged the disks
  std::size_t empty_beams = 0;         ///< that did so, too
  std::size_t seeds_removed = 0;       ///< that more rays contradict than confirm
  std::size_t splats_filled = 0;       ///< put back where rays fell between disks
};

class ConsistentSteps;

/// Fuses, fits planes, checks, covers, settles what `steps` have loaded. Without known beams
/// (`has_rays` false) or with no balance rounds the steps with rays are left out. `begin_step`
/// hears the name of every step and of how many passes (ProgressPass) it
/// consists. Errors: data (origin_objection()).
ConsistentReport consistent_disks(ConsistentSteps& steps, bool has_rays,
                                  const ConsistentOptions& options,
                                  const std::function<void(std::string_view, int)>& begin_step);

}  // namespace adasplats
