// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "adasplats/gpu/gpu_scene.h"

namespace adasplats::gpu {

/// Private to gpu/: queues the turning of hits into points in the frame of their sensor.
void queue_point_hits(const Hit* hits, const Vec3f* directions, std::uint32_t firings,
                      std::uint64_t count, PointHit* points, cudaStream_t stream);

}  // namespace adasplats::gpu
