// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/simulate/gpu_shading.h"
#include "adasplats/simulate/image/pixel_sum.h"

namespace adasplats::gpu {

namespace {

void queue_frame(const ShadingTables& tables, const RaySource& source, const Hit* hits, int width,
                 std::uint64_t count, DeviceFrame frame, cudaStream_t stream) {
  const int axis = source.samples_per_axis;
  for_each(count, stream, "colour a picture on the GPU", [=] __device__(std::uint64_t i) {
    const Quotient at_pixel = divide(i, static_cast<std::uint32_t>(width));
    const int x = static_cast<int>(at_pixel.rest), y = static_cast<int>(at_pixel.whole);
    PixelSum sum;
    for (int v = 0; v < axis; ++v) {
      for (int u = 0; u < axis; ++u) {
        const SamplePlace at = {x * axis + u, y * axis + v};
        const std::uint64_t ray = ray_of_sample(at, source.columns);
        sum.add(tables, source.camera, ray_of(source, ray), hits[ray]);
      }
    }
    frame.colors[i] = sum.pixel.color;
    frame.nearness[i] = sum.pixel.nearness;
    frame.splat_px[i] = sum.pixel.splat_px;
    frame.hits[i] = sum.hits;
  });
}

template <bool kWithLens>
void queue_developing(const Developer& developer, const FrameView& view, std::uint8_t* out,
                      cudaStream_t stream) {
  const auto width = static_cast<std::uint32_t>(view.width);
  const std::uint64_t count = std::uint64_t{width} * static_cast<std::uint64_t>(view.height);
  for_each(count, stream, "develop a picture on the GPU", [=] __device__(std::uint64_t i) {
    const Quotient at = divide(i, width);
    const Vec3f color = develop_pixel<kWithLens>(
        developer, view, static_cast<std::int32_t>(at.rest), static_cast<std::int32_t>(at.whole));
    for (int channel = 0; channel < 3; ++channel)
      out[3 * i + static_cast<std::uint64_t>(channel)] = to_byte(color[channel]);
  });
}

}  // namespace

void queue_lens_rays(const RaySource& source, Ray* rays, cudaStream_t stream) {
  const std::uint64_t count =
      static_cast<std::uint64_t>(source.columns) * static_cast<std::uint64_t>(source.rows);
  for_each(count, stream, "make the rays of a lens on the GPU", [=] __device__(std::uint64_t i) {
    const SamplePlace at = sample_of(i, source.columns);
    rays[i] = source.camera.lens_ray((at.x + 0.5) / source.samples_per_axis,
                                     (at.y + 0.5) / source.samples_per_axis);
  });
}

void queue_shading(const ShadingTables& tables, const Developer& developer, const RaySource& source,
                   const Hit* hits, int width, int height, DeviceFrame frame, std::uint8_t* out,
                   cudaStream_t stream) {
  const std::uint64_t count =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  queue_frame(tables, source, hits, width, count, frame, stream);
  const FrameView view = {frame.colors, frame.nearness, frame.splat_px, frame.hits, width, height};
  if (developer.camera.has_lens)
    queue_developing<true>(developer, view, out, stream);
  else
    queue_developing<false>(developer, view, out, stream);
}

}  // namespace adasplats::gpu
