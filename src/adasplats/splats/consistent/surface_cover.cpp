// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/surface_cover.h"

#include <algorithm>
#include <cmath>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

/// A seed near a disk.
struct NearSeed {
  std::uint32_t seed;
  DiskOffset place;
  bool grows_over;  ///< the disk may grow over it
};

/// The neighbours that are seeds of surfaces.
void find_near(std::span<const Disk> seeds, const Disk& disk, const NeighborList& neighbors,
               const CoverOptions& options, std::vector<NearSeed>& near) {
  near.clear();
  for (std::uint32_t k = 0; k < neighbors.size; ++k) {
    const std::uint32_t seed = neighbors.ranks[k];
    const Disk& other = seeds[seed];
    if (!(other.radius > 0)) continue;
    const DiskOffset place = disk_offset(disk, other.center);
    near.push_back({seed, place, grows_over(disk, other, place, options)});
  }
}

/// The radius up to which a disk can grow before the surface ends or bends.
float radius_grown(std::span<const Disk> seeds, const Disk& disk, std::span<const NearSeed> near,
                   int sector_count, const CoverOptions& options) {
  // Two passes instead of a sort: the distance where it must end, then its reach before that.
  auto end_m = static_cast<float>(options.largest_radius_m);
  for (const NearSeed& other : near)
    if (ends_at(other.place, other.grows_over, options))
      end_m = std::min(end_m, other.place.along_m);
  float reach_m = disk.radius;
  SectorReach sectors(disk, sector_count);
  for (const NearSeed& other : near) {
    if (!other.grows_over || !(other.place.along_m < end_m)) continue;
    reach_m = std::max(reach_m, other.place.along_m);
    sectors.add(seeds[other.seed].center, other.place.along_m);
  }
  return grown_radius(disk, reach_m, sectors);
}

/// The largest distance of a seed from its point of the index: seeds are on planes near the points.
double largest_shift(std::span<const Disk> seeds, const PointIndex& index) {
  const PointIndex::Tree tree = index.tree();
  float largest2 = 0;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Vec3f shift = seeds[i].center - Vec3f{tree.coordinates[0][i], tree.coordinates[1][i],
                                                tree.coordinates[2][i]};
    if (seeds[i].radius > 0) largest2 = std::max(largest2, dot(shift, shift));
  }
  return std::sqrt(static_cast<double>(largest2));
}

}  // namespace

SurfaceCover::SurfaceCover(std::span<const Disk> seeds, const PointIndex& index,
                           const CoverOptions& options, const Executor& executor,
                           std::span<const std::uint8_t> unchecked)
    : seeds_(seeds.begin(), seeds.end()),
      radii_m_(seeds.size()),
      overlap_(options.overlap),
      lists_((seeds.size() + PointIndex::kQueriesPerTask - 1) / PointIndex::kQueriesPerTask),
      begins_(seeds.size()),
      lengths_(seeds.size()) {
  const ProgressPass pass(executor, seeds.size());
  const double largest_shift_m = largest_shift(seeds_, index);
  index.for_each_neighborhood(
      executor,
      [&](std::uint32_t seed) {
        const auto reach_m =
            static_cast<float>(options.reach_m(seeds_[seed].radius) + 2 * largest_shift_m);
        return NeighborLimit{options.neighbors, reach_m * reach_m};
      },
      [&](std::uint32_t seed, const NeighborList& neighbors) {
        auto& list = lists_[seed / PointIndex::kQueriesPerTask];
        begins_[seed] = static_cast<std::uint32_t>(list.size());
        if (!(seeds_[seed].radius > 0)) return;
        const bool is_unchecked = !unchecked.empty() && unchecked[seed] != 0;
        const int sectors = is_unchecked ? options.unchecked_sectors : options.sectors;
        thread_local std::vector<NearSeed> near;  // reused memory
        find_near(seeds_, seeds_[seed], neighbors, options, near);
        radii_m_[seed] = radius_grown(seeds_, seeds_[seed], near, sectors, options);
        const float covered_m = covered_reach(overlap_, radii_m_[seed]);
        for (const NearSeed& other : near)
          if (may_cover(other.place, covered_m, options)) list.push_back(other.seed);
        lengths_[seed] = static_cast<std::uint32_t>(list.size()) - begins_[seed];
      });
}

std::span<const std::uint32_t> SurfaceCover::candidates(std::size_t i) const {
  return std::span(lists_[i / PointIndex::kQueriesPerTask]).subspan(begins_[i], lengths_[i]);
}

bool SurfaceCover::covers(std::size_t i, std::uint32_t other) const {
  return seeds_[other].radius > 0 && disk_offset(seeds_[i], seeds_[other].center).along_m <=
                                         covered_reach(overlap_, radii_m_[i]);
}

std::vector<Disk> SurfaceCover::choose(const Executor& executor) const {
  std::vector<std::uint64_t> keys(seeds_.size());
  executor.for_chunks(seeds_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::uint64_t count = 0;
      for (const std::uint32_t other : candidates(i)) count += covers(i, other) ? 1 : 0;
      keys[i] = ~std::uint64_t{0} - count;
    }
  });
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);

  std::vector<Disk> chosen(seeds_.size());
  std::vector<bool> covered(seeds_.size());
  std::size_t visited = 0;
  for (const std::uint32_t i : order) {
    if (++visited % kGrain == 0) executor.check_interruption();
    if (!(seeds_[i].radius > 0) || covered[i]) continue;
    chosen[i] = seeds_[i];
    chosen[i].radius = radii_m_[i];
    covered[i] = true;
    for (const std::uint32_t other : candidates(i)) {
      if (covers(i, other)) covered[other] = true;
    }
  }
  return chosen;
}

}  // namespace adasplats
