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

/// What base_neighborhoods() gives, the same bits. `points` (device memory) are those of the index,
/// by rank.
DeviceBase base_neighborhoods(const Vec3f* points, const DevicePointIndex& index,
                              const BaseNeighborhoodOptions& options, cudaStream_t stream);

/// Normals from lists of neighbours, where these are not empty and `wanted` (one flag a point) is
/// set; the others keep what `normals` has.
void refine_normals(const Vec3f* points, const DeviceLists& lists, const std::uint8_t* wanted,
                    DeviceBuffer<Vec3f>& normals, cudaStream_t stream);

}  // namespace adasplats::gpu
