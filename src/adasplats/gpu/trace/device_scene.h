// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <memory>
#include <string_view>

#include "adasplats/core/maths/ray.h"
#include "adasplats/gpu/trace/ray_source.h"
#include "adasplats/scene/scene.h"

namespace adasplats::gpu {

/// Where a launch has fewer rays than this, all of them are under way at once: how long it takes is
/// up to the slowest ones, not to how many a GPU can trace.
inline constexpr std::uint64_t kSmallLaunch = std::uint64_t{1} << 19;

/// Private to gpu/: a scene in the memory of one GPU that casts what a RaySource describes. The one
/// thing that the two backends (own tree, OptiX) do differently; tracer, scans and pictures are
/// written on top of it once.
class DeviceScene {
 public:
  virtual ~DeviceScene() = default;

  virtual std::string_view name() const = 0;

  /// Queues the casting of rays [0, count) of `source`: the `depth` nearest hits of ray i go to
  /// hits[i * depth + k], ascending by (t, primitive); entries behind the last hit are Hit{}.
  /// Rays that cannot hit anything (castable() of trace/castable.h is false) have none. The scene's
  /// device must be the current one. `hits` may be device memory or page-locked host memory.
  virtual void cast(const RaySource& source, std::uint64_t count, int depth, Hit* hits,
                    cudaStream_t stream) const = 0;
};

/// Our own compressed 8-wide tree, built on the current device.
std::unique_ptr<DeviceScene> make_cuda_scene(const SceneView& scene);

/// OptiX, on the current device. Errors: unavailable (no library, too old a driver) with what
/// helps.
std::unique_ptr<DeviceScene> make_optix_scene(const SceneView& scene);

}  // namespace adasplats::gpu
