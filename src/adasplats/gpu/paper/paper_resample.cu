// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "adasplats/gpu/neighbors/neighborhoods_lists.cuh"
#include "adasplats/gpu/paper/paper_resample.h"
#include "adasplats/splats/paper/resample.h"

namespace adasplats::gpu {
namespace {

/// The splats as a cloud in canonical order: centres with the attributes of their seeds.
struct Centers {
  DeviceCloud cloud;
  DeviceBuffer<Disk> disks;
  DeviceBuffer<SemanticGroup> groups;  ///< empty for basic splats
};

Centers centers_of(const DeviceCloud& cloud, const DeviceGeneration& first, cudaStream_t stream) {
  DeviceCloud centers = gather(cloud, first.seeds, stream);
  for_each(first.disks.size(), stream, "resample splats",
           [from = first.disks.data(), to = centers.positions.data()] __device__(std::uint64_t i) {
             to[i] = from[i].center;
           });
  // Centres differ from their seeds, so they are sorted along the curve again.
  const DeviceBuffer<std::uint32_t> order = canonical_order(centers, stream);
  return {gather(centers, order, stream), gather(first.disks, order, stream),
          gather(gather(first.groups, first.seeds, stream), order, stream)};
}

/// delta: mean number of splats within R of a splat, non-surface splats excluded.
double mean_density(const DeviceBuffer<std::uint32_t>& densities,
                    const DeviceBuffer<SemanticGroup>& groups, cudaStream_t stream) {
  const std::size_t size = densities.size();
  DeviceBuffer<std::uint32_t> counted(size, stream), ones(size, stream);
  for_each(size, stream, "resample splats",
           [densities = densities.data(), groups = groups.data(), counted = counted.data(),
            ones = ones.data()] __device__(std::uint64_t i) {
             const bool counts = groups == nullptr || groups[i] != SemanticGroup::non_surface;
             counted[i] = counts ? densities[i] : 0;
             ones[i] = counts ? 1 : 0;
           });
  const auto sum = static_cast<double>(sum_of(counted.data(), size, stream));
  const auto count = static_cast<double>(sum_of(ones.data(), size, stream));
  return count > 0 ? sum / count : 0;
}

/// Decides whether two splats may have a new point between them.
struct Alike {
  const Disk* disks;
  const std::uint16_t* classes;  ///< decide in the semantic method
  const SemanticGroup* groups;   ///< decide otherwise
  float smoothness;
  bool oriented;

  __device__ bool operator()(std::uint32_t a, std::uint32_t b) const {
    if (!is_smooth(disks[a].normal, disks[b].normal, smoothness, oriented)) return false;
    if (classes != nullptr) return classes[a] == classes[b];
    return groups == nullptr || groups[a] == groups[b];
  }
};

Alike alike_in(const Centers& centers, const PaperOptions& options, cudaStream_t stream) {
  const bool by_class = options.variant == PaperVariant::semantic;
  return {centers.disks.data(), by_class ? centers.cloud.classes.data() : nullptr,
          centers.groups.data(), static_cast<float>(options.smoothness),
          has_all_origins(centers.cloud, stream)};
}

/// New points, each with the splat whose attributes it copies.
struct NewPoints {
  DeviceBuffer<Vec3f> positions;
  DeviceBuffer<std::uint32_t> splats;
};

/// Makes new points around one splat by the lanes of a warp: between it and its farthest neighbours
/// (the last keys) first, until it has made its share.
struct Fill {
  Alike alike;
  const std::uint32_t* densities;
  double wanted;
  Vec3f* positions;
  std::uint32_t* splats;
  std::uint32_t* made;  ///< number of new points so far

