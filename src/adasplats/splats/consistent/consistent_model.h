// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "adasplats/core/host_device.h"
#include "adasplats/core/setting.h"
#include "adasplats/splats/consistent/origin_check.h"
#include "adasplats/splats/consistent/seed_growth.h"
#include "adasplats/splats/rays/disk_evidence.h"
#include "adasplats/splats/rays/disk_extent.h"
#include "adasplats/splats/rays/disk_shift.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/surface/adaptive_planes.h"

namespace adasplats {

// The consistent method. A splat is consistent if the measured rays agree with it: rays end at it,
// and no ray passes through it and returns from a point behind it. The method makes a small disk
// (a seed) from every cell of fused points and keeps what the rays support.
//
// The steps, in the order of consistent_disks(). The file in brackets has the work for one element
// (below src/adasplats/); consistent_steps_on.h runs it on all elements, on the CPU or a GPU.
// - fuse: average the points of each grid cell [surface/fused_points.h]; of small dense objects
//   with smaller cells (fitting_scale())
// - fit_seeds: fit planes to the cells [surface/adaptive_planes.h] and make a disk, the seed, of
//   each [splats/consistent/seed_disk.h]
// - check_origins: compare the sensor positions with shifted ones
//   [splats/consistent/origin_check.h]
// - order_rays: sort the measured rays [splats/rays/measured_ray.h]
// - balance_seeds: shrink or remove seeds that rays pass through [splats/rays/disk_evidence.h]
// - cover: grow each seed over its coplanar neighbours [splats/consistent/seed_growth.h]
// - limit_overhangs: shrink grown disks that rays pass through [splats/rays/disk_evidence.h]
// - choose: select few large disks that cover all seeds [splats/consistent/surface_cover.h]
// - settle: move disks along their normals to the ends of the rays [splats/rays/disk_shift.h]
// - fill_gaps: restore seeds where rays miss all disks [splats/consistent/element_steps.h]
// - refine_extents: fit opacities and radii to the shares of rays that pass and end
//   [splats/rays/disk_extent.h]
// Without sensor positions the steps with rays are skipped, and disks stay smaller.

/// Options of the consistent method; docs/research/consistent.md gives the source of each number.
struct ConsistentOptions {
  double cell_m = 0.05;  ///< side of the cells that points are fused in
  /// Cells are split if no plane around them is larger than this scale (of `planes.scales`)...
  std::uint8_t split_scale = 1;
  double small_cell_m = 0.02;  ///< ...into cells of this side; 0: not split
  AdaptivePlaneOptions planes;
  double seed_spacing = 1.2;    ///< radius of a seed, times the distance to the 7th cell
  double min_radius_m = 0.015;  ///< of a seed
  /// Maximum radius of a seed, times the median spacing of cells. The spacing is per metre of
  /// distance to the sensor if that is known, since beams diverge.
  double largest_spacing = 1.2;
  /// The same without rays: nothing shows free space, so disks stay smaller and end with the
  /// points.
  double unchecked_largest_spacing = 0.6;
  double isolated = 3;       ///< no seed if its radius would be this many times the maximum
  double min_range_m = 0.1;  ///< nearer points have no ray: no LiDAR measures them
  int balance_rounds = 4;    ///< of shrinking and removing seeds; 0: no visibility check
  SeedCheckOptions judge;
  EvidenceOptions evidence;  ///< `parts` is a maximum: with few rays a round casts more of them
  std::size_t evidence_rays = 2'000'000;  ///< rays that a round needs
  CoverOptions cover;
  int strict_rounds = 5;  ///< of limiting chosen disks
  double max_contradicted =
      0.05;  ///< rays through a grown disk, as a share of those that end at it
  int settle_rounds = 2;
  SettleOptions settle;
  bool empty_beams = true;  ///< beams without return show free space, too
  /// Accept the sensor positions; else an origin_objection() is an error.
  bool trust_origins = false;
  bool fill = true;        ///< restore seeds where rays pass between splats...
  float missed_m = 0.15F;  ///< ...if no splat is within this distance behind the ray's end...
  float met_m = 0.4F;      ///< ...and within this distance before it
  bool refine = true;      ///< estimate opacities and radii from rays; else splats are opaque
  ExtentOptions extent;
  /// Scale the default cells and limits for small dense objects; false for tiles of a city, which
  /// share their cells.
  bool fit_scale = true;

  /// Larger cells, one round of each check and no refinement: several times as fast.
  static ConsistentOptions draft();

  double smallest_cell_m() const { return small_cell_m > 0 ? small_cell_m : cell_m; }
  /// The options for a scene of `scale` times the size: cells and all limits in metres, except the
  /// minimum range.
  ConsistentOptions scaled(double scale) const;
  bool has_default_sizes() const;  ///< of cells and splats
  /// `planes` for deciding which cells to split: only the scales up to the one after `split_scale`.
  AdaptivePlaneOptions planes_for_splitting() const;
  /// Maximum radius of a seed in median spacings; `has_rays`: the cell has a beam.
  ADASPLATS_HD double largest_seed(bool has_rays) const {
    return has_rays ? largest_spacing : unchecked_largest_spacing;
  }
  /// Selects as many of `rays` as a round needs; different ones in every round.
  EvidenceOptions evidence_of_round(int round, std::size_t rays) const;
  /// A quarter of `rays` in each of the first two rounds, half of them in the third, then all:
  /// later rounds correct the first ones. More if that are fewer than a round needs.
  ExtentOptions extent_of_round(int round, std::size_t rays) const;
  /// For growing disks; `checked`: rays show where surfaces end.
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
  visit(Setting{.name = "refine",
                .help = "Estimate opacities and radii of splats from the rays that pass them and "
                        "end at them; otherwise they are opaque",
                .group = kGroup},
        consistent.refine);
}

/// Errors: usage (an option out of range).
void check(const ConsistentOptions& consistent);

/// Figures of consistent_disks().
struct ConsistentReport {
  bool checked = false;                ///< the disks were checked against measured rays
  std::optional<OriginCheck> origins;  ///< nullopt: not checked
  double scale = 1;                    ///< of the cells and limits, for small dense objects
  double cell_m = 0;                   ///< side of the cells
  double spacing_m = 0;                ///< of points in cells with several; at most cell_m
  std::size_t cells = 0;               ///< of fused points
  std::size_t seeds = 0;               ///< cells with a disk before the visibility check
  std::size_t rays = 0;                ///< measured rays that the disks were checked against
  std::size_t empty_beams = 0;         ///< and beams without return
  std::size_t seeds_removed = 0;       ///< more rays contradict than confirm them
  std::size_t splats_filled = 0;       ///< restored where rays passed between disks
  bool sparse = false;                 ///< no centre was moved far (TypicalSpacing::is_sparse())
  /// Splats whose centres were moved by the maximum, 10 cm, and are not on the surface.
  std::size_t splats_limited = 0;
};

/// Warning about cells that are smaller than chosen, or much larger than the spacing of points;
/// empty if the cells fit. `options`: as chosen.
std::string spacing_doubt(const ConsistentReport& report, const ConsistentOptions& options);

class ConsistentSteps;

/// Runs all steps on the cloud that `steps` have loaded. Without beams (`has_rays` false) or with
/// no balance rounds the steps with rays are skipped. Calls `begin_step` with the name of every
/// step and its number of passes (ProgressPass). Errors: data (origin_objection()).
ConsistentReport consistent_disks(ConsistentSteps& steps, bool has_rays,
                                  const ConsistentOptions& options,
                                  const std::function<void(std::string_view, int)>& begin_step);

}  // namespace adasplats
