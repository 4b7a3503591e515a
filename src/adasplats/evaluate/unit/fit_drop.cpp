// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The lost beams of a sensor: in blocked sectors, at range edges, and by chance.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/realism/scan_part.h"
#include "adasplats/evaluate/unit/beam_shares.h"
#include "adasplats/evaluate/unit/fit_unit.h"

namespace adasplats {
namespace {

/// How a beam ended, inferred from its neighbours.
enum class BeamEnd : std::uint8_t { returned, lost, lost_at_edge, lost_in_long_run };

struct BeamEnds {
  std::vector<BeamEnd> ends;
  std::vector<double> edge_runs;  ///< RayDropModel::edge_runs; empty: too few edges
};

BeamEnds ends_of(std::span<const SensorBeam> beams) {
  constexpr double kMinEdges = 1000;
  BeamEnds found;
  found.ends.assign(beams.size(), BeamEnd::returned);
  std::vector<double> runs(kMaxEdgeRun, 0);
  double edges = 0;
  std::size_t last = beams.size();  // return before
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (!beams[i].returned()) continue;
    const std::size_t before = std::exchange(last, i);
    if (before == beams.size() || !same_ring(beams[before], beams[i])) continue;
    const std::size_t run = i - before - 1;
    const bool is_long = run > kLongestRun;
    const bool is_edge =
        !is_long && std::fabs(beams[i].range_m - beams[before].range_m) > kRangeEdge_m;
    edges += is_edge ? 1 : 0;
    if (is_edge && run > 0) runs[std::min<std::size_t>(run, kMaxEdgeRun) - 1] += 1;
    std::fill_n(found.ends.begin() + static_cast<std::ptrdiff_t>(before) + 1, run,
                is_long   ? BeamEnd::lost_in_long_run
                : is_edge ? BeamEnd::lost_at_edge
                          : BeamEnd::lost);
  }
  if (edges < kMinEdges) return found;
  for (double& share : runs) share = std::round(1e4 * share / edges) / 1e4;
  found.edge_runs = std::move(runs);
  return found;
}

float drop_share(const SensorBeam& beam, const DropRules& rules) {
  const double chance =
      drop_chance(rules, beam.expected_m, beam.cos_incidence, beam.reflectance, beam.drop_log_odds);
  return static_cast<float>(share_by_chance(beam, chance, !beam.returned(), {4, 2}, {4, 1}, 1));
}

}  // namespace

std::optional<DropFit> fit_unit_drop(std::span<const SensorBeam> beams, double max_range_m) {
  BeamEnds found = ends_of(beams);
  BeamEchoes all;
  std::vector<std::size_t> numbers;
  std::vector<std::uint16_t> rings;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const SensorBeam& beam = beams[i];
    if (!beam.hit || !(static_cast<double>(beam.expected_m) < max_range_m)) continue;
    all.echoes.push_back(beam.conditions());
    all.hit.push_back(1);
    all.lost.push_back(beam.returned() ? 0 : 1);
    all.places.push_back(beam.place);
    numbers.push_back(i);
    rings.push_back(beam.ring);
  }
  DropFit fit;
  fit.shares.assign(beams.size(), std::numeric_limits<float>::quiet_NaN());
  fit.model.blocked = find_blocked_sectors(all.echoes, all.lost, all.places, rings);
  fit.model.edge_runs = std::move(found.edge_runs);
  std::vector<EchoConditions> echoes;
  std::vector<std::uint8_t> lost;
  std::vector<std::size_t> of_echoes;
  for (const std::size_t i : numbers) {
    const bool at_edge = found.ends[i] == BeamEnd::lost_at_edge && !fit.model.edge_runs.empty();
    const bool in_long_run = found.ends[i] == BeamEnd::lost_in_long_run;
    if (at_edge || in_long_run || fit.model.blocks(beams[i].direction)) continue;
    echoes.push_back(beams[i].conditions());
    lost.push_back(beams[i].returned() ? 0 : 1);
    of_echoes.push_back(i);
  }
  try {
    const RayDropModel chance = fit_ray_drop(echoes, lost);
    fit.model.weights = chance.weights;
    fit.model.usual_reflectance = chance.usual_reflectance;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::data) throw;
    return std::nullopt;
  }
  const DropRules rules = drop_rules(fit.model);
  for (const std::size_t i : of_echoes) fit.shares[i] = drop_share(beams[i], rules);
  return fit;
}

}  // namespace adasplats
