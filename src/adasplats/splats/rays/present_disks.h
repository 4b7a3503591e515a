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
  enum class Hits : std::uint8_t { nearest, all } hits = Hits::nearest;
  std::size_t depth = 1;  ///< maximum number of nearest hits
};

/// A tracer for the disks that have a radius.
class PresentDisks {
 public:
  PresentDisks(std::span<const Disk> disks, const Executor& executor);

  bool empty() const { return disks_.empty(); }

  /// Calls body(i, ray, range_m, hits) once for each ray, in any order and on any thread. `hits`
  /// are the hits of ray i (with the measured range `range_m`) in ascending order; their primitives
  /// are indices of disks. Does nothing without disks.
  using Body =
      FunctionRef<void(std::size_t i, const Ray& ray, float range_m, std::span<const Hit> hits)>;
  void cast(const MeasuredRays& rays, const RayCasting& casting, const Executor& executor,
            Body body) const;

 private:
  struct Batch;
  void cast(Batch& batch, std::size_t depth, bool all, const Executor& executor, Body body) const;

  std::vector<Disk> disks_;
  std::vector<std::uint32_t> ids_;  ///< indices of the disks among all
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace adasplats
