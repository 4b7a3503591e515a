// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/gpu/neighbors/gpu_backend.cuh"
#include "adasplats/gpu/neighbors/neighborhoods_lists.cuh"
#include "adasplats/gpu/paper/paper_generation.h"
#include "adasplats/gpu/paper/paper_shapes.h"
#include "adasplats/gpu/paper/select_rounds.h"
#include "adasplats/splats/paper/element_steps.h"

namespace adasplats::gpu {
namespace {

/// The rules of all groups, by value into kernels.
struct AllRules {
  GroupRules of[kSemanticGroups];
};

DeviceBuffer<SemanticGroup> copied(const DeviceBuffer<SemanticGroup>& groups, cudaStream_t stream) {
  DeviceBuffer<SemanticGroup> copy(groups.size(), stream);
  if (groups.empty()) return copy;
  cuda_check(
      cudaMemcpyAsync(copy.data(), groups.data(), groups.bytes(), cudaMemcpyDeviceToDevice, stream),
      "copy groups");
  return copy;
}

/// The neighbourhoods in which splats grow.
DeviceLists growing_lists(const DevicePointIndex& index, const AllRules& rules,
                          const SemanticGroup* groups, cudaStream_t stream) {
  std::uint32_t most = 0;
  for (const GroupRules& group : rules.of) most = std::max(most, group.limit.count);
  return find_lists(
      index, groups == nullptr ? rules.of[0].limit.count : most, stream, "find neighbours",
      [rules, groups] __device__(std::uint32_t rank) {
        return rules.of[groups == nullptr ? 0 : static_cast<std::uint32_t>(groups[rank])].limit;
      },
      [] __device__(std::uint32_t, const std::uint64_t*, std::uint32_t) {});
}

/// Normals from the neighbourhoods of the groups, if these differ from the base neighbourhoods.
void refine(const DeviceCloud& cloud, const DeviceLists& lists, const AllRules& rules,
            const SemanticGroup* groups, DeviceBuffer<Vec3f>& normals, cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> wanted(cloud.size(), stream);
  for_each(cloud.size(), stream, "fit planes",
           [rules, groups, to = wanted.data()] __device__(std::uint64_t i) {
             to[i] = rules.of[static_cast<std::uint32_t>(groups[i])].like_base ? 0 : 1;
           });
  refine_normals(cloud.positions.data(), lists, wanted.data(), normals, stream);
}

/// A point in two loads.
__device__ inline SurfacePoint load(const SurfacePoint* points, std::uint32_t rank) {
  const float4* from = reinterpret_cast<const float4*>(points + rank);
  const float4 a = __ldg(from), b = __ldg(from + 1);
  return {{a.x, a.y, a.z}, __float_as_uint(a.w), {b.x, b.y, b.z}, __float_as_uint(b.w)};
}

/// grow_splat() by the lanes of a warp; all of them get the splat.
__device__ GrownSplat grow_splat(const SurfacePoint& seed, const ListsView& lists,
                                 std::uint32_t point, const SurfacePoint* points,
                                 const GrowRules& rules) {
  const std::uint32_t* ranks = lists.of(point);
  const std::uint32_t size = lists.sizes[point];
  std::uint64_t stop = ~std::uint64_t{0};
  std::uint32_t squared_reach = 0;  // as bits, which have the order of the float
  for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes) {
    const SurfacePoint other = load(points, ranks[k]);
    const std::uint64_t key =
        neighbor_key(squared_distance(other.position, seed.position), ranks[k]);
    squared_reach = std::max(squared_reach, static_cast<std::uint32_t>(key >> 32));
    if (key < stop && stops(seed, other, rules)) stop = key;
  }
  stop = warp_min(stop);
  const ExactAddends exact = exact_shifts(size, __uint_as_float(warp_max(squared_reach)), rules);
  double sum = 0;
  std::uint32_t included = 0;
  std::uint64_t last = 0;
  for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes) {
    const Vec3f other = points[ranks[k]].position;
    const std::uint64_t key = neighbor_key(squared_distance(other, seed.position), ranks[k]);
    if (key >= stop) continue;
    sum += exact(static_cast<double>(dot(seed.normal, other - seed.position)));
    ++included;
    last = key > last ? key : last;
  }
  included = warp_sum(included);
  if (included == 0) return {};
  last = warp_max(last);
  const Vec3f farthest = points[static_cast<std::uint32_t>(last)].position;
  return {splat_radius(seed, farthest), static_cast<float>(warp_sum(sum) / included)};
}

