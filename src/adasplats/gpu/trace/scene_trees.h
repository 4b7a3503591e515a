// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "adasplats/core/maths/ray.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/trace/ray_source.h"
#include "adasplats/gpu/trace/wide_tree.h"
#include "adasplats/scene/scene.h"
#include "adasplats/scene/soft_disk.h"

namespace adasplats::gpu {

/// Private to gpu/: soft disks in device memory; null: disks are opaque.
struct SoftDisksView {
  const Disk* disks = nullptr;
  const float* opacities = nullptr;
  std::uint32_t count = 0;

  /// Opacity where a ray hits a primitive. Triangles are opaque.
  __host__ __device__ float at(const Ray& ray, Hit hit) const {
    if (hit.primitive >= count) return kMaxOpacity;
    return opacity_of_hit(ray, hit.t, disks[hit.primitive], opacities[hit.primitive]);
  }
};

/// Private to gpu/: kernel view of the trees of a scene.
struct TreesView {
  TreeView<LeafDisk> disks;
  TreeView<LeafTriangle> triangles;
  SoftDisksView soft;
};

/// The trees of a scene's disks and triangles on one device.
struct SceneTrees {
  WideTree<LeafDisk> disks;
  WideTree<LeafTriangle> triangles;
  DeviceBuffer<Disk> soft_disks;  ///< by number; empty: disks are opaque
  DeviceBuffer<float> opacities;

  TreesView view() const {
    return {disks.view(),
            triangles.view(),
            {soft_disks.data(), opacities.data(), static_cast<std::uint32_t>(soft_disks.size())}};
  }
};

/// Builds the trees on the current device; complete when this returns. Primitives have the numbers
/// of hits. Errors: data (too many primitives).
SceneTrees build_scene_trees(const SceneView& scene, const TreeOptions& options,
                             cudaStream_t stream);

/// DeviceScene::cast() for trees. In a scene with opacities the nearest hit is where the ray most
/// likely ends (SoftHits).
void cast_trees(const TreesView& trees, const RaySource& source, std::uint64_t count, int depth,
                Hit* hits, cudaStream_t stream);

}  // namespace adasplats::gpu
