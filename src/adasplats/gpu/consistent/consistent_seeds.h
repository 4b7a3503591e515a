// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/consistent/consistent_cells.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"
#include "adasplats/splats/consistent/consistent_model.h"
#include "adasplats/splats/consistent/consistent_steps.h"
#include "adasplats/splats/consistent/seed_disk.h"

namespace adasplats::gpu {

// Private to gpu/: seeds and splats from cells and planes, in device memory.

/// Median of the planes' spacings over their units, of those with a unit; 0 where there is none.
/// Waits for the stream.
double median_spacing(const DeviceBuffer<LocalPlane>& planes, const DeviceBuffer<float>& units_m,
                      cudaStream_t stream);

/// Number of disks with a radius. Waits for the stream.
std::size_t count_present(const DeviceBuffer<Disk>& disks, cudaStream_t stream);

/// Copies the disks with a radius, their opacities (unless `extents` is empty) and the attributes
/// of their cells' points to the host.
ConsistentSplats splats_of(const DeviceBuffer<Disk>& disks, const DeviceBuffer<DiskExtent>& extents,
                           const DeviceCells& cells, const DeviceCloud& cloud, cudaStream_t stream);

}  // namespace adasplats::gpu
