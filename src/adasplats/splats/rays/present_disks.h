// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/rays/measured_ray.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Which measured rays are cast, and how.
struct RayCasting {
  std::optional<std::span<const std::uint32_t>> numbers;  ///< indices of the rays; nullopt: all
  RayReach reach;
  std::size_t depth = 1;  ///< maximum number of nearest hits
};

/// Measured rays that are cast together, few enough for a core's cache.
struct RayBatch {
  std::vector<Ray> rays;
  std::vector<float> ranges_m;  ///< measured
  std::vector<std::size_t> numbers;
};

/// The nearest hits of the rays of a batch. Primitives are those of the tracer.
struct NearestHits {
  std::span<const Hit> all;  ///< `depth` slots per ray
  std::size_t depth = 1;

  /// Those of one ray, in ascending order.
  std::span<const Hit> of(std::size_t ray) const {
    const auto slots = all.subspan(ray * depth, depth);
    std::size_t found = 0;
    while (found < depth && slots[found].valid()) ++found;
    return slots.first(found);
  }
};

/// A tracer for the disks that have a radius.
class PresentDisks {
 public:
  PresentDisks(std::span<const Disk> disks, const Executor& executor);

  bool empty() const { return disks_.empty(); }
  std::span<const Disk> disks() const { return disks_; }  ///< in the tracer's order
  /// The disk of a primitive of the tracer, and its index among all disks.
  const Disk& disk(std::uint32_t primitive) const { return disks_[primitive]; }
  std::uint32_t id(std::uint32_t primitive) const { return ids_[primitive]; }

  /// Calls body(batch, hits) with the nearest hits of all rays, batch by batch, in any order and on
  /// any thread. Does nothing without disks.
  using NearestBody = FunctionRef<void(const RayBatch& batch, const NearestHits& hits)>;
  void cast(const MeasuredRays& rays, const RayCasting& casting, const Executor& executor,
            NearestBody body) const;

  /// Calls body(batch, hits) with all hits, group by group, in any order and on any thread. The
  /// `ray` of a hit is its index in the batch.
  using HitsBody = FunctionRef<void(const RayBatch& batch, std::span<const RayHit> hits)>;
  void cast_for_all(const MeasuredRays& rays, const RayCasting& casting, const Executor& executor,
                    HitsBody body) const;

 private:
  void for_batches(const MeasuredRays& rays, const RayCasting& casting, const Executor& executor,
                   FunctionRef<void(const RayBatch& batch)> body) const;

  std::vector<Disk> disks_;
  std::vector<std::uint32_t> ids_;  ///< indices of the disks among all
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace adasplats
