// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/trace/scene_parts.h"
#include "adasplats/simulate/image/image.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats {

namespace gpu {
struct RenderSlot;
}  // namespace gpu

/// Private to gpu/: renders pictures on the first device of a scene, which must outlive it. Two are
/// in progress: one is copied while the next is rendered.
class GpuRenderer final : public ImageRenderer {
 public:
  GpuRenderer(const gpu::SceneParts& parts, const ImageScene& scene, const ImageOptions& options);
  ~GpuRenderer() override;
  GpuRenderer(const GpuRenderer&) = delete;
  GpuRenderer& operator=(const GpuRenderer&) = delete;

  Image render(const Camera& camera) override;
  void render_all(std::span<const Camera> cameras, Sink sink) override;

 private:
  void launch(gpu::RenderSlot& slot, const Camera& camera) const;

  const gpu::DevicePart& part_;
  Vec3d origin_;
  ImageOptions options_;
  ShadingTables tables_;
  gpu::Stream stream_;  ///< of the memory of the tables
  gpu::DeviceBuffer<Disk> disks_;
  gpu::DeviceBuffer<Vec3f> vertices_;
  gpu::DeviceBuffer<std::array<std::uint32_t, 3>> triangles_;
  gpu::DeviceBuffer<std::uint16_t> classes_;
  gpu::DeviceBuffer<SemanticGroup> groups_;
  gpu::DeviceBuffer<float> intensities_;
  gpu::DeviceBuffer<ColorBytes> colors_;
  gpu::DeviceBuffer<Vec3f> class_colors_;
  std::array<std::unique_ptr<gpu::RenderSlot>, 2> slots_;
  std::mutex mutex_;  ///< of the slots
};

}  // namespace adasplats
