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

/// Private to gpu/: what the steps make of cells and planes, in device memory.

/// What every cell's spacing is compared with (spacing_unit_m()).
DeviceBuffer<float> spacing_units(const MeasuredPoints& points, const CellsView& cells,
                                  bool with_beam, cudaStream_t stream);

/// One flag a cell: none of its points has a beam.
DeviceBuffer<std::uint8_t> cells_without_beam(const MeasuredPoints& points, const CellsView& cells,
                                              cudaStream_t stream);

/// Median of the planes' spacings over their units, of those with a unit; 0 where there is none.
/// Waits for the stream.
double median_spacing(const DeviceBuffer<LocalPlane>& planes, const DeviceBuffer<float>& units_m,
                      cudaStream_t stream);

/// Turns the planes' normals to the sensors and makes a seed of each.
DeviceBuffer<Disk> seeds_of_planes(const MeasuredPoints& points, const CellsView& cells,
                                   const TypicalSpacing& typical, const ConsistentOptions& options,
                                   DeviceBuffer<LocalPlane>& planes, cudaStream_t stream);

/// The disks that have a radius, with the attributes of their cells' points, on the host.
ConsistentSplats splats_of(const DeviceBuffer<Disk>& disks, const DeviceCells& cells,
                           const DeviceCloud& cloud, cudaStream_t stream);

}  // namespace adasplats::gpu
