// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/consistent/consistent_cells.h"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/surface/adaptive_planes.h"

namespace adasplats::gpu {

/// Private to gpu/: adaptive_planes() in device memory, bit-identical. `index` contains the cells
/// in order. Errors: usage (scales above DevicePointIndex::kMaxNeighbors).
DeviceBuffer<LocalPlane> planes_on_device(const CellsView& cells, const DevicePointIndex& index,
                                          const AdaptivePlaneOptions& options, cudaStream_t stream);

}  // namespace adasplats::gpu
