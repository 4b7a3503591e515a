// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Sums of a Gauss-Newton step for a rotation about a pivot and a shift: point to plane along the
/// normals of the hits, with weights that decrease with distance (Geman-McClure).
struct RegistrationSums {
  std::array<double, 36> matrix{};
  std::array<double, 6> right{};
  std::size_t beams = 0;

  /// `arm`: from the pivot to the measured point.
  void add(Vec3d arm, Vec3d normal, double residual_m, double width_m) {
    const double share = width_m * width_m / (width_m * width_m + residual_m * residual_m);
    const double weight = share * share;
    const Vec3d turning = cross(arm, normal);
    const std::array<double, 6> row = {turning.x, turning.y, turning.z,
                                       normal.x,  normal.y,  normal.z};
    for (std::size_t a = 0; a < 6; ++a) {
      right[a] += weight * row[a] * residual_m;
      for (std::size_t b = 0; b < 6; ++b) matrix[a * 6 + b] += weight * row[a] * row[b];
    }
    ++beams;
  }
  RegistrationSums& operator+=(const RegistrationSums& other) {
    for (std::size_t k = 0; k < matrix.size(); ++k) matrix[k] += other.matrix[k];
    for (std::size_t k = 0; k < right.size(); ++k) right[k] += other.right[k];
    beams += other.beams;
    return *this;
  }
};

}  // namespace adasplats
