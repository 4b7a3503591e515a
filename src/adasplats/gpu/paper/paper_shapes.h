// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/gpu/neighbors/neighborhoods_lists.h"
#include "adasplats/surface/base_neighborhoods.h"

namespace adasplats::gpu {

/// Private to gpu/: BaseNeighborhoods in device memory.
struct DeviceBase {
  double radius_m = 0;
  double error_m = 0;
  DeviceBuffer<Vec3f> normals;
  DeviceBuffer<ShapeKind> kinds;
  DeviceBuffer<std::uint32_t> memberships;  ///< with denoising, as votes
  DeviceBuffer<std::uint32_t> votes;
};

/// The result of base_neighborhoods(), bit-identical. `points` (device memory): those of the index,
/// by rank.
DeviceBase base_neighborhoods(const Vec3f* points, const DevicePointIndex& index,
                              const BaseNeighborhoodOptions& options, cudaStream_t stream);

/// Sets the normals of points with a non-empty list of neighbours and a set flag in `wanted` (one
/// per point); the others are unchanged.
void refine_normals(const Vec3f* points, const DeviceLists& lists, const std::uint8_t* wanted,
                    DeviceBuffer<Vec3f>& normals, cudaStream_t stream);

}  // namespace adasplats::gpu
