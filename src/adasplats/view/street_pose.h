// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Where somebody who walks through a place would stand first: on open ground (a metre's cell whose
/// lower two metres are empty but for the ground) among the most points, `eye_height_m` above it,
/// looking along the way that stays open longest. `positions`: m, z up; the pose is in their frame.
/// Nothing where no ground is open (a model of one object, an empty cloud).
std::optional<RigidTransform> street_pose(std::span<const Vec3f> positions, double eye_height_m);

}  // namespace adasplats
