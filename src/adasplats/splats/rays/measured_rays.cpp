// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/rays/measured_rays.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "adasplats/splats/rays/measured_ray.h"
#include "adasplats/splats/rays/present_disks.h"

namespace adasplats {
namespace {

void count_one(std::uint32_t& counter) {
  std::atomic_ref<std::uint32_t>(counter).fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

MeasuredRays::MeasuredRays(const PointCloud& cloud, double least_range_m, const Executor& executor,
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
           !has_measured_ray(cloud.sensor_positions[i], cloud.positions[i], least_range_m);
  });
}

float MeasuredRays::range_m(std::size_t i) const {
  if (ends_ == RayEnds::nowhere) return std::numeric_limits<float>::infinity();
  const std::uint32_t point = points_[i];
  return length(cloud_.positions[point] - cloud_.sensor_positions[point]);
}

Ray MeasuredRays::ray(std::size_t i, float beyond_m) const {
  const std::uint32_t point = points_[i];
  return measured_ray(cloud_.sensor_positions[point], cloud_.positions[point], beyond_m);
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
  constexpr std::size_t kFarther = 20;  // one in so many
  std::vector<float> ranges_m;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (is_beam(cloud.origin_kind(i)))
      ranges_m.push_back(length(cloud.positions[i] - cloud.sensor_positions[i]));
  if (ranges_m.empty()) return 0;
  const auto reach = ranges_m.end() - 1 - static_cast<std::ptrdiff_t>(ranges_m.size() / kFarther);
  std::nth_element(ranges_m.begin(), reach, ranges_m.end());
  return *reach;
}

DiskEvidence evidence_of(const RayEvidence& evidence, std::size_t disk) {
  const auto part = [disk](const std::vector<std::uint32_t>& counts) {
    return std::span(counts).subspan(disk * RayEvidence::kBins, RayEvidence::kBins);
  };
  return {part(evidence.confirmed), part(evidence.contradicted)};
}

RayEvidence collect_evidence(std::span<const Disk> disks, const MeasuredRays& rays,
                             const EvidenceOptions& options, const Executor& executor,
                             const MeasuredRays* empty) {
  RayEvidence evidence;
  evidence.confirmed.resize(disks.size() * RayEvidence::kBins);
  evidence.contradicted.resize(disks.size() * RayEvidence::kBins);
  const PresentDisks present(disks, executor);
  const auto count_rays = [&](const MeasuredRays& cast) {
    const auto count = [&](std::size_t, const Ray& ray, float range_m, std::span<const Hit> hits) {
      thread_local std::vector<std::uint32_t*> counters;  // its memory is used again
      counters.clear();
      for (const Hit& hit : hits) {
        const Disk& disk = disks[hit.primitive];
        const RayWord word = word_of_ray(disk, ray, hit.t, range_m, options);
        if (word == RayWord::nothing) continue;
        const std::size_t bin = evidence_ring(disk, ray, hit.t);
        auto& counts = word == RayWord::confirms ? evidence.confirmed : evidence.contradicted;
        std::uint32_t& counter =
            counts[static_cast<std::size_t>(hit.primitive) * RayEvidence::kBins + bin];
        __builtin_prefetch(&counter, 1);
        counters.push_back(&counter);
      }
      // Apart: where an atomic operation stands between them, loads do not overlap.
      for (std::uint32_t* counter : counters) count_one(*counter);
    };
    const float beyond_m = cast.ends() == RayEnds::nowhere ? 0 : options.most_margin_m();
    present.cast(cast, {options.phase, options.stride, beyond_m, RayCasting::Hits::all}, executor,
                 count);
  };
  count_rays(rays);
  if (empty != nullptr) count_rays(*empty);
  return evidence;
}

}  // namespace adasplats
