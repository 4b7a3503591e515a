// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scene_engine.h"

namespace adasplats {
namespace {

class CpuSceneEngine final : public SceneEngine {
 public:
  CpuSceneEngine(const SceneView& scene, Vec3d origin, const Executor& executor)
      : executor_(executor),
        tracer_(make_cpu_tracer(scene, executor)),
        caster_(make_cpu_scene_caster(*tracer_, origin, executor)) {}

  const Tracer& tracer() const override { return *tracer_; }
  const SceneCaster& scan_caster() const override { return *caster_; }
  std::unique_ptr<ImageRenderer> renderer(const ImageScene& scene,
                                          const ImageOptions& options) const override {
    return make_cpu_renderer(*tracer_, scene, options, executor_);
  }

 private:
  const Executor& executor_;
  std::unique_ptr<Tracer> tracer_;
  std::unique_ptr<SceneCaster> caster_;
};

}  // namespace

std::unique_ptr<SceneEngine> make_cpu_scene_engine(const SceneView& scene, Vec3d origin,
                                                   const Executor& executor) {
  return std::make_unique<CpuSceneEngine>(scene, origin, executor);
}

}  // namespace adasplats
