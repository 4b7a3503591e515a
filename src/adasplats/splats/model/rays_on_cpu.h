// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/splats/model/cpu_backend.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/splats/rays/present_disks.h"
#include "adasplats/splats/reflectance/element_steps.h"

namespace adasplats {

/// A CpuBackend that casts measured rays.
class RaysOnCpu : public CpuBackend {
 public:
  using Rays = MeasuredRays;
  using CpuBackend::CpuBackend;

  /// Each calls what it is paired with for all of its rays, in any order.
  void observe(const std::vector<Disk>& disks,
               std::span<const std::pair<const MeasuredRays*, ObserveRay>> parts) const {
    RayCasting casting;
    casting.reach = {ObserveRay::kBeyond_m};
    const PresentDisks present(disks, executor());
    for (const auto& part : parts) {
      const auto look = [&](std::size_t i, const Ray& ray, float range_m,
                            std::span<const Hit> hits) {
        part.second(i, part.first->point(i), ray, range_m, hits.empty() ? Hit{} : hits[0]);
      };
      present.cast(*part.first, casting, executor(), look);
    }
  }
};

}  // namespace adasplats
