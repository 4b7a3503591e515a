// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// The constant spherical harmonic, sqrt(1 / (4 pi)): a colour from 0 to 1 is 0.5 + its coefficient
/// times this.
inline constexpr double kHarmonic0 = 0.28209479177387814;

/// A Gaussian volume as a flat one: without its extent along its shortest axis.
struct FlatGaussian {
  Vec3d normal;       ///< the shortest axis, unit
  double longer = 0;  ///< standard deviations along the two other axes
  double shorter = 0;
};

/// `deviations`: along the axes, which are the columns of `axes` (a rotation).
inline FlatGaussian flat_gaussian(Vec3d deviations, const Mat3d& axes) {
  const double s[3] = {deviations.x, deviations.y, deviations.z};
  const int shortest = static_cast<int>(std::min_element(s, s + 3) - s);
  const double a = s[(shortest + 1) % 3], b = s[(shortest + 2) % 3];
  Vec3d unit;
  unit[shortest] = 1;
  return {axes * unit, std::max(a, b), std::min(a, b)};
}

}  // namespace adasplats
