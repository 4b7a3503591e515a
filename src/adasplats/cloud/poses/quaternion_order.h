// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// A place, and a rotation as a file has it.
struct PlacedQuaternion {
  Vec3d place;
  Quaternion rotation;
};

/// Whether the scalar of the quaternions is in another place than their names say. Their norms and
/// the angles between them are the same in any order, but what drives goes one way in its own
/// frame (mostly ahead), also round a bend: where it does so by another order alone, that is the
/// right one. Gives what is wrong in words, or "" where nothing is, or where nothing tells (too few
/// poses, no bends, what flies or is carried).
std::string objection_to_quaternion_order(std::span<const PlacedQuaternion> poses);

}  // namespace adasplats
