// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/paper/generation.h"

#include <algorithm>
#include <cmath>

#include "adasplats/core/progress_meter.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/splats/model/cpu_backend.h"
#include "adasplats/splats/paper/element_steps.h"

namespace adasplats {
namespace {

std::uint32_t scaled_count(int neighbors, double scale) {
  return static_cast<std::uint32_t>(std::max(1.0, std::round(neighbors * scale)));
}

/// The candidates of a cloud: the splat that each point would grow to.
struct Candidates {
  std::vector<float> radii;
  std::vector<float> shifts;
  DiscardLists discards;
};

Candidates grow_all(std::span<const SurfacePoint> points, const PointIndex& index,
                    const std::array<GroupRules, kSemanticGroups>& rules, double alpha,
                    const Executor& executor) {
  Candidates candidates;
  candidates.radii.resize(points.size());
  candidates.shifts.resize(points.size());
  candidates.discards.begins.resize(points.size());
  candidates.discards.chunk_size = kFineGrain;
  candidates.discards.chunks.resize((points.size() + kFineGrain - 1) / kFineGrain);
  // A chunk of for_each_neighborhood never spans two of these, and its ranks come in order.
  static_assert(PointIndex::kQueriesPerTask == kFineGrain);
  const ProgressPass pass(executor, points.size());
  index.for_each_neighborhood(
      executor, [&](std::uint32_t rank) { return rules[points[rank].group].limit; },
      [&](std::uint32_t rank, const NeighborList& neighbors) {
        const GrownSplat splat =
            grow_splat(points[rank], neighbors, points.data(), rules[points[rank].group].grow);
        candidates.radii[rank] = splat.radius_m;
        candidates.shifts[rank] = splat.shift_m;
        std::vector<std::uint32_t>& chunk = candidates.discards.chunks[rank / kFineGrain];
        candidates.discards.begins[rank] = static_cast<std::uint32_t>(chunk.size());
        // "All points in the neighbourhood inside the sphere of radius alpha r are discarded."
        const float reach = static_cast<float>(alpha) * splat.radius_m;
        for (std::uint32_t k = 0; k < neighbors.size; ++k)
          if (neighbors.ranks[k] != rank && neighbors.squared_distances[k] < reach * reach)
            chunk.push_back(neighbors.ranks[k]);
      });
  return candidates;
}

}  // namespace

std::array<GroupRules, kSemanticGroups> group_rules(const PaperOptions& options, double radius_m,
                                                    double error_m, bool is_oriented) {
  std::array<GroupRules, kSemanticGroups> rules;
  for (std::size_t g = 0; g < kSemanticGroups; ++g) {
    GroupScale scale;
    if (options.variant == PaperVariant::semantic) scale = options.semantic_scales[g];
    if (options.variant == PaperVariant::descriptors) {
      const bool planar = static_cast<SemanticGroup>(g) == SemanticGroup::surface ||
                          static_cast<SemanticGroup>(g) == SemanticGroup::ground;
      scale = planar ? options.planar_scale : options.semantic_scales[g];
    }
    const float radius = static_cast<float>(radius_m * scale.radius);
    const bool adaptive = options.variant != PaperVariant::basic;
    rules[g] = {{scaled_count(options.neighbors, scale.neighbors), radius * radius},
                {static_cast<float>(error_m * scale.error),
                 // Basic splats stop at the error bound alone.
                 adaptive ? static_cast<float>(options.smoothness) : -2.0F,
                 options.variant == PaperVariant::semantic, is_oriented},
                scale.neighbors == 1 && scale.radius == 1};
  }
  return rules;
}

Generation generate_splats(const PointCloud& cloud, std::span<const SemanticGroup> groups,
                           const PaperOptions& options, const Executor& executor, StepSink step) {
  step("neighbourhoods", base_passes(options.radius_m));
  const PointIndex index = PointIndex::from_sorted(cloud.positions, executor);
  BaseNeighborhoods base = base_neighborhoods(
      cloud.positions, index, {static_cast<std::uint32_t>(options.neighbors), options.radius_m, 0},
      executor);

  Generation result;
  result.radius_m = base.radius_m;
  result.error_m = options.error_m.value_or(base.error_m);
  const CpuBackend backend(executor);
  if (options.variant != PaperVariant::basic && !groups.empty()) {
    result.groups.assign(groups.begin(), groups.end());
  } else if (options.variant != PaperVariant::basic) {
    result.groups.resize(cloud.size());
    backend.for_each(cloud.size(), "group points",
                     FindGroupOfShape{base.kinds.data(), result.groups.data()});
  }
  const auto rules = group_rules(options, result.radius_m, result.error_m, cloud.has_all_origins());

  const bool refines = options.variant != PaperVariant::basic && options.group_normals;
  step("normals", refines ? 1 : 0);
  if (refines)
    refine_normals(
        cloud.positions, index,
        [&](std::uint32_t rank) {
          const GroupRules& group = rules[static_cast<std::size_t>(result.groups[rank])];
          return group.like_base ? NeighborLimit{0, -1.0F} : group.limit;
        },
        base.normals, executor);
  const std::vector<SurfacePoint> points =
      surface_points(backend, cloud, base.normals, result.groups);

  step("growing", 1);
  const Candidates candidates = grow_all(points, index, rules, options.alpha, executor);

  step("selection", 0);
  result.seeds =
      select_greedily(candidates.radii, candidates.discards, options.selection, executor);
  result.disks.resize(result.seeds.size());
  backend.for_each(result.seeds.size(), "make splats",
                   MakeSplat{result.seeds.data(), points.data(), candidates.radii.data(),
                             candidates.shifts.data(), result.disks.data()});
  return result;
}

}  // namespace adasplats
