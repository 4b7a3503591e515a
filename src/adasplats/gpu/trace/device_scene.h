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

/// A launch with fewer rays than this traces all of them at the same time, so its duration is that
/// of the slowest rays, independent of the throughput of the GPU.
inline constexpr std::uint64_t kSmallLaunch = std::uint64_t{1} << 19;

/// Private to gpu/: a scene in the memory of one GPU that casts the rays of a RaySource. Only this
/// class differs between the two backends (own tree, OptiX); tracer, scans and pictures share the
/// code on top of it.
class DeviceScene {
 public:
  virtual ~DeviceScene() = default;

  virtual std::string_view name() const = 0;

  /// Queues the casting of rays [0, count) of `source`: the `depth` nearest hits of ray i go to
  /// hits[i * depth + k], ascending by (t, primitive); entries after the last hit are Hit{}.
  /// With a depth of 1 in a scene with opacities, the hit is where the ray most likely ends
  /// (SoftHits). Invalid rays (castable() of trace/castable.h is false) have no hits. The device of
  /// the scene must be current. `hits` may be device memory or page-locked host memory.
  virtual void cast(const RaySource& source, std::uint64_t count, int depth, Hit* hits,
                    cudaStream_t stream) const = 0;
};

/// Our own compressed 8-wide tree, built on the current device.
std::unique_ptr<DeviceScene> make_cuda_scene(const SceneView& scene);

/// OptiX, on the current device. Errors: unavailable (no library, driver too old), with a remedy.
std::unique_ptr<DeviceScene> make_optix_scene(const SceneView& scene);

}  // namespace adasplats::gpu
