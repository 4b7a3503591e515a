// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/rays/present_disks.h"

#include <algorithm>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

constexpr std::size_t kRaysAtOnce = std::size_t{1} << 17;
/// Most rays cross fewer disks; those that do not are cast again for several times as many.
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

/// Some rays with their numbers.
struct PresentDisks::Batch {
  std::vector<Ray> rays;
  std::vector<std::size_t> numbers;
};

void PresentDisks::cast(const Batch& batch, std::size_t depth, bool all, const Executor& executor,
                        Body body) const {
  std::vector<Hit> hits(batch.rays.size() * depth);
  tracer_->nearest_hits(batch.rays, static_cast<int>(depth), hits, executor);
  // No ray has more hits than there are disks.
  const bool may_be_cut = all && depth < disks_.size();
  executor.for_chunks(batch.rays.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto own = std::span(hits).subspan(k * depth, depth);
      if (may_be_cut && own.back().valid()) continue;
      std::size_t found = 0;
      for (; found < depth && own[found].valid(); ++found) {
        own[found].primitive = ids_[own[found].primitive];
      }
      body(batch.numbers[k], batch.rays[k], own.first(found));
    }
  });
  if (!may_be_cut) return;

  const std::size_t more = std::min(kTimesAsMany * depth, disks_.size());
  const std::size_t most = std::max<std::size_t>(1, kRaysAtOnce * kHitsAtFirst / more);
  Batch again;
  for (std::size_t k = 0; k < batch.rays.size(); ++k) {
    if (hits[k * depth + depth - 1].valid()) {
      again.rays.push_back(batch.rays[k]);
      again.numbers.push_back(batch.numbers[k]);
    }
    if (again.rays.size() == most || k + 1 == batch.rays.size()) {
      if (!again.rays.empty()) cast(again, more, all, executor, body);
      again = {};
    }
  }
}

void PresentDisks::cast(const MeasuredRays& rays, const RayCasting& casting,
                        const Executor& executor, Body body) const {
  if (empty()) return;
  const bool all = casting.hits == RayCasting::Hits::all;
  // Each ray is made, cast and looked at: three loops.
  const ProgressPass pass(executor, 3 * (rays.size() / casting.stride + 1));
  Batch batch;
  for (std::size_t first = casting.first; first < rays.size();
       first += kRaysAtOnce * casting.stride) {
    const std::size_t left = (rays.size() - first + casting.stride - 1) / casting.stride;
    batch.rays.resize(std::min(kRaysAtOnce, left));
    batch.numbers.resize(batch.rays.size());
    executor.for_chunks(batch.rays.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        batch.numbers[k] = first + k * casting.stride;
        batch.rays[k] = rays.ray(batch.numbers[k], casting.beyond_m);
      }
    });
    cast(batch, all ? std::min(kHitsAtFirst, disks_.size()) : 1, all, executor, body);
  }
}

}  // namespace adasplats
