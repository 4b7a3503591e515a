// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/gpu/trace/device_scene.h"
#include "adasplats/trace/tracer.h"

namespace adasplats::gpu {

/// Private to gpu/: a Tracer over a scene of one GPU, for rays that the caller has. Calls from
/// several threads wait for each other. At most 64 hits a ray.
std::unique_ptr<Tracer> make_gpu_tracer(const DeviceScene& scene, int device);

}  // namespace adasplats::gpu
