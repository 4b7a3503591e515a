// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/rays/present_disks.h"

#include <algorithm>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

/// Points are prefetched this many rays ahead.
constexpr std::size_t kLoadedAhead = 16;

}  // namespace

PresentDisks::PresentDisks(std::span<const Disk> disks, const Executor& executor) {
  for (std::size_t i = 0; i < disks.size(); ++i) {
    if (!(disks[i].radius > 0)) continue;
    disks_.push_back(disks[i]);
    ids_.push_back(static_cast<std::uint32_t>(i));
  }
  tracer_ = make_cpu_tracer({disks_, nullptr}, executor);
}

void PresentDisks::for_batches(const MeasuredRays& rays, const RayCasting& casting,
                               const Executor& executor,
                               FunctionRef<void(const RayBatch& batch)> body) const {
  const std::size_t count = casting.numbers ? casting.numbers->size() : rays.size();
  if (empty() || count == 0) return;
  const auto number_of = [&](std::size_t k) { return casting.numbers ? (*casting.numbers)[k] : k; };
  const ProgressPass pass(executor, count);
  executor.for_chunks(count, kFineGrain, [&](std::size_t begin, std::size_t end) {
    RayBatch batch;
    batch.rays.reserve(end - begin);
    batch.ranges_m.reserve(end - begin);
    batch.numbers.reserve(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t number = number_of(k);
      if (k + kLoadedAhead < count) rays.prefetch(number_of(k + kLoadedAhead));
      batch.numbers.push_back(number);
      batch.rays.push_back(rays.ray(number, casting.reach));
      batch.ranges_m.push_back(rays.range_m(number));
    }
    body(batch);
  });
}

void PresentDisks::cast(const MeasuredRays& rays, const RayCasting& casting,
                        const Executor& executor, NearestBody body) const {
  const std::size_t depth = std::min(casting.depth, disks_.size());
  for_batches(rays, casting, executor, [&](const RayBatch& batch) {
    std::vector<Hit> hits(batch.rays.size() * depth);
    tracer_->nearest_hits(batch.rays, static_cast<int>(depth), hits, executor);
    body(batch, {hits, depth});
  });
}

void PresentDisks::cast_for_all(const MeasuredRays& rays, const RayCasting& casting,
                                const Executor& executor, HitsBody body) const {
  for_batches(rays, casting, executor, [&](const RayBatch& batch) {
    tracer_->all_hits(batch.rays, [&](std::span<const RayHit> hits) { body(batch, hits); });
  });
}

}  // namespace adasplats
