// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/segment/pyramid/pyramid.h"

namespace adasplats::gpu {

// Private to gpu/: segment/pyramid in device memory, bit-identical.

/// CellMeans, and the points by cell: those of cell i are order[begins[i]] to
/// order[begins[i + 1]].
struct DeviceCellMeans {
  DeviceBuffer<Vec3f> means;
  DeviceBuffer<std::uint32_t> cell_of, order, begins;
};
DeviceCellMeans means_by_cell(const DeviceBuffer<Vec3f>& points, float cell_m, cudaStream_t stream);

/// PyramidLevel.
struct DeviceLevel {
  float cell_m = 0;
  DeviceBuffer<Vec3f> points;
  DeviceBuffer<std::uint32_t> neighbors, pooled, coarser;
};
/// `points`: means of cells of the shape's finest size, within 100 km of the origin.
std::vector<DeviceLevel> make_pyramid(DeviceBuffer<Vec3f> points, const PyramidShape& shape,
                                      cudaStream_t stream);

/// heights_above_ground().
DeviceBuffer<float> heights_above_ground(const DeviceBuffer<Vec3f>& points, cudaStream_t stream);

}  // namespace adasplats::gpu
