// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/trajectory_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "adasplats/calibrate/robust_weight.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/symmetric_eigen.h"

namespace adasplats {
namespace {

constexpr int kFittingIterations = 10;  // weights and motion converge within a few
/// The median of the squared length of a vector whose three components are normal with a deviation
/// of 1 (chi-square with three degrees of freedom).
constexpr double kMedianSquare = 2.366;
/// In standard deviations: distance at which a pose has a quarter of its weight. Normally
/// distributed poses keep nearly all of theirs.
constexpr double kWidthOfFitting = 4;

double variance_of(std::vector<double> squares) { return upper_median_of(squares) / kMedianSquare; }

Vec3d solved(const SymmetricMat3d& matrix, Vec3d right) {
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  Vec3d x;
  for (int k = 0; k < 3; ++k)
    if (eigen.values[k] > 0)
      x = x + (dot(eigen.vectors[k], right) / eigen.values[k]) * eigen.vectors[k];
  return x;
}

struct Spread {
  double rotation = 0, shift = 0;  ///< variances of one component, rad^2 and m^2
};

/// Spread of the current differences, bounded from below by the rounding errors (1e-9 rad, 10 nm).
Spread spread_of(std::span<const PoseCorrection> poses) {
  std::vector<double> turns, shifts;
  for (const PoseCorrection& pose : poses) {
    turns.push_back(dot(pose.rotation_rad, pose.rotation_rad));
    shifts.push_back(dot(pose.shift_m, pose.shift_m));
  }
  return {std::max(1e-18, variance_of(std::move(turns))),
          std::max(1e-16, variance_of(std::move(shifts)))};
}

double weight_of(const PoseCorrection& pose, const Spread& spread) {
  const double square = dot(pose.rotation_rad, pose.rotation_rad) / spread.rotation +
                        dot(pose.shift_m, pose.shift_m) / spread.shift;
  return robust_weight(std::sqrt(square / 6), kWidthOfFitting);
}

/// One step of weighted least squares.
RigidTransform step_onto_given(std::span<const PoseCorrection> poses, const Spread& spread) {
  double total = 0;
  Vec3d center, shift;
  for (const PoseCorrection& pose : poses) {
    const double weight = weight_of(pose, spread);
    total += weight;
    center = center + weight * (pose.position + pose.shift_m);
    shift = shift + weight * pose.shift_m;
  }
  center = center / total;
  shift = shift / total;
  SymmetricMat3d matrix;
  Vec3d right;
  for (const PoseCorrection& pose : poses) {
    const double weight = weight_of(pose, spread);
    const double by_turn = weight / spread.rotation, by_place = weight / spread.shift;
    const Vec3d arm = pose.position + pose.shift_m - center;
    const double square = dot(arm, arm);
    matrix.xx += by_turn + by_place * (square - arm.x * arm.x);
    matrix.yy += by_turn + by_place * (square - arm.y * arm.y);
    matrix.zz += by_turn + by_place * (square - arm.z * arm.z);
    matrix.xy -= by_place * arm.x * arm.y;
    matrix.xz -= by_place * arm.x * arm.z;
    matrix.yz -= by_place * arm.y * arm.z;
    right = right - by_turn * pose.rotation_rad - by_place * cross(arm, pose.shift_m - shift);
  }
  return moved_about(center, solved(matrix, right), -shift);
}

}  // namespace

PoseCorrection moved(const PoseCorrection& pose, const RigidTransform& motion) {
  const RigidTransform whole = motion * pose.corrected_from_given();
  PoseCorrection result = pose;
  result.rotation_rad = rotation_vector(whole.rotation);
  result.shift_m = whole * pose.position - pose.position;
  return result;
}

RigidTransform onto_given(std::span<const PoseCorrection> poses) {
  RigidTransform whole;
  if (poses.empty()) return whole;
  std::vector<PoseCorrection> now(poses.begin(), poses.end());
  for (int iteration = 0; iteration < kFittingIterations; ++iteration) {
    whole = step_onto_given(now, spread_of(now)) * whole;
    for (std::size_t k = 0; k < now.size(); ++k) now[k] = moved(poses[k], whole);
  }
  return whole;
}

}  // namespace adasplats
