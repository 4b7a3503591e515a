// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/simulate/gpu_shading.h"

namespace adasplats::gpu {

void queue_shading(const ShadingTables& tables, const RaySource& source, const Hit* hits, int width,
                   int height, std::uint8_t* pixels, cudaStream_t stream) {
  const std::uint64_t count =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const int axis = source.samples_per_axis;
  const float weight = 1.0F / static_cast<float>(axis * axis);
  for_each(count, stream, "colour a picture on the GPU", [=] __device__(std::uint64_t i) {
    const Quotient at_pixel = divide(i, static_cast<std::uint32_t>(width));
    const int x = static_cast<int>(at_pixel.rest), y = static_cast<int>(at_pixel.whole);
    Vec3f sum;
    for (int v = 0; v < axis; ++v) {
      for (int u = 0; u < axis; ++u) {
        const SamplePlace at = {x * axis + u, y * axis + v};
        const std::uint64_t ray = ray_of_sample(at, source.columns);
        sum = sum + shade(tables, ray_of(source, ray), hits[ray]);
      }
    }
    for (int channel = 0; channel < 3; ++channel)
      pixels[3 * i + static_cast<std::uint64_t>(channel)] = to_byte(weight * sum[channel]);
  });
}

}  // namespace adasplats::gpu
