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

/// What parts the beams of an error view; lengths in m.
struct ErrorLimits {
  float fits_m = 0.1F;   ///< errors up to it are none of the parts
  float ghost_m = 0.5F;  ///< a surface that much before the measured point was passed by the beam
};

/// Layers "early" (the model's surface stands before the measured point), "late" (behind it),
/// "ghosts" (so early that the beam passed through it) and "holes" (the beam meets nothing), each
/// where there are such points. None for errors without a sign (distances): none is negative.
std::vector<ViewLayer> error_part_layers(const PointCloud& cloud, std::span<const float> errors_m,
                                         const ErrorLimits& limits, Vec3d origin,
                                         const Executor& executor);

}  // namespace adasplats
