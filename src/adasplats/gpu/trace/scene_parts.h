// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/trace/device_scene.h"
#include "adasplats/simulate/scan/firing_report.h"

namespace adasplats::gpu {

/// Private to gpu/: the same scene on one device.
struct DevicePart {
  int device = 0;
  std::unique_ptr<DeviceScene> scene;
  /// What primitives carry, on the device, where it is kept with the scene; null: rules have it.
  const PrimitiveValues* values = nullptr;
};

/// What a GpuScene, its scanners and its renderers share.
struct SceneParts {
  std::vector<DevicePart> parts;  ///< one a device, at least one
  Vec3d origin;                   ///< world coordinates of the scene's local origin, m

  const DevicePart& first() const { return parts.front(); }
};

}  // namespace adasplats::gpu
