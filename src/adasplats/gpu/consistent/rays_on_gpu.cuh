// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

#include "adasplats/gpu/consistent/consistent_rays.h"
#include "adasplats/gpu/neighbors/gpu_backend.cuh"
#include "adasplats/splats/reflectance/element_steps.h"

namespace adasplats::gpu {

/// Private to gpu/: a GpuBackend that casts measured rays, like RaysOnCpu.
class RaysOnGpu : public GpuBackend {
 public:
  using Rays = DeviceRays;
  using GpuBackend::GpuBackend;

  void observe(const DeviceBuffer<Disk>& disks,
               std::span<const std::pair<const DeviceRays*, ObserveRay>> parts) const {
    for (const auto& [rays, observe] : parts) rays->observe(disks.data(), disks.size(), observe);
  }
};

}  // namespace adasplats::gpu