/// The candidate splats of all points. The lists become the discard lists: "all points in the
/// neighbourhood inside the sphere of radius alpha r are discarded."
struct Candidates {
  DeviceBuffer<float> radii;
  DeviceBuffer<float> shifts;
};

Candidates grow_all(const DeviceBuffer<SurfacePoint>& points, const DeviceLists& lists,
                    const AllRules& rules, double alpha, cudaStream_t stream) {
  Candidates candidates{DeviceBuffer<float>(points.size(), stream),
                        DeviceBuffer<float>(points.size(), stream)};
  for_each_warp(points.size(), stream, "grow splats",
                [rules, points = points.data(), view = lists.view(),
                 radii = candidates.radii.data(), shifts = candidates.shifts.data(),
                 share = static_cast<float>(alpha)] __device__(std::uint32_t i) {
                  const SurfacePoint seed = load(points, i);
                  const GrownSplat splat =
                      grow_splat(seed, view, i, points, rules.of[seed.group].grow);
                  if (lane_of_thread() == 0) {
                    radii[i] = splat.radius_m;
                    shifts[i] = splat.shift_m;
                  }
                  const float reach = share * splat.radius_m;
                  keep_in_list(view, i, [&](std::uint32_t other) {
                    return other != i &&
                           squared_distance(points[other].position, seed.position) < reach * reach;
                  });
                });
  return candidates;
}

/// Waits for the previous step, so that its time and errors are attributed to it.
void begin(std::string_view name, cudaStream_t stream, StepSink step) {
  cuda_check(cudaStreamSynchronize(stream), "make splats");
  step(name, 0);
}

}  // namespace

DeviceGeneration generate_splats(const GpuBackend& place, const DeviceCloud& cloud,
                                 const DeviceBuffer<SemanticGroup>& groups,
                                 const PaperOptions& options, StepSink step) {
  const cudaStream_t stream = place.stream();
  begin("neighbourhoods", stream, step);
  const bool adaptive = options.variant != PaperVariant::basic;
  const DevicePointIndex index(cloud.positions.data(), cloud.size(), stream);
  DeviceBase base = base_neighborhoods(
      cloud.positions.data(), index,
      {static_cast<std::uint32_t>(options.neighbors), options.radius_m, 0}, stream);
  DeviceGeneration result;
  result.radius_m = base.radius_m;
  result.error_m = options.error_m.value_or(base.error_m);
  if (adaptive && !groups.empty()) {
    result.groups = copied(groups, stream);
  } else if (adaptive) {
    result.groups = place.array<SemanticGroup>(cloud.size());
    place.for_each(cloud.size(), "group points",
                   FindGroupOfShape{base.kinds.data(), result.groups.data()});
  }
  const auto rules_of_groups =
      group_rules(options, result.radius_m, result.error_m, has_all_origins(cloud, stream));
  AllRules rules;
  std::copy(rules_of_groups.begin(), rules_of_groups.end(), rules.of);

  begin("normals", stream, step);
  DeviceLists lists = growing_lists(index, rules, result.groups.data(), stream);
  if (adaptive && options.group_normals)
    refine(cloud, lists, rules, result.groups.data(), base.normals, stream);
  const DeviceBuffer<SurfacePoint> points =
      surface_points(place, cloud, base.normals, result.groups);

  begin("growing", stream, step);
  const Candidates candidates = grow_all(points, lists, rules, options.alpha, stream);

  begin("selection", stream, step);
  result.seeds = select_greedily(candidates.radii, lists, options.selection, stream);
  result.disks = place.array<Disk>(result.seeds.size());
  place.for_each(result.seeds.size(), "make splats",
                 MakeSplat{result.seeds.data(), points.data(), candidates.radii.data(),
                           candidates.shifts.data(), result.disks.data()});
  cuda_check(cudaStreamSynchronize(stream), "make splats");
  return result;
}

}  // namespace adasplats::gpu
