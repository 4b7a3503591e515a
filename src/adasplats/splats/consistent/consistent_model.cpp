// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/consistent_model.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/splats/consistent/consistent_steps.h"

namespace adasplats {

void check(const ConsistentOptions& consistent) {
  check_settings(consistent);
  const auto require = [](bool ok, const char* message) {
    if (!ok) throw Error(ErrorKind::usage, message);
  };
  require(consistent.small_cell_m < consistent.cell_m,
          "small cells must be smaller than the cells, or 0");
  require(SectorReach::is_valid_count(consistent.cover.sectors) &&
              SectorReach::is_valid_count(consistent.cover.unchecked_sectors),
          "sectors must be 0, 1, 2, 4, 8 or 16");
  require(consistent.judge.core_rings >= 1 && consistent.judge.core_rings <= RayEvidence::kBins,
          "the core rings must be 1 to 16");
  require(consistent.evidence_rays > 0, "evidence rays must be greater than 0");
  require(consistent.evidence.parts == 1 || consistent.evidence.parts == 2 ||
              consistent.evidence.parts == kRayParts,
          "rays are cast in 1, 2 or 4 parts");
}

AdaptivePlaneOptions ConsistentOptions::planes_for_splitting() const {
  AdaptivePlaneOptions few = planes;
  const std::size_t decides = std::min<std::size_t>(split_scale + 1U, few.scales.size() - 1);
  std::fill(few.scales.begin() + decides, few.scales.end(), few.scales[decides]);
  return few;
}

namespace {

/// Number of parts with at least `needed` rays each: a power of two, at most `most`.
std::uint32_t parts_of(std::size_t rays, std::size_t needed, std::uint32_t most) {
  const std::size_t parts = std::clamp<std::size_t>(rays / needed, 1, most);
  return static_cast<std::uint32_t>(std::bit_floor(parts));
}

}  // namespace

EvidenceOptions ConsistentOptions::evidence_of_round(int round, std::size_t rays) const {
  EvidenceOptions chosen = evidence;
  chosen.parts = parts_of(rays, evidence_rays, evidence.parts);
  chosen.part = static_cast<std::uint32_t>(round) % chosen.parts;
  return chosen;
}

ExtentOptions ConsistentOptions::extent_of_round(int round, std::size_t rays) const {
  ExtentOptions chosen = extent;
  chosen.parts = parts_of(rays, evidence_rays, round < 3 ? kRayParts >> round / 2 : 1);
  chosen.part = static_cast<std::uint32_t>(round) % chosen.parts;
  chosen.opacity_prior /= chosen.parts;
  chosen.scale_prior /= chosen.parts;
  return chosen;
}

CoverOptions ConsistentOptions::cover_options(bool checked) const {
  CoverOptions chosen = cover;
  if (!checked) chosen.sectors = chosen.unchecked_sectors;
  return chosen;
}

ConsistentOptions ConsistentOptions::draft() {
  ConsistentOptions draft;
  draft.cell_m = 0.1;
  draft.small_cell_m = 0;
  draft.balance_rounds = draft.strict_rounds = draft.settle_rounds = 1;
  draft.refine = false;
  return draft;
}

ConsistentOptions ConsistentOptions::scaled(double scale) const {
  ConsistentOptions made = *this;
  for (double* length_m :
       {&made.cell_m, &made.small_cell_m, &made.planes.max_sigma_m, &made.planes.min_sigma_m,
        &made.planes.max_shift_m, &made.min_radius_m, &made.cover.tolerance_m, &made.cover.edge_m,
        &made.cover.largest_radius_m, &made.cover.covered_within_m, &made.settle.reach_m,
        &made.settle.scale_m, &made.settle.max_shift_m})
    *length_m *= scale;
  for (float* length_m :
       {&made.judge.min_radius_m, &made.evidence.range_margin_m, &made.evidence.height_margin_m,
        &made.missed_m, &made.met_m, &made.extent.error_scale_m, &made.extent.beyond_m})
    *length_m *= static_cast<float>(scale);
  return made;
}

bool ConsistentOptions::has_default_sizes() const {
  const ConsistentOptions given;
  return cell_m == given.cell_m && small_cell_m == given.small_cell_m &&
         cover.largest_radius_m == given.cover.largest_radius_m;
}

namespace {

// An object is small and dense if its points fill at most kSmallCells cells (10 m2 of cells of 5
// cm) with at least kDensePoints points each: cells of a third of the side would have one point.
constexpr std::size_t kSmallCells = 4000;
constexpr double kDensePoints = 9;
constexpr double kMinScale = 1.0 / 256;  // cells of 0.2 mm

double points_per_cell(const ConsistentCounts& counts) {
  return counts.cells == 0 ? 0
                           : static_cast<double>(counts.points) / static_cast<double>(counts.cells);
}

/// Share of the cells whose surroundings are flat: noise is smaller than the cells.
double flat_share(ConsistentSteps& steps, const ConsistentOptions& options) {
  const std::vector<CellSpacing> cells = steps.spacings(options);
  const auto flat = std::ranges::count_if(cells, [](const CellSpacing& cell) { return cell.flat; });
  return static_cast<double>(flat) / static_cast<double>(cells.size());
}

/// Scale of cells and limits for the fused points: 1, except for small dense objects. For these the
/// smallest power of 1/2 whose cells have a few points each and are mostly flat: smaller cells
/// would be finer than the points, or than their noise.
double fitting_scale(ConsistentSteps& steps, const ConsistentOptions& options) {
  constexpr double kMinFlat = 0.5;
  const ConsistentCounts counts = steps.counts();
  if (counts.cells > kSmallCells || points_per_cell(counts) < kDensePoints) return 1;
  double scale = 1;
  while (scale > kMinScale && points_per_cell(steps.counts()) >= kDensePoints) {
    scale /= 2;
    steps.fuse(options.scaled(scale));
  }
  while (scale < 1 && flat_share(steps, options.scaled(scale)) < kMinFlat) {
    scale *= 2;
    steps.fuse(options.scaled(scale));
  }
  return scale;
}

/// Minimum share of confirming rays for a seed to be refined. Fewer rays confirm what moved.
constexpr double kMinConfirmed = 0.2;

std::string millimetres(double length_m) {
  std::ostringstream text;
  text << std::setprecision(2) << 1000 * length_m;
  return text.str() + " mm";
}

}  // namespace

std::string spacing_doubt(const ConsistentReport& report, const ConsistentOptions& options) {
  constexpr double kMaxRatio = 10;  // of cells and spacing
  if (report.spacing_m == 0) return {};
  const double ratio = report.cell_m / report.spacing_m;
  const std::string points = "points are " + millimetres(report.spacing_m) + " apart on average";
  if (report.scale < 1)
    return points + ", so cells and limits in metres are scaled by 1/" +
           std::to_string(std::lround(1 / report.scale)) + ": cells of " +
           millimetres(report.cell_m) + " instead of " + millimetres(options.cell_m) +
           " (--cell and --small-cell choose other ones)";
  const bool is_small = report.cells <= kSmallCells && ratio * ratio >= kDensePoints;
  if (!options.has_default_sizes() || report.checked || !(is_small || ratio >= kMaxRatio))
    return {};
  return points + ", but cells of " + millimetres(report.cell_m) + " (" +
         std::to_string(std::lround(ratio)) +
         " times as large) merge them; if their noise is lower than 1 cm, choose smaller cells "
         "with "
         "--cell and --small-cell";
}

ConsistentReport consistent_disks(ConsistentSteps& steps, bool has_rays,
                                  const ConsistentOptions& chosen,
                                  const std::function<void(std::string_view, int)>& begin_step) {
  const bool checked = has_rays && chosen.balance_rounds > 0;
  ConsistentReport report;
  report.checked = checked;
  begin_step("fusion", 0);
  steps.fuse(chosen);
  if (chosen.fit_scale && chosen.has_default_sizes()) report.scale = fitting_scale(steps, chosen);
  ConsistentOptions options = chosen.scaled(report.scale);
  // Refinement decides about disks that some rays pass.
  if (options.refine) options.judge.min_share = kMinConfirmed;
  report.cell_m = options.cell_m;
  if (steps.counts().points > 0)
    report.spacing_m = options.cell_m / std::sqrt(points_per_cell(steps.counts()));
  begin_step("planes", 2);
  steps.fit_seeds(options);
  report.cells = steps.counts().cells;
  report.seeds = steps.counts().seeds;
  report.sparse = steps.is_sparse();
  if (checked && !options.trust_origins) {
    begin_step("check of sensor positions", 1 + static_cast<int>(kOriginMoves.size()));
    report.origins = origin_check(steps.check_origins(options));
    const std::string objection = origin_objection(*report.origins);
    if (!objection.empty()) throw Error(ErrorKind::data, objection);
  }
  if (checked) {
    begin_step("visibility check of seeds", options.balance_rounds);
    steps.order_rays(options);
    for (int i = 0; i < options.balance_rounds; ++i) steps.balance_seeds(i, options);
    report.rays = steps.counts().rays;
    report.empty_beams = steps.counts().empty;
    report.seeds_removed = report.seeds - steps.counts().seeds;
  }
  begin_step("cover", 1);
  steps.cover(checked, options);
  if (checked) {
    begin_step("visibility check of splats", options.strict_rounds);
    for (int i = 0; i < options.strict_rounds; ++i) steps.limit_overhangs(i, options);
    steps.limit_unchosen();
  }
  steps.choose();
  if (checked) {
    begin_step("settling", options.settle_rounds);
    for (int i = 0; i < options.settle_rounds; ++i) steps.settle(options);
    if (options.fill) {
      begin_step("filling", 1);
      const std::size_t before = steps.counts().disks;
      steps.fill_gaps(options);
      report.splats_filled = steps.counts().disks - before;
    }
    if (options.refine) {
      begin_step("refinement", options.extent.rounds);
      for (int i = 0; i < options.extent.rounds; ++i) steps.refine_extents(i, options);
      steps.soften(options);
    }
  }
  report.splats_limited = steps.count_limited();
  return report;
}

}  // namespace adasplats
