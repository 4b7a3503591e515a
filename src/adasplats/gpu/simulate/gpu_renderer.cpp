// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/simulate/gpu_renderer.h"

#include <algorithm>

#include "adasplats/core/error.h"
#include "adasplats/gpu/simulate/gpu_shading.h"
#include "adasplats/simulate/image/shading.h"

namespace adasplats {

namespace gpu {

/// One picture in progress.
struct RenderSlot {
  Stream stream;
  DeviceBuffer<Ray> rays;  ///< of a lens
  DeviceBuffer<Hit> hits;
  DeviceBuffer<Vec3f> frame_colors;
  DeviceBuffer<float> frame_nearness, frame_splat_px;
  DeviceBuffer<std::uint16_t> frame_hits;
  DeviceBuffer<std::uint8_t> device_pixels;
  PinnedBuffer<std::uint8_t> pixels;
};

namespace {

/// Copies a table to the GPU and sets the pointer to the copy.
template <class T>
DeviceBuffer<T> moved_table(const T*& table, std::size_t size, cudaStream_t stream) {
  if (table == nullptr || size == 0) return {};
  DeviceBuffer<T> buffer(std::span<const T>(table, size), stream);
  table = buffer.data();
  return buffer;
}

int padded(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

RaySource source_of(const Camera& camera, const ImageOptions& options, Vec3d origin) {
  RaySource source;
  source.kind = RaySource::Kind::image;
  source.camera = camera.rays(origin);
  source.samples_per_axis = options.samples_per_axis;
  source.columns = padded(camera.width * options.samples_per_axis, SamplePlace::kTileColumns);
  source.rows = padded(camera.height * options.samples_per_axis, SamplePlace::kTileRows);
  return source;
}

}  // namespace
}  // namespace gpu

using gpu::cuda_check;
using gpu::DeviceGuard;
using gpu::RaySource;
using gpu::RenderSlot;
using gpu::SceneParts;

GpuRenderer::GpuRenderer(const SceneParts& parts, const ImageScene& scene,
                         const ImageOptions& options)
    : part_(parts.first()), origin_(parts.origin), options_(options) {
  const DeviceGuard guard(part_.device);
  stream_ = gpu::Stream();  // on this device
  const Shading shading(scene, options);
  tables_ = shading.tables();
  const cudaStream_t stream = stream_.get();
  const std::size_t primitives = scene.view.primitive_count();
  disks_ = gpu::moved_table(tables_.disks, scene.view.disk_count(), stream);
  if (scene.view.mesh != nullptr) {
    vertices_ = gpu::moved_table(tables_.vertices, scene.view.mesh->vertices.size(), stream);
    triangles_ = gpu::moved_table(tables_.triangles, scene.view.mesh->triangles.size(), stream);
  }
  classes_ = gpu::moved_table(tables_.classes, primitives, stream);
  groups_ = gpu::moved_table(tables_.groups, primitives, stream);
  intensities_ = gpu::moved_table(tables_.intensities, primitives, stream);
  colors_ = gpu::moved_table(tables_.colors, primitives, stream);
  class_colors_ = gpu::moved_table(tables_.class_colors, tables_.class_color_count, stream);
  stream_.wait("copy the colours of the scene to the GPU");
}

GpuRenderer::~GpuRenderer() {
  const DeviceGuard guard(part_.device);
  for (auto& slot : slots_) {
    // A picture may still be in progress after an exception.
    if (slot != nullptr) cudaStreamSynchronize(slot->stream.get());
    slot.reset();
  }
}

void GpuRenderer::launch(RenderSlot& slot, const Camera& camera) const {
  const cudaStream_t stream = slot.stream.get();
  RaySource source = gpu::source_of(camera, options_, origin_);
  const auto rays =
      static_cast<std::uint64_t>(source.columns) * static_cast<std::uint64_t>(source.rows);
  if (camera.lens) {
    if (slot.rays.size() < rays) slot.rays = gpu::DeviceBuffer<Ray>(rays, stream);
    gpu::queue_lens_rays(source, slot.rays.data(), stream);
    source.kind = RaySource::Kind::given;
    source.rays = slot.rays.data();
  }
  part_.scene->cast(source, rays, 1, slot.hits.data(), stream);
  gpu::queue_shading(tables_, Developer(camera, options_), source, slot.hits.data(), camera.width,
                     camera.height,
                     {slot.frame_colors.data(), slot.frame_nearness.data(),
                      slot.frame_splat_px.data(), slot.frame_hits.data()},
                     slot.device_pixels.data(), stream);
  const std::size_t bytes =
      3 * static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  cuda_check(cudaMemcpyAsync(slot.pixels.data(), slot.device_pixels.data(), bytes,
                             cudaMemcpyDeviceToHost, stream),
             "copy a picture from the GPU");
}

void GpuRenderer::render_all(std::span<const Camera> cameras, Sink sink) {
  if (cameras.empty()) return;
  const int width = cameras.front().width, height = cameras.front().height;
  for (const Camera& camera : cameras) {
    check_image(camera, options_);
    if (camera.width != width || camera.height != height)
      throw Error(ErrorKind::usage, "the cameras of one call have pictures of different sizes");
  }
  const std::lock_guard lock(mutex_);
  const DeviceGuard guard(part_.device);
  const RaySource source = gpu::source_of(cameras.front(), options_, origin_);
  const std::size_t rays =
      static_cast<std::size_t>(source.columns) * static_cast<std::size_t>(source.rows);
  const std::size_t bytes = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::size_t lanes = std::min(slots_.size(), cameras.size());
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    auto& slot = slots_[lane];
    if (slot == nullptr) slot = std::make_unique<RenderSlot>();
    slot->stream.wait("prepare pictures on the GPU");  // after an exception
    if (slot->hits.size() < rays) slot->hits = gpu::DeviceBuffer<Hit>(rays, slot->stream.get());
    if (slot->pixels.size() < bytes) {
      slot->frame_colors = gpu::DeviceBuffer<Vec3f>(bytes / 3, slot->stream.get());
      slot->frame_nearness = gpu::DeviceBuffer<float>(bytes / 3, slot->stream.get());
      slot->frame_splat_px = gpu::DeviceBuffer<float>(bytes / 3, slot->stream.get());
      slot->frame_hits = gpu::DeviceBuffer<std::uint16_t>(bytes / 3, slot->stream.get());
      slot->device_pixels = gpu::DeviceBuffer<std::uint8_t>(bytes, slot->stream.get());
      slot->pixels = gpu::PinnedBuffer<std::uint8_t>(bytes);
    }
  }
  for (std::size_t k = 0; k < lanes; ++k) launch(*slots_[k], cameras[k]);
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    RenderSlot& slot = *slots_[k % lanes];
    slot.stream.wait("render a picture on the GPU");
    sink(k, {slot.pixels.data(), bytes});
    if (k + lanes < cameras.size()) launch(slot, cameras[k + lanes]);
  }
}

Image GpuRenderer::render(const Camera& camera) {
  Image image{camera.width, camera.height, {}};
  render_all({&camera, 1}, [&](std::size_t, std::span<const std::uint8_t> pixels) {
    image.pixels.assign(pixels.begin(), pixels.end());
  });
  return image;
}

}  // namespace adasplats
#endif
