// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/view/view_scene.h"

namespace adasplats {

/// Limits that divide the beams of an error view into parts, m.
struct ErrorLimits {
  float tolerance_m = 0.1F;  ///< smaller errors are in no part
  float ghost_m = 0.5F;      ///< the beam passed through a surface this far in front of its point
};

/// Layers "early" (the model's surface is in front of the measured point), "late" (behind it),
/// "ghosts" (so early that the beam passed through it) and "holes" (the beam hits nothing), without
/// empty ones. No layers for unsigned errors (distances), that is without any negative error.
std::vector<ViewLayer> error_part_layers(const PointCloud& cloud, std::span<const float> errors_m,
                                         const ErrorLimits& limits, Vec3d origin,
                                         const Executor& executor);

}  // namespace adasplats
