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

/// Private to gpu/: a tree over disks in device memory; disks without a radius are skipped. Hits
/// have the index in the array. The stream must outlive the scene; casts on other streams must wait
/// for it first.
std::unique_ptr<DeviceScene> make_cuda_scene_of_device_disks(const Disk* disks, std::size_t count,
                                                             cudaStream_t stream);

/// make_cuda_scene() with other tree options than the default.
std::unique_ptr<DeviceScene> make_cuda_scene(const SceneView& scene, const TreeOptions& options);

}  // namespace adasplats::gpu
