// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/simulate/scan/scan_ray.h"

namespace adasplats::gpu {

/// Private to gpu/: queues the conversion of hits to points in the frame of their sensor.
void queue_point_hits(const Hit* hits, const FiringRay* firings, std::uint32_t firing_count,
                      std::uint64_t count, PointHit* points, cudaStream_t stream);

}  // namespace adasplats::gpu
