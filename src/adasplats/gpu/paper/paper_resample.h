// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/gpu/neighbors/cloud_on_device.h"
#include "adasplats/gpu/paper/paper_generation.h"
#include "adasplats/splats/paper/paper_options.h"

namespace adasplats::gpu {

/// Private to gpu/: a ResampledCloud in device memory.
struct DeviceResampled {
  DeviceCloud cloud;
  DeviceBuffer<SemanticGroup> groups;
  std::size_t new_points = 0;
};

/// The result of resample(), bit-identical, but in canonical order.
/// Errors: usage (splats are too dense for a GPU).
DeviceResampled resample(const DeviceCloud& cloud, const DeviceGeneration& first,
                         const PaperOptions& options, cudaStream_t stream);

}  // namespace adasplats::gpu
