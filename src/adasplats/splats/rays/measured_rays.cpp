// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/rays/measured_rays.h"

#include <atomic>

#include "adasplats/splats/rays/measured_ray.h"
#include "adasplats/splats/rays/present_disks.h"

namespace adasplats {
namespace {

void count_one(std::uint32_t& counter) {
  std::atomic_ref<std::uint32_t>(counter).fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

MeasuredRays::MeasuredRays(const PointCloud& cloud, double least_range_m, const Executor& executor)
    : cloud_(cloud) {
  std::vector<std::uint64_t> keys(cloud.size());
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      keys[i] = measured_ray_key(cloud.sensor_positions[i], cloud.positions[i]);
    }
  });
  executor.sort_keys(keys, points_);
  std::erase_if(points_, [&](std::uint32_t i) {
    return !is_beam(cloud.origin_kind(i)) ||
           !has_measured_ray(cloud.sensor_positions[i], cloud.positions[i], least_range_m);
  });
}

float MeasuredRays::range_m(std::size_t i) const {
  const std::uint32_t point = points_[i];
  return length(cloud_.positions[point] - cloud_.sensor_positions[point]);
}

Ray MeasuredRays::ray(std::size_t i, float beyond_m) const {
  const std::uint32_t point = points_[i];
  return measured_ray(cloud_.sensor_positions[point], cloud_.positions[point], beyond_m);
}

DiskEvidence evidence_of(const RayEvidence& evidence, std::size_t disk) {
  const auto part = [disk](const std::vector<std::uint32_t>& counts) {
    return std::span(counts).subspan(disk * RayEvidence::kBins, RayEvidence::kBins);
  };
  return {part(evidence.confirmed), part(evidence.contradicted)};
}

RayEvidence collect_evidence(std::span<const Disk> disks, const MeasuredRays& rays,
                             const EvidenceOptions& options, const Executor& executor) {
  RayEvidence evidence;
  evidence.confirmed.resize(disks.size() * RayEvidence::kBins);
  evidence.contradicted.resize(disks.size() * RayEvidence::kBins);
  const PresentDisks present(disks, executor);
  const float beyond_m = options.most_margin_m();
  const auto count = [&](std::size_t i, const Ray& ray, std::span<const Hit> hits) {
    const float range_m = rays.range_m(i);
    for (const Hit& hit : hits) {
      const Disk& disk = disks[hit.primitive];
      const RayWord word = word_of_ray(disk, ray, hit.t, range_m, options);
      if (word == RayWord::nothing) continue;
      const std::size_t bin = evidence_ring(disk, ray, hit.t);
      auto& counts = word == RayWord::confirms ? evidence.confirmed : evidence.contradicted;
      count_one(counts[static_cast<std::size_t>(hit.primitive) * RayEvidence::kBins + bin]);
    }
  };
  present.cast(rays, {options.phase, options.stride, beyond_m, RayCasting::Hits::all}, executor,
               count);
  return evidence;
}

}  // namespace adasplats
