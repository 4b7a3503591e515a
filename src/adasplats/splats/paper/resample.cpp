// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/paper/resample.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "adasplats/core/progress_meter.h"
#include "adasplats/splats/model/canonical_order.h"

namespace adasplats {
namespace {

/// A point half way between two splats, and the splat that provides its attributes.
struct NewPoint {
  Vec3f position;
  std::uint32_t splat;
};

/// The splats as a cloud along the curve: centers with the attributes of their seeds.
PointCloud cloud_of_centers(const PointCloud& cloud, const Generation& first) {
  PointCloud centers = gather(cloud, first.seeds);
  for (std::size_t s = 0; s < first.disks.size(); ++s) centers.positions[s] = first.disks[s].center;
  return centers;
}

/// delta: mean number of splats within R of a splat, non-surface splats excluded.
double mean_density(std::span<const std::uint32_t> densities,
                    std::span<const SemanticGroup> groups) {
  double sum = 0, count = 0;
  for (std::size_t s = 0; s < densities.size(); ++s) {
    if (!groups.empty() && groups[s] == SemanticGroup::non_surface) continue;
    sum += densities[s];
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

/// Makes the new points of one splat, with its farthest neighbours first.
void fill_around(std::uint32_t splat, int missing, std::vector<std::uint64_t>& neighbors,
                 const std::vector<Disk>& disks,
                 FunctionRef<bool(std::uint32_t, std::uint32_t)> alike,
                 std::vector<NewPoint>& new_points) {
  std::sort(neighbors.begin(), neighbors.end(), std::greater<>());
  for (const std::uint64_t key : neighbors) {
    if (missing <= 0) return;
    const auto other = static_cast<std::uint32_t>(key);
    if (other == splat || !alike(splat, other)) continue;
    new_points.push_back({midpoint(disks[splat], disks[other]), splat});
    missing -= 1;
  }
}

std::vector<NewPoint> interpolate_points(const PointCloud& centers, const std::vector<Disk>& disks,
                                         std::span<const SemanticGroup> groups, double radius_m,
                                         const PaperOptions& options, const Executor& executor) {
  const PointIndex index = PointIndex::from_sorted(centers.positions, executor);
  const float radius = static_cast<float>(radius_m);
  const ProgressPass pass(executor, 2 * centers.size());  // counting, filling
  const std::vector<std::uint32_t> densities = index.count_within(radius, executor);
  const double wanted = options.resample_density * mean_density(densities, groups);
  const bool is_oriented = centers.has_all_origins();
  const auto smoothness = static_cast<float>(options.smoothness);
  const auto alike = [&](std::uint32_t a, std::uint32_t b) {
    if (!is_smooth(disks[a].normal, disks[b].normal, smoothness, is_oriented)) return false;
    if (options.variant == PaperVariant::semantic) return centers.classes[a] == centers.classes[b];
    return groups.empty() || groups[a] == groups[b];
  };
  std::vector<std::vector<NewPoint>> chunks(centers.size() / kFineGrain + 1);
  index.for_each_neighborhood(
      executor,
      [&](std::uint32_t splat) {
        // All `densities[splat]` neighbours within R are found.
        const bool sparse = densities[splat] < wanted;
        return sparse ? NeighborLimit{densities[splat], radius * radius} : NeighborLimit{0, -1.0F};
      },
      [&](std::uint32_t splat, const NeighborList& found) {
        if (found.empty()) return;
        std::vector<std::uint64_t> neighbors;
        for (std::uint32_t k = 0; k < found.size; ++k) neighbors.push_back(found.key(k));
        fill_around(splat, share_of_missing(wanted, densities[splat]), neighbors, disks, alike,
                    chunks[splat / kFineGrain]);
      });
  std::vector<NewPoint> all;
  for (const auto& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  return all;
}

/// Removes the second copy of midpoints that both neighbours made.
void remove_duplicates(std::vector<NewPoint>& points) {
  const auto key = [](const NewPoint& p) {
    return std::tie(p.position.x, p.position.y, p.position.z, p.splat);
  };
  std::sort(points.begin(), points.end(),
            [&](const NewPoint& a, const NewPoint& b) { return key(a) < key(b); });
  points.erase(
      std::unique(points.begin(), points.end(),
                  [](const NewPoint& a, const NewPoint& b) { return a.position == b.position; }),
      points.end());
}

}  // namespace

ResampledCloud resample(const PointCloud& cloud, const Generation& first,
                        const PaperOptions& options, const Executor& executor) {
  // Centers have moved off their seeds: put them along the curve again.
  PointCloud centers = cloud_of_centers(cloud, first);
  const std::vector<std::uint32_t> order = canonical_order(centers, executor);
  centers = gather(centers, order);
  std::vector<Disk> disks;
  std::vector<SemanticGroup> groups;
  for (const std::uint32_t s : order) {
    disks.push_back(first.disks[s]);
    if (!first.groups.empty()) groups.push_back(first.groups[first.seeds[s]]);
  }

  std::vector<NewPoint> new_points =
      interpolate_points(centers, disks, groups, first.radius_m, options, executor);
  remove_duplicates(new_points);

  std::vector<std::uint32_t> sources(new_points.size());
  for (std::size_t i = 0; i < new_points.size(); ++i) sources[i] = new_points[i].splat;
  PointCloud added = gather(centers, sources);
  for (std::size_t i = 0; i < new_points.size(); ++i) added.positions[i] = new_points[i].position;
  std::vector<SemanticGroup> added_groups;
  if (!groups.empty())
    for (const std::uint32_t s : sources) added_groups.push_back(groups[s]);

  ResampledCloud result;
  result.new_points = new_points.size();
  const auto keep = [&](const PointCloud& from, std::span<const SemanticGroup> from_groups,
                        bool thin_things, bool the_rest) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < from.size(); ++i) {
      const bool thin = !from_groups.empty() && is_thin(from_groups[i]);
      if (thin ? !thin_things : !the_rest) continue;
      kept.push_back(i);
      if (!from_groups.empty()) result.groups.push_back(from_groups[i]);
    }
    append(result.cloud, gather(from, kept));
  };
  using Base = ResampleBase;
  const Base base = options.resample_base;
  keep(cloud, first.groups, base != Base::centers, base == Base::points);
  keep(centers, groups, base == Base::centers, base != Base::points);
  append(result.cloud, std::move(added));
  result.groups.insert(result.groups.end(), added_groups.begin(), added_groups.end());
  return result;
}

}  // namespace adasplats
