// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/surface_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace adasplats {
namespace {

constexpr std::size_t kGrain = 16384;

/// Where a point is as seen from a disk.
struct Place {
  float height_m;  ///< above or below the plane, not negative
  float along_m;   ///< from the middle, in the plane
};

Place place_of(const Disk& disk, Vec3f point) {
  const Vec3f offset = point - disk.center;
  const float height_m = dot(offset, disk.normal);
  return {std::fabs(height_m),
          std::sqrt(std::max(0.0F, dot(offset, offset) - height_m * height_m))};
}

/// How far seeds reach from a disk's middle in each of some equal sectors of its plane.
class SectorReach {
 public:
  SectorReach(const Disk& disk, int sectors) : center_(disk.center), reach_m_{}, sectors_(sectors) {
    if (sectors_ == 0) return;
    const Vec3f axis = std::fabs(disk.normal.z) < 0.9F ? Vec3f{0, 0, 1} : Vec3f{1, 0, 0};
    right_ = normalized(cross(disk.normal, axis));
    up_ = cross(disk.normal, right_);
  }

  void add(Vec3f point, float along_m) {
    if (sectors_ == 0) return;
    const Vec3f offset = point - center_;
    const float turn = std::atan2(dot(offset, up_), dot(offset, right_)) / (2 * kPi) + 0.5F;
    const int sector =
        std::clamp(static_cast<int>(turn * static_cast<float>(sectors_)), 0, sectors_ - 1);
    float& reach_m = reach_m_[static_cast<std::size_t>(sector)];
    reach_m = std::max(reach_m, along_m);
  }

  /// Of the sector with the least; without sectors there is no limit.
  float least_m() const {
    if (sectors_ == 0) return std::numeric_limits<float>::max();
    return *std::min_element(reach_m_.begin(), reach_m_.begin() + sectors_);
  }

  static constexpr int kMostSectors = 16;

 private:
  static constexpr float kPi = std::numbers::pi_v<float>;

  Vec3f center_, right_, up_;
  std::array<float, kMostSectors> reach_m_;
  int sectors_;
};

/// How far a disk reaches before the surface ends or turns away.
float grown_radius(std::span<const Disk> seeds, std::uint32_t seed, const NeighborList& neighbors,
                   const CoverOptions& options) {
  const Disk& disk = seeds[seed];
  const auto largest_m = static_cast<float>(options.largest_radius_m);
  // Two passes instead of a sort: first where it must end, then how far it reaches before that.
  float end_m = largest_m;
  const auto fits = [&](const Disk& other, const Place& place) {
    return static_cast<double>(place.height_m)<options.tolerance_m&& static_cast<double>(
        std::fabs(dot(other.normal, disk.normal)))>
        options.least_normal_cosine;
  };
  for (std::uint32_t k = 0; k < neighbors.size; ++k) {
    const Disk& other = seeds[neighbors.ranks[k]];
    if (!(other.radius > 0)) continue;
    const Place place = place_of(disk, other.center);
    if (!fits(other, place) && static_cast<double>(place.height_m) < options.edge_m) {
      end_m = std::min(end_m, place.along_m);
    }
  }
  float reach_m = disk.radius;
  SectorReach sectors(disk, options.sectors);
  for (std::uint32_t k = 0; k < neighbors.size; ++k) {
    const Disk& other = seeds[neighbors.ranks[k]];
    if (!(other.radius > 0)) continue;
    const Place place = place_of(disk, other.center);
    if (place.along_m < end_m && fits(other, place)) {
      reach_m = std::max(reach_m, place.along_m);
      sectors.add(other.center, place.along_m);
    }
  }
  return std::max(disk.radius, std::min(reach_m, sectors.least_m() + 0.5F * disk.radius));
}

}  // namespace

SurfaceCover::SurfaceCover(std::span<const Disk> seeds, const PointIndex& index,
                           const CoverOptions& options, const Executor& executor)
    : seeds_(seeds.begin(), seeds.end()),
      radii_m_(seeds.size()),
      overlap_(options.overlap),
      lists_((seeds.size() + PointIndex::kQueriesPerTask - 1) / PointIndex::kQueriesPerTask),
      begins_(seeds.size()),
      lengths_(seeds.size()) {
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return NeighborLimit{options.neighbors}; },
      [&](std::uint32_t seed, const NeighborList& neighbors) {
        auto& list = lists_[seed / PointIndex::kQueriesPerTask];
        begins_[seed] = static_cast<std::uint32_t>(list.size());
        if (!(seeds_[seed].radius > 0)) return;
        radii_m_[seed] = grown_radius(seeds_, seed, neighbors, options);
        const float covered_m = static_cast<float>(overlap_) * radii_m_[seed];
        for (std::uint32_t k = 0; k < neighbors.size; ++k) {
          const std::uint32_t other = neighbors.ranks[k];
          if (!(seeds_[other].radius > 0)) continue;
          const Place place = place_of(seeds_[seed], seeds_[other].center);
          if (place.along_m <= covered_m &&
              static_cast<double>(place.height_m) < options.covered_within_m) {
            list.push_back(other);
          }
        }
        lengths_[seed] = static_cast<std::uint32_t>(list.size()) - begins_[seed];
      });
}

std::span<const std::uint32_t> SurfaceCover::candidates(std::size_t i) const {
  return std::span(lists_[i / PointIndex::kQueriesPerTask]).subspan(begins_[i], lengths_[i]);
}

bool SurfaceCover::covers(std::size_t i, std::uint32_t other) const {
  return seeds_[other].radius > 0 && place_of(seeds_[i], seeds_[other].center).along_m <=
                                         static_cast<float>(overlap_) * radii_m_[i];
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
  for (const std::uint32_t i : order) {
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

void SurfaceCover::limit(std::size_t i, float radius_m) {
  radii_m_[i] = std::min(radii_m_[i], radius_m);
  seeds_[i].radius = std::min(seeds_[i].radius, radius_m);
}

}  // namespace adasplats
