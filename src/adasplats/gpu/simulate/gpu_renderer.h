// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/gpu/trace/scene_parts.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats {

namespace gpu {
struct RenderSlot;
}  // namespace gpu

/// Private to gpu/: how a GpuRenderer works. Two pictures are under way: one is copied while the
/// next is made.
struct GpuRenderer::Impl {
 public:
  Impl(const gpu::SceneParts& parts, const ImageScene& scene, const ImageOptions& options);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void render_all(std::span<const Camera> cameras, GpuRenderer::Sink sink);

 private:
  void launch(gpu::RenderSlot& slot, const Camera& camera) const;

  const gpu::DevicePart& part_;
  Vec3d origin_;
  ImageOptions options_;
  ShadingTables tables_;
  gpu::Stream stream_;  ///< of the tables' memory
  gpu::DeviceBuffer<Disk> disks_;
  gpu::DeviceBuffer<Vec3f> vertices_;
  gpu::DeviceBuffer<std::array<std::uint32_t, 3>> triangles_;
  gpu::DeviceBuffer<std::uint16_t> classes_;
  gpu::DeviceBuffer<SemanticGroup> groups_;
  gpu::DeviceBuffer<float> intensities_;
  gpu::DeviceBuffer<Vec3f> class_colors_;
  std::array<std::unique_ptr<gpu::RenderSlot>, 2> slots_;
};

}  // namespace adasplats
