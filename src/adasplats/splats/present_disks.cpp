// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/present_disks.h"

#include <algorithm>

namespace adasplats {
namespace {

constexpr std::size_t kGrain = 16384;
constexpr std::size_t kRaysAtOnce = std::size_t{1} << 17;

}  // namespace

PresentDisks::PresentDisks(std::span<const Disk> disks, const Executor& executor) {
  for (std::size_t i = 0; i < disks.size(); ++i) {
    if (!(disks[i].radius > 0)) continue;
    disks_.push_back(disks[i]);
    ids_.push_back(static_cast<std::uint32_t>(i));
  }
  tracer_ = make_cpu_tracer({disks_, nullptr}, executor);
}

void PresentDisks::cast(
    const MeasuredRays& rays, const RayCasting& casting, const Executor& executor,
    FunctionRef<void(std::size_t, const Ray&, std::span<const Hit>)> body) const {
  if (empty()) return;
  const auto depth = static_cast<std::size_t>(casting.depth);
  std::vector<Ray> batch;
  std::vector<Hit> hits;
  for (std::size_t first = casting.first; first < rays.size();
       first += kRaysAtOnce * casting.stride) {
    const auto index = [&](std::size_t k) { return first + k * casting.stride; };
    const std::size_t left = (rays.size() - first + casting.stride - 1) / casting.stride;
    batch.resize(std::min(kRaysAtOnce, left));
    hits.assign(batch.size() * depth, Hit{});
    executor.for_chunks(batch.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) batch[k] = rays.ray(index(k), casting.beyond_m);
    });
    if (depth == 1) {
      tracer_->nearest(batch, hits, executor);
    } else {
      tracer_->nearest_hits(batch, casting.depth, hits, executor);
    }
    executor.for_chunks(batch.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const auto all = std::span(hits).subspan(k * depth, depth);
        std::size_t found = 0;
        for (; found < depth && all[found].valid(); ++found) {
          all[found].primitive = ids_[all[found].primitive];
        }
        body(index(k), batch[k], all.first(found));
      }
    });
  }
}

}  // namespace adasplats
