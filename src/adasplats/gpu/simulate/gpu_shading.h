// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "adasplats/gpu/trace/ray_source.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats::gpu {

/// Private to gpu/: queues the colouring of a picture. `source` is what the hits were cast from
/// (kind image), `pixels` 8-bit RGB, rows from the top. Tables point to device memory.
void queue_shading(const ShadingTables& tables, const RaySource& source, const Hit* hits, int width,
                   int height, std::uint8_t* pixels, cudaStream_t stream);

}  // namespace adasplats::gpu
