// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// A start pose for a street scene: on open ground (a 1 m cell that is empty up to 2.2 m above the
/// ground) where most points are, `eye_height_m` above it, facing the direction that stays open
/// longest. `positions`: m, z up; the pose is in their frame. Nothing without open ground (a model
/// of one object, an empty cloud).
std::optional<RigidTransform> street_pose(std::span<const Vec3f> positions, double eye_height_m);

}  // namespace adasplats
