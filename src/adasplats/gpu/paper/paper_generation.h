// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"
#include "adasplats/splats/paper/generation.h"

namespace adasplats::gpu {

class GpuBackend;

/// Private to gpu/: a Generation in device memory.
struct DeviceGeneration {
  DeviceBuffer<Disk> disks;
  DeviceBuffer<std::uint32_t> seeds;   ///< index of each splat's seed point in the cloud
  DeviceBuffer<SemanticGroup> groups;  ///< one per point of the cloud; empty for basic splats
  double radius_m = 0;                 ///< R
  double error_m = 0;                  ///< E
};

/// The result of generate_splats(), bit-identical. `groups`: empty or one per point of the cloud.
/// Errors: usage (neighbourhoods too large for a GPU).
DeviceGeneration generate_splats(const GpuBackend& place, const DeviceCloud& cloud,
                                 const DeviceBuffer<SemanticGroup>& groups,
                                 const PaperOptions& options, StepSink step);

}  // namespace adasplats::gpu
