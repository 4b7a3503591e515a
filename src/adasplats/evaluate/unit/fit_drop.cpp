// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Which beams a unit loses: blocked sectors, range edges, and by chance.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/realism/scan_part.h"
#include "adasplats/evaluate/unit/fit_unit.h"

namespace adasplats {
namespace {

/// Why a beam did not come back, as far as its neighbours tell.
enum class BeamEnd : std::uint8_t { returned, lost, lost_at_edge, lost_in_long_run };

struct BeamEnds {
  std::vector<BeamEnd> ends;
  std::vector<double> edge_runs;  ///< RayDropModel::edge_runs; empty: too few edges
};

BeamEnds ends_of(std::span<const UnitBeam> beams) {
  constexpr double kLeastEdges = 1000;
  BeamEnds found;
  found.ends.assign(beams.size(), BeamEnd::returned);
  std::vector<double> runs(kMostEdgeRun, 0);
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
    if (is_edge && run > 0) runs[std::min<std::size_t>(run, kMostEdgeRun) - 1] += 1;
    std::fill_n(found.ends.begin() + static_cast<std::ptrdiff_t>(before) + 1, run,
                is_long   ? BeamEnd::lost_in_long_run
                : is_edge ? BeamEnd::lost_at_edge
                          : BeamEnd::lost);
  }
  if (edges < kLeastEdges) return found;
  for (double& share : runs) share = std::round(1e4 * share / edges) / 1e4;
  found.edge_runs = std::move(runs);
  return found;
}

EchoConditions conditions_of(const UnitBeam& beam) {
  return {beam.expected_m, beam.cos_incidence, beam.reflectance, beam.direction};
}

/// A number that beams of so many rings and columns have in common, 0 to 1.
double common_share(const UnitBeam& beam, std::uint32_t rings, std::uint32_t columns,
                    std::uint64_t stream) {
  return Random(beam.scan, stream, std::uint64_t{beam.ring / rings} << 32 | beam.column / columns)
      .uniform();
}

/// Lost ones are below their chance, others above; where within, nobody knows: what is drawn is
/// alike in neighbours, so that runs stay runs where the chance is another one.
double share_of_beam(const UnitBeam& beam, double chance) {
  if (!beam.returned()) return chance * common_share(beam, 4, 2, 1);
  return chance + (1 - chance) * common_share(beam, 4, 1, 2);
}

}  // namespace

std::optional<DropFit> fit_unit_drop(std::span<const UnitBeam> beams, double max_range_m) {
  BeamEnds found = ends_of(beams);
  BeamEchoes all;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const UnitBeam& beam = beams[i];
    if (!beam.hit || !(static_cast<double>(beam.expected_m) < max_range_m)) continue;
    all.echoes.push_back(conditions_of(beam));
    all.hit.push_back(1);
    all.lost.push_back(beam.returned() ? 0 : 1);
    all.places.push_back(beam.place);
    numbers.push_back(i);
  }
  DropFit fit;
  fit.shares.assign(beams.size(), std::numeric_limits<float>::quiet_NaN());
  fit.model.blocked = find_blocked_sectors(all.echoes, all.lost, all.places);
  fit.model.edge_runs = std::move(found.edge_runs);
  std::vector<EchoConditions> echoes;
  std::vector<std::uint8_t> lost;
  std::vector<std::size_t> of_echoes;
  for (const std::size_t i : numbers) {
    const bool at_edge = found.ends[i] == BeamEnd::lost_at_edge && !fit.model.edge_runs.empty();
    if (at_edge || fit.model.blocks(beams[i].direction)) continue;
    if (found.ends[i] == BeamEnd::lost_in_long_run) {
      fit.shares[i] = 0;
      continue;
    }
    echoes.push_back(conditions_of(beams[i]));
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
  const DropRules rules = fit.model.rules();
  for (std::size_t k = 0; k < echoes.size(); ++k) {
    const double chance =
        drop_chance(rules, echoes[k].range_m, echoes[k].cos_incidence, echoes[k].reflectance);
    fit.shares[of_echoes[k]] = static_cast<float>(share_of_beam(beams[of_echoes[k]], chance));
  }
  return fit;
}

}  // namespace adasplats
