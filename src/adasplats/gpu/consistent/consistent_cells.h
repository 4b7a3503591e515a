// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/neighbors/hilbert.h"
#include "adasplats/surface/fused_points.h"

namespace adasplats::gpu {

/// Private to gpu/: FusedPoints in device memory.
struct DeviceCells {
  DeviceBuffer<Vec3f> positions;
  DeviceBuffer<std::uint32_t> begins;  ///< number of cells + 1
  DeviceBuffer<std::uint32_t> members;

  std::size_t size() const { return positions.size(); }
  CellsView view() const {
    return {positions.data(), begins.data(), members.data(),
            static_cast<std::uint32_t>(positions.size())};
  }
  FusedPoints download() const;
};

/// fuse_points() for points in device memory, bit-identical.
DeviceCells fuse_on_device(const Vec3f* points, std::size_t count, double cell_m,
                           const CurveBox& box, cudaStream_t stream);

/// split_cells() in device memory, bit-identical. One flag per cell.
DeviceCells split_on_device(const Vec3f* points, const DeviceCells& cells,
                            const std::uint8_t* split, double cell_m, const CurveBox& box,
                            cudaStream_t stream);

}  // namespace adasplats::gpu
