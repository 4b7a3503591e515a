// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Height of points above the lowest ones around, m: the least of square columns of 1 m, eroded and
/// smoothed over nine of them each way.
std::vector<float> heights_above_ground(std::span<const Vec3f> points);

}  // namespace adasplats
