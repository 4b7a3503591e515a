// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/rays/present_disks.h"

#include <algorithm>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

/// Points are prefetched this many rays ahead.
constexpr std::size_t kLoadedAhead = 16;
/// Most rays cross fewer disks; the others are cast again with several times as many hits.
constexpr std::size_t kHitsAtFirst = 48, kTimesAsMany = 4;

}  // namespace

PresentDisks::PresentDisks(std::span<const Disk> disks, const Executor& executor) {
  for (std::size_t i = 0; i < disks.size(); ++i) {
    if (!(disks[i].radius > 0)) continue;
    disks_.push_back(disks[i]);
    ids_.push_back(static_cast<std::uint32_t>(i));
  }
  tracer_ = make_cpu_tracer({disks_, nullptr}, executor);
}

/// A batch of rays with their indices and hits, small enough for a core's cache.
struct PresentDisks::Batch {
  std::vector<Ray> rays;
  std::vector<float> ranges_m;
  std::vector<std::size_t> numbers;
  std::vector<Hit> hits;
};

void PresentDisks::cast(Batch& batch, std::size_t depth, bool all, const Executor& executor,
                        Body body) const {
  batch.hits.resize(batch.rays.size() * depth);
  tracer_->nearest_hits(batch.rays, static_cast<int>(depth), batch.hits, executor);
  // No ray has more hits than there are disks.
  const bool may_be_cut = all && depth < disks_.size();
  Batch again;
  for (std::size_t k = 0; k < batch.rays.size(); ++k) {
    const auto own = std::span(batch.hits).subspan(k * depth, depth);
    if (may_be_cut && own.back().valid()) {
      again.rays.push_back(batch.rays[k]);
      again.ranges_m.push_back(batch.ranges_m[k]);
      again.numbers.push_back(batch.numbers[k]);
      continue;
    }
    std::size_t found = 0;
    for (; found < depth && own[found].valid(); ++found)
      own[found].primitive = ids_[own[found].primitive];
    body(batch.numbers[k], batch.rays[k], batch.ranges_m[k], own.first(found));
  }
  if (again.rays.empty()) return;

  const std::size_t more = std::min(kTimesAsMany * depth, disks_.size());
  const std::size_t batch_size = std::max<std::size_t>(1, kFineGrain * kHitsAtFirst / more);
  Batch part;
  for (std::size_t begin = 0; begin < again.rays.size(); begin += batch_size) {
    const std::size_t size = std::min(batch_size, again.rays.size() - begin);
    const auto part_of = [&](const auto& values) { return std::span(values).subspan(begin, size); };
    part.rays.assign(part_of(again.rays).begin(), part_of(again.rays).end());
    part.ranges_m.assign(part_of(again.ranges_m).begin(), part_of(again.ranges_m).end());
    part.numbers.assign(part_of(again.numbers).begin(), part_of(again.numbers).end());
    cast(part, more, all, executor, body);
  }
}

void PresentDisks::cast(const MeasuredRays& rays, const RayCasting& casting,
                        const Executor& executor, Body body) const {
  const std::size_t count = casting.numbers ? casting.numbers->size() : rays.size();
  if (empty() || count == 0) return;
  const auto number_of = [&](std::size_t k) { return casting.numbers ? (*casting.numbers)[k] : k; };
  const bool all = casting.hits == RayCasting::Hits::all;
  const std::size_t depth = std::min(all ? kHitsAtFirst : casting.depth, disks_.size());
  const ProgressPass pass(executor, count);
  executor.for_chunks(count, kFineGrain, [&](std::size_t begin, std::size_t end) {
    Batch batch;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t number = number_of(k);
      if (k + kLoadedAhead < count) rays.prefetch(number_of(k + kLoadedAhead));
      batch.numbers.push_back(number);
      batch.rays.push_back(rays.ray(number, casting.reach));
      batch.ranges_m.push_back(rays.range_m(number));
    }
    cast(batch, depth, all, executor, body);
  });
}

}  // namespace adasplats
