// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// How much a point of a kernel (in cells) takes of a neighbour that lies `way` off (KPConv,
/// equation 3); not positive: nothing.
ADASPLATS_HD inline float kernel_influence(Vec3f way, Vec3f kernel_point, float cell_m,
                                           float sigma_m) {
  const Vec3f off = way - cell_m * kernel_point;
  return 1 - std::sqrt(dot(off, off)) / sigma_m;
}

/// Leaky rectification: negative values are multiplied.
ADASPLATS_HD inline float activated(float value, float slope) {
  return value < 0 ? slope * value : value;
}

}  // namespace adasplats
