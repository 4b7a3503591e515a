// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "adasplats/gpu/trace/ray_source.h"
#include "adasplats/simulate/image/developing.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats::gpu {

/// Private to gpu/: a frame in device memory, with the pixels of a picture.
struct DeviceFrame {
  Vec3f* colors = nullptr;
  float* nearness = nullptr;
  float* splat_px = nullptr;
  std::uint16_t* hits = nullptr;
};

/// Private to gpu/: queues the computation of the rays of a picture through a lens, in the order of
/// sample_of(). A kernel of its own: in the kernels that cast, it would cost registers.
void queue_lens_rays(const RaySource& source, Ray* rays, cudaStream_t stream);

/// Private to gpu/: queues the shading of a picture of width x height pixels. `source`: ray source
/// of the hits (kind image, or given in that order); `frame`: working memory; `out` receives 8-bit
/// RGB, rows from the top. Tables point to device memory.
void queue_shading(const ShadingTables& tables, const Developer& developer, const RaySource& source,
                   const Hit* hits, int width, int height, DeviceFrame frame, std::uint8_t* out,
                   cudaStream_t stream);

}  // namespace adasplats::gpu
