// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/rays/ray_check.h"

#include <atomic>
#include <vector>

#include "adasplats/splats/rays/present_disks.h"

namespace adasplats {
namespace {

template <class T>
void add(T& sum, T value) {
  std::atomic_ref<T>(sum).fetch_add(value, std::memory_order_relaxed);
}

}  // namespace

std::vector<ShiftSums> sum_shifts(std::span<const Disk> disks, const MeasuredRays& rays,
                                  const SettleOptions& options, const Executor& executor) {
  std::vector<ShiftSums> sums(disks.size());
  const PresentDisks present(disks, executor);
  const auto add_ray = [&](std::size_t, const Ray& ray, float range_m, std::span<const Hit> hits) {
    if (hits.empty()) return;
    const std::uint32_t id = hits[0].primitive;
    const ShiftSums part = shift_of_ray(disks[id], ray, hits[0].t, range_m, options);
    add(sums[id].weight, part.weight);
    add(sums[id].shift, part.shift);
    add(sums[id].rays, part.rays);
  };
  RayCasting casting;
  casting.reach = settling_reach(options);
  present.cast(rays, casting, executor, add_ray);
  return sums;
}

void settle_disks(std::span<Disk> disks, const MeasuredRays& rays, const SettleOptions& options,
                  const Executor& executor) {
  const std::vector<ShiftSums> sums = sum_shifts(disks, rays, options, executor);
  executor.for_chunks(disks.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) disks[i] = settled(disks[i], sums[i], options);
  });
}

}  // namespace adasplats
