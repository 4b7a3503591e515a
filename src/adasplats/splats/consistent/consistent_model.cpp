// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/consistent_model.h"

#include <algorithm>
#include <bit>
#include <string>

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

EvidenceOptions ConsistentOptions::evidence_of_round(int round, std::size_t rays) const {
  EvidenceOptions chosen = evidence;
  const std::size_t parts = std::clamp<std::size_t>(rays / evidence_rays, 1, chosen.parts);
  chosen.parts = static_cast<std::uint32_t>(std::bit_floor(parts));
  chosen.part = static_cast<std::uint32_t>(round) % chosen.parts;
  return chosen;
}

CoverOptions ConsistentOptions::cover_options(bool checked) const {
  CoverOptions chosen = cover;
  if (!checked) chosen.sectors = chosen.unchecked_sectors;
  return chosen;
}

ConsistentReport consistent_disks(ConsistentSteps& steps, bool has_rays,
                                  const ConsistentOptions& options,
                                  const std::function<void(std::string_view, int)>& begin_step) {
  const bool checked = has_rays && options.balance_rounds > 0;
  ConsistentReport report;
  report.checked = checked;
  begin_step("fusion", 0);
  steps.fuse(options);
  begin_step("planes", 2);
  steps.fit_seeds(options);
  report.cells = steps.counts().cells;
  report.seeds = steps.counts().seeds;
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
  }
  return report;
}

}  // namespace adasplats