  __device__ void operator()(std::uint32_t splat, const std::uint64_t* keys,
                             std::uint32_t size) const {
    int missing = share_of_missing(wanted, densities[splat]);
    for (std::uint32_t done = 0; done < size && missing > 0; done += kWarpLanes) {
      const std::uint32_t at = done + lane_of_thread();
      const auto other = at < size ? static_cast<std::uint32_t>(keys[size - 1 - at]) : splat;
      const bool fits = other != splat && alike(splat, other);
      const std::uint32_t lanes = __ballot_sync(kAllLanes, fits);
      const auto place = static_cast<int>(lanes_before(lanes));
      const int number = ::min(static_cast<int>(__popc(lanes)), missing);
      std::uint32_t first = 0;
      if (lane_of_thread() == 0 && number > 0) first = atomicAdd(made, number);
      first = __shfl_sync(kAllLanes, first, 0);
      if (fits && place < number) {
        positions[first + place] = midpoint(alike.disks[splat], alike.disks[other]);
        splats[first + place] = splat;
      }
      missing -= number;
    }
  }
};

/// Maximum number of new points that sparse splats can make.
std::size_t max_new_points(const DeviceBuffer<std::uint32_t>& densities, double wanted,
                           cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> counts(densities.size(), stream);
  for_each(densities.size(), stream, "resample splats",
           [wanted, from = densities.data(), to = counts.data()] __device__(std::uint64_t i) {
             const std::uint32_t neighbors = from[i] - 1;
             const bool sparse = from[i] < wanted;
             const int missing = sparse ? share_of_missing(wanted, from[i]) : 0;
             to[i] = ::min(neighbors, static_cast<std::uint32_t>(missing));
           });
  return sum_of(counts.data(), counts.size(), stream);
}

/// New points, unordered; midpoints that both splats made occur twice.
NewPoints interpolate_points(const Centers& centers, double radius_m, const PaperOptions& options,
                             cudaStream_t stream) {
  const DevicePointIndex index(centers.cloud.positions.data(), centers.cloud.size(), stream);
  const auto radius = static_cast<float>(radius_m);
  const DeviceBuffer<std::uint32_t> densities = count_within(index, radius, stream);
  const double wanted = options.resample_density * mean_density(densities, centers.groups, stream);
  const std::size_t most = max_new_points(densities, wanted, stream);
  NewPoints made{DeviceBuffer<Vec3f>(most, stream), DeviceBuffer<std::uint32_t>(most, stream)};
  DeviceBuffer<std::uint32_t> count(1, stream);
  count.fill_bytes(0);
  for_each_neighborhood_of<true>(
      static_cast<std::uint64_t>(std::ceil(wanted)), index, stream, "resample splats",
      [wanted, radius, densities = densities.data()] __device__(std::uint32_t splat) {
        // Fewer neighbours than the mean are within R, so this limit excludes none.
        const bool sparse = densities[splat] < wanted;
        return sparse ? NeighborLimit{densities[splat], radius * radius} : NeighborLimit{0, -1.0F};
      },
      Fill{alike_in(centers, options, stream), densities.data(), wanted, made.positions.data(),
           made.splats.data(), count.data()});
  const std::size_t size = read_value(count.data(), stream);
  const DeviceBuffer<std::uint32_t> all = ascending_numbers(size, stream);
  return {gather(made.positions, all, stream), gather(made.splats, all, stream)};
}

/// Sorts points by coordinates, then by splat, and keeps the first of equal points.
NewPoints without_duplicates(const NewPoints& points, cudaStream_t stream) {
  const std::size_t size = points.splats.size();
  DeviceBuffer<std::uint64_t> keys(size, stream);
  DeviceBuffer<std::uint32_t> order = ascending_numbers(size, stream);
  // The less significant half of the key first: the sort is stable.
  for_each(size, stream, "resample splats",
           [positions = points.positions.data(), splats = points.splats.data(),
            to = keys.data()] __device__(std::uint64_t i) {
             to[i] = std::uint64_t{sortable_bits(positions[i].z)} << 32 | splats[i];
           });
  sort_pairs(keys, order, stream);
  for_each(size, stream, "resample splats",
           [positions = points.positions.data(), order = order.data(),
            to = keys.data()] __device__(std::uint64_t i) {
             const Vec3f p = positions[order[i]];
             to[i] = std::uint64_t{sortable_bits(p.x)} << 32 | sortable_bits(p.y);
           });
  sort_pairs(keys, order, stream);
  DeviceBuffer<std::uint8_t> first(size, stream);
  for_each(size, stream, "resample splats",
           [positions = points.positions.data(), order = order.data(),
            to = first.data()] __device__(std::uint64_t i) {
             to[i] = i == 0 || !(positions[order[i]] == positions[order[i - 1]]);
           });
  const DeviceBuffer<std::uint32_t> kept =
      gather(order, flagged(first.data(), size, stream), stream);
  return {gather(points.positions, kept, stream), gather(points.splats, kept, stream)};
}

/// The points of thin objects, the other points, both or none, with their groups.
struct Part {
  DeviceCloud cloud;
  DeviceBuffer<SemanticGroup> groups;
};

Part part_of(const DeviceCloud& cloud, const DeviceBuffer<SemanticGroup>& groups, bool thin_things,
             bool the_rest, cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> stays(cloud.size(), stream);
  for_each(cloud.size(), stream, "resample splats",
           [groups = groups.data(), thin_things, the_rest,
            to = stays.data()] __device__(std::uint64_t i) {
             const bool thin = groups != nullptr && is_thin(groups[i]);
             to[i] = thin ? thin_things : the_rest;
           });
  const DeviceBuffer<std::uint32_t> kept = flagged(stays.data(), stays.size(), stream);
  return {gather(cloud, kept, stream), gather(groups, kept, stream)};
}

/// Joins parts in canonical order.
Part joined(std::span<const Part> parts, cudaStream_t stream) {
  std::vector<const DeviceCloud*> clouds;
  std::vector<const DeviceBuffer<SemanticGroup>*> groups;
  for (const Part& part : parts) {
    clouds.push_back(&part.cloud);
    groups.push_back(&part.groups);
  }
  const DeviceCloud cloud = concatenate(std::span<const DeviceCloud* const>(clouds), stream);
  const DeviceBuffer<SemanticGroup> all_groups =
      concatenate(std::span<const DeviceBuffer<SemanticGroup>* const>(groups), stream);
  const DeviceBuffer<std::uint32_t> order = canonical_order(cloud, stream);
  return {gather(cloud, order, stream), gather(all_groups, order, stream)};
}

}  // namespace

DeviceResampled resample(const DeviceCloud& cloud, const DeviceGeneration& first,
                         const PaperOptions& options, cudaStream_t stream) {
  const Centers centers = centers_of(cloud, first, stream);
  const NewPoints added =
      without_duplicates(interpolate_points(centers, first.radius_m, options, stream), stream);

  using Base = ResampleBase;
  const Base base = options.resample_base;
  Part parts[3] = {
      part_of(cloud, first.groups, base != Base::centers, base == Base::points, stream),
      part_of(centers.cloud, centers.groups, base == Base::centers, base != Base::points, stream),
      {gather(centers.cloud, added.splats, stream), gather(centers.groups, added.splats, stream)}};
  for_each(added.positions.size(), stream, "resample splats",
           [from = added.positions.data(),
            to = parts[2].cloud.positions.data()] __device__(std::uint64_t i) { to[i] = from[i]; });
  Part whole = joined(parts, stream);
  return {std::move(whole.cloud), std::move(whole.groups), added.splats.size()};
}

}  // namespace adasplats::gpu
