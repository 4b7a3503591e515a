// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// From the axes that PandaSet and nuScenes give their LiDARs, x right, y forward, z up, to ours. A
/// change of axes alone is exact in floating point.
inline constexpr RigidTransform kSensorFromRightForward = {{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}},
                                                           {}};

}  // namespace adasplats
