// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/simulate/image/image.h"
#include "adasplats/simulate/world/scene_caster.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Traces one scene, on the CPU (make_cpu_scene_engine) or on GPUs (make_gpu_scene).
class SceneEngine {
 public:
  virtual ~SceneEngine() = default;

  /// Tracer for rays of the caller, on the first device.
  virtual const Tracer& tracer() const = 0;
  /// Caster for scans.
  virtual const SceneCaster& scan_caster() const = 0;
  /// Renderer for pictures, on the first device. `scene.view` must be the traced scene. The engine
  /// and the data viewed by `scene` must outlive the renderer.
  virtual std::unique_ptr<ImageRenderer> renderer(const ImageScene& scene,
                                                  const ImageOptions& options) const = 0;
};

/// `origin`: world coordinates of the scene's local origin, m. Views the scene; it and the executor
/// must outlive the engine.
std::unique_ptr<SceneEngine> make_cpu_scene_engine(const SceneView& scene, Vec3d origin,
                                                   const Executor& executor);

}  // namespace adasplats
