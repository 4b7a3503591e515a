// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/rays/measured_rays.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

#include "adasplats/splats/rays/combined_sums.h"
#include "adasplats/splats/rays/present_disks.h"

namespace adasplats {
MeasuredRays::MeasuredRays(const PointCloud& cloud, double min_range_m, const Executor& executor,
                           RayEnds ends)
    : cloud_(cloud), ends_(ends) {
  std::vector<std::uint64_t> keys(cloud.size());
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      keys[i] = measured_ray_key(cloud.sensor_positions[i], cloud.positions[i]);
    }
  });
  executor.sort_keys(keys, points_);
  std::erase_if(points_, [&](std::uint32_t i) {
    return !is_beam(cloud.origin_kind(i)) ||
           !has_measured_ray(cloud.sensor_positions[i], cloud.positions[i], min_range_m);
  });
  order_by_part(executor);
}

void MeasuredRays::order_by_part(const Executor& executor) {
  std::vector<std::uint8_t> parts(size());
  executor.for_chunks(size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      parts[i] = static_cast<std::uint8_t>(
          ray_part(cloud_.sensor_positions[points_[i]], cloud_.positions[points_[i]]));
    }
  });
  for (const std::uint8_t part : parts) ++begins_.at[part + 1];
  for (std::uint32_t part = 0; part < kRayParts; ++part) begins_.at[part + 1] += begins_.at[part];
  std::array<std::size_t, kRayParts> next{};
  std::copy_n(std::begin(begins_.at), kRayParts, next.begin());
  by_part_.resize(size());
  for (std::size_t i = 0; i < size(); ++i)
    by_part_[next[parts[i]]++] = static_cast<std::uint32_t>(i);
}

float MeasuredRays::range_m(std::size_t i) const {
  if (ends_ == RayEnds::nowhere) return std::numeric_limits<float>::infinity();
  const std::uint32_t point = points_[i];
  return length(cloud_.positions[point] - cloud_.sensor_positions[point]);
}

Ray MeasuredRays::ray(std::size_t i, RayReach reach) const {
  const std::uint32_t point = points_[i];
  return measured_ray(cloud_.sensor_positions[point], cloud_.positions[point], reach);
}

PointCloud ends_of(const std::vector<EmptyBeam>& beams, float reach_m) {
  PointCloud ends;
  ends.positions.reserve(beams.size());
  ends.sensor_positions.reserve(beams.size());
  for (const EmptyBeam& beam : beams) {
    ends.positions.push_back(beam.origin + reach_m * beam.direction);
    ends.sensor_positions.push_back(beam.origin);
  }
  return ends;
}

float empty_reach_m(const PointCloud& cloud) {
  RangeCounts counts;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (is_beam(cloud.origin_kind(i)))
      counts.add(length(cloud.positions[i] - cloud.sensor_positions[i]));
  return counts.empty_reach_m();
}

float farthest_m(const PointCloud& cloud) {
  float farthest = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (is_beam(cloud.origin_kind(i)))
      farthest = std::max(farthest, length(cloud.positions[i] - cloud.sensor_positions[i]));
  return farthest;
}

void RangeCounts::add(float range_m) {
  const auto cm = static_cast<std::size_t>(std::min(range_m, kMax_m) / kUnit_m);
  if (cm >= counts_.size()) counts_.resize(cm + 1);
  ++counts_[cm];
  ++all_;
}

void RangeCounts::add(const RangeCounts& other) {
  counts_.resize(std::max(counts_.size(), other.counts_.size()));
  for (std::size_t cm = 0; cm < other.counts_.size(); ++cm) counts_[cm] += other.counts_[cm];
  all_ += other.all_;
}

float RangeCounts::empty_reach_m() const {
  constexpr std::uint64_t kFarther = 20;  // one in 20 is farther
  std::uint64_t beyond = all_ / kFarther;
  for (std::size_t cm = counts_.size(); cm-- > 0;) {
    if (counts_[cm] > beyond) return static_cast<float>(cm) * kUnit_m;
    beyond -= counts_[cm];
  }
  return 0;
}

DiskEvidence evidence_of(const RayEvidence& evidence, std::size_t disk) {
  const auto part = [disk](const std::vector<std::uint32_t>& counts) {
    return std::span(counts).subspan(disk * RayEvidence::kBins, RayEvidence::kBins);
  };
  return {part(evidence.confirmed), part(evidence.contradicted)};
}

