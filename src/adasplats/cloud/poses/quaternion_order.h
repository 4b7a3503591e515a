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
/// the angles between them are the same in any order, but what drives goes one way in its own frame
/// (mostly ahead), also round a bend: where it does so by another order alone, that is the right
/// one. Returns the problem in words, or "" if there is none or the test is inconclusive (too few
/// poses, no bends, something that flies or is carried).
std::string quaternion_order_problem(std::span<const PlacedQuaternion> poses);

}  // namespace adasplats
