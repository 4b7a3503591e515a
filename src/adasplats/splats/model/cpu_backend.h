// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/cpu_arrays.h"
#include "adasplats/splats/model/canonical_order.h"

namespace adasplats {

/// Where the steps of a method run and what they keep is: the threads and the memory of the CPU.
/// gpu::GpuBackend is its twin; the steps are written once, as templates on the place.
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
  /// In no other order.
  static PointCloud load_as_it_is(PointCloud cloud) { return cloud; }
  using CpuArrays::gather;
  PointCloud gather(const PointCloud& cloud, std::span<const std::uint32_t> at) const {
    return adasplats::gather(cloud, at);
  }
};

}  // namespace adasplats
