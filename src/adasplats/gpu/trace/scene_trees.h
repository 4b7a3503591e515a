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

namespace adasplats::gpu {

/// Private to gpu/: kernel view of the trees of a scene.
struct TreesView {
  TreeView<LeafDisk> disks;
  TreeView<LeafTriangle> triangles;
  const float* opacities = nullptr;  ///< of the leaves of `disks`; null: disks are opaque
};

/// The trees of a scene's disks and triangles on one device.
struct SceneTrees {
  WideTree<LeafDisk> disks;
  WideTree<LeafTriangle> triangles;
  DeviceBuffer<float> opacities;  ///< of the leaves of `disks`; empty: disks are opaque

  TreesView view() const { return {disks.view(), triangles.view(), opacities.data()}; }
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
