// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/gpu/trace/device_scene.h"
#include "adasplats/trace/tracer.h"

namespace adasplats::gpu {

/// Private to gpu/: a Tracer over a scene on one GPU, for rays of the caller. Concurrent calls wait
/// for each other. At most 64 hits per ray.
std::unique_ptr<Tracer> make_gpu_tracer(const DeviceScene& scene, int device);

}  // namespace adasplats::gpu