RayEvidence collect_evidence(std::span<const Disk> disks, std::span<const MeasuredRays* const> rays,
                             const EvidenceOptions& options, const Executor& executor) {
  RayEvidence evidence;
  evidence.confirmed.resize(disks.size() * RayEvidence::kBins);
  evidence.contradicted.resize(disks.size() * RayEvidence::kBins);
  const PresentDisks present(disks, executor);
  const auto count = [&](const RayBatch& batch, std::span<const RayHit> hits) {
    CombinedSums<std::uint32_t, 2048, decltype(&add_relaxed<std::uint32_t>)> sums(
        &add_relaxed<std::uint32_t>);
    for (const RayHit& found : hits) {
      const Disk& disk = present.disk(found.hit.primitive);
      const Ray& ray = batch.rays[found.ray];
      const RayVerdict word =
          verdict_of_ray(disk, ray, found.hit.t, batch.ranges_m[found.ray], options);
      if (word == RayVerdict::nothing) continue;
      const std::size_t counter =
          std::size_t{present.id(found.hit.primitive)} * RayEvidence::kBins +
          evidence_ring(disk, ray, found.hit.t);
      auto& counts = word == RayVerdict::confirms ? evidence.confirmed : evidence.contradicted;
      sums.add(&counts[counter], counter, 1);
    }
  };
  for (const MeasuredRays* cast : rays) {
    const float beyond_m = cast->ends() == RayEnds::nowhere ? 0 : options.max_margin_m();
    RayCasting casting;
    casting.reach = {beyond_m};
    if (options.parts > 1) casting.numbers = cast->part(options.parts, options.part);
    present.cast_for_all(*cast, casting, executor, count);
  }
  return evidence;
}

std::vector<ShiftSums> sum_shifts(std::span<const Disk> disks, const MeasuredRays& rays,
                                  const SettleOptions& options, const Executor& executor) {
  std::vector<ShiftSums> sums(disks.size());
  const PresentDisks present(disks, executor);
  const auto add_rays = [&](const RayBatch& batch, const NearestHits& hits) {
    for (std::size_t i = 0; i < batch.rays.size(); ++i) {
      const Hit& hit = hits.all[i];
      if (!hit.valid()) continue;
      const std::uint32_t id = present.id(hit.primitive);
      const ShiftSums part = shift_of_ray(present.disk(hit.primitive), batch.rays[i], hit.t,
                                          batch.ranges_m[i], options);
      add_relaxed(sums[id].weight, part.weight);
      add_relaxed(sums[id].shift, part.shift);
      add_relaxed(sums[id].rays, part.rays);
    }
  };
  RayCasting casting;
  casting.reach = settling_reach(options);
  present.cast(rays, casting, executor, add_rays);
  return sums;
}

std::vector<ExtentSums> sum_extents(std::span<const Disk> disks,
                                    std::span<const DiskExtent> extents,
                                    std::span<const MeasuredRays* const> rays,
                                    const ExtentOptions& options, const Executor& executor) {
  const PresentDisks present(disks, executor);
  std::vector<DiskExtent> of_present;
  of_present.reserve(present.disks().size());
  for (std::uint32_t k = 0; k < present.disks().size(); ++k)
    of_present.push_back(extents[present.id(k)]);
  std::vector<ExtentSums> sums(of_present.size());
  const auto add_to = [](ExtentSums& sum, const ExtentSums& part) {
    add_relaxed(sum.opacity, part.opacity);
    add_relaxed(sum.opacity_weight, part.opacity_weight);
    add_relaxed(sum.scale, part.scale);
    add_relaxed(sum.scale_weight, part.scale_weight);
  };
  const auto add_rays = [&](const RayBatch& batch, const NearestHits& hits) {
    CombinedSums<ExtentSums, 1024, decltype(add_to)> combined(add_to);
    for (std::size_t i = 0; i < batch.rays.size(); ++i)
      add_extents_of_ray(present.disks().data(), of_present.data(), batch.rays[i],
                         batch.ranges_m[i], hits.of(i), options,
                         [&](std::uint32_t disk, const ExtentSums& part) {
                           combined.add(&sums[disk], disk, part);
                         });
  };
  for (const MeasuredRays* cast : rays) {
    RayCasting casting;
    casting.reach = {cast->ends() == RayEnds::nowhere ? 0 : options.beyond_m};
    casting.depth = kExtentHits;
    if (options.parts > 1) casting.numbers = cast->part(options.parts, options.part);
    present.cast(*cast, casting, executor, add_rays);
  }
  std::vector<ExtentSums> of_all(disks.size());
  for (std::uint32_t k = 0; k < sums.size(); ++k) of_all[present.id(k)] = sums[k];
  return of_all;
}

}  // namespace adasplats
