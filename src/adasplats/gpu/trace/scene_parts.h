// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/trace/device_scene.h"
#include "adasplats/simulate/scan/firing_report.h"

namespace adasplats::gpu {

/// Private to gpu/: the copy of a scene on one device.
struct DevicePart {
  int device = 0;
  std::shared_ptr<DeviceScene> scene;
  /// Attributes of the primitives of a city in device memory; null: the rules have them.
  const PrimitiveValues* values = nullptr;
};

/// Data shared by a GpuScene or GpuCity, its scanners and its renderers.
struct SceneParts {
  ~SceneParts() {
    for (DevicePart& part : parts) {
      const DeviceGuard guard(part.device);
      part.scene.reset();
    }
  }

  std::vector<DevicePart> parts;  ///< one per device, at least one
  Vec3d origin;                   ///< world coordinates of the scene's local origin, m

  const DevicePart& first() const { return parts.front(); }
};

}  // namespace adasplats::gpu
