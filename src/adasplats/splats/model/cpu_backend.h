// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/cpu_arrays.h"
#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/splats/rays/present_disks.h"
#include "adasplats/splats/reflectance/element_steps.h"

namespace adasplats {

/// Runs the steps of a method on the threads of the CPU and keeps their arrays in its memory.
/// gpu::GpuBackend is the GPU counterpart; the steps are templates on the backend.
class CpuBackend : public CpuArrays {
 public:
  using Cloud = PointCloud;

  using CpuArrays::CpuArrays;

  CurveBox box_of(const PointCloud& cloud) const {
    return curve_box_of(cloud.positions, executor());
  }
  PointCloud load(const PointCloud& cloud, const CurveBox& box,
                  std::span<const std::uint8_t> removed) const {
    return load_in_order(cloud, box, removed, executor());
  }
  PointCloud load(const PointCloud& cloud, std::span<const std::uint8_t> removed) const {
    return load(cloud, box_of(cloud), removed);
  }
  /// Keeps the order of the points.
  static PointCloud load_in_given_order(PointCloud cloud) { return cloud; }
  using CpuArrays::gather;
  PointCloud gather(const PointCloud& cloud, std::span<const std::uint32_t> at) const {
    return adasplats::gather(cloud, at);
  }
};

/// A CpuBackend that also casts measured rays.
class RaysOnCpu : public CpuBackend {
 public:
  using Rays = MeasuredRays;
  using CpuBackend::CpuBackend;

  /// Calls every ObserveRay for all of the rays that it is paired with, in any order.
  void observe(const std::vector<Disk>& disks,
               std::span<const std::pair<const MeasuredRays*, ObserveRay>> parts) const {
    RayCasting casting;
    casting.reach = {ObserveRay::kBeyond_m};
    const PresentDisks present(disks, executor());
    for (const auto& part : parts) {
      const auto look = [&](const RayBatch& batch, const NearestHits& hits) {
        for (std::size_t i = 0; i < batch.rays.size(); ++i) {
          Hit hit = hits.all[i];
          if (hit.valid()) hit.primitive = present.id(hit.primitive);
          const std::size_t number = batch.numbers[i];
          part.second(number, part.first->point(number), batch.rays[i], batch.ranges_m[i], hit);
        }
      };
      present.cast(*part.first, casting, executor(), look);
    }
  }
};

}  // namespace adasplats
