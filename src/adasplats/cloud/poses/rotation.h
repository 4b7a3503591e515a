// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/maths/right_forward.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Unit quaternion, Hamilton convention.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

/// The unit quaternion of a rotation, with w >= 0.
Quaternion quaternion_from_rotation(const Mat3d& rotation);

/// The rotation a share `s` (0..1) of the way from `a` to `b` along the shortest arc.
Mat3d slerp(const Quaternion& a, const Quaternion& b, double s);

/// Largest deviation of an element of m * transposed(m) from the unit matrix; infinite for
/// a reflection. `m` is finite.
double orthonormality_error(const Mat3d& m);

/// The rotation nearest to a matrix that nearly is one (its polar factor).
Mat3d orthonormalized(const Mat3d& m);

}  // namespace adasplats
