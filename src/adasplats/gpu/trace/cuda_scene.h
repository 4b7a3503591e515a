// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <memory>

#include "adasplats/gpu/trace/device_scene.h"
#include "adasplats/gpu/trace/wide_tree.h"
#include "adasplats/scene/intersect.h"

namespace adasplats::gpu {

/// Private to gpu/: a tree over disks that are in device memory already; those with no radius are
/// not there. Hits carry the index in the array. The stream must outlive the scene; casts on other
/// streams must wait for it first.
std::unique_ptr<DeviceScene> make_cuda_scene_of_device_disks(const Disk* disks, std::size_t count,
                                                             cudaStream_t stream);

/// make_cuda_scene with another tree than the default.
std::unique_ptr<DeviceScene> make_cuda_scene(const SceneView& scene, const TreeOptions& options);

}  // namespace adasplats::gpu
