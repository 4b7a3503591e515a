// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/maths/exact_sum.h"
#include "adasplats/core/maths/symmetric_eigen.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// The largest absolute component of an offset.
ADASPLATS_HD inline float extent(Vec3f offset) {
  const float x = std::fabs(offset.x), y = std::fabs(offset.y), z = std::fabs(offset.z);
  const float larger = x > y ? x : y;
  return larger > z ? larger : z;
}

/// Rounding of Moments that makes them independent of the order of the points.
struct ExactMoments {
  ExactAddends offsets;
  ExactAddends squares;

  /// For `count` offsets with an extent() of at most `extent_m`.
  ADASPLATS_HD ExactMoments(std::uint32_t count, float extent_m)
      : offsets(count, static_cast<double>(extent_m)),
        squares(count, static_cast<double>(extent_m) * static_cast<double>(extent_m)) {}
};

/// Sums over the offsets of a neighbourhood's points from one of them. Float is precise enough for
/// offsets; products and sums are in double, so the order of the points changes the result by at
/// most about 1e-15 of its size, and not at all with ExactMoments.
struct Moments {
  double count = 0;
  Vec3d sum;
  SymmetricMat3d squares;

  ADASPLATS_HD void add(Vec3f offset) {
    const Vec3d d = vec_cast<double>(offset);
    count += 1.0;
    sum = sum + d;
    squares.xx += d.x * d.x;
    squares.xy += d.x * d.y;
    squares.xz += d.x * d.z;
    squares.yy += d.y * d.y;
    squares.yz += d.y * d.z;
    squares.zz += d.z * d.z;
  }
  ADASPLATS_HD void add(Vec3f offset, const ExactMoments& exact) {
    const Vec3d d = vec_cast<double>(offset);
    count += 1.0;
    sum = sum + Vec3d{exact.offsets(d.x), exact.offsets(d.y), exact.offsets(d.z)};
    squares.xx += exact.squares(d.x * d.x);
    squares.xy += exact.squares(d.x * d.y);
    squares.xz += exact.squares(d.x * d.z);
    squares.yy += exact.squares(d.y * d.y);
    squares.yz += exact.squares(d.y * d.z);
    squares.zz += exact.squares(d.z * d.z);
  }
};

/// The moments of the points of `all` that are not among `some` of them.
ADASPLATS_HD inline Moments operator-(const Moments& all, const Moments& some) {
  return {all.count - some.count,
          all.sum - some.sum,
          {all.squares.xx - some.squares.xx, all.squares.xy - some.squares.xy,
           all.squares.xz - some.squares.xz, all.squares.yy - some.squares.yy,
           all.squares.yz - some.squares.yz, all.squares.zz - some.squares.zz}};
}

/// Principal components of a neighbourhood (paper section "Adaptive Splatting Using Local
/// Descriptors").
struct LocalShape {
  Vec3f normal;      ///< unit, e_3; its sign is arbitrary
  double lambda[3];  ///< variances along e_1, e_2, e_3 in m^2, descending, not negative

  /// (lambda_1 - lambda_2) / lambda_1; like the other two, 0 for a single point.
  ADASPLATS_HD double linearity() const { return share(lambda[0] - lambda[1]); }
  ADASPLATS_HD double planarity() const { return share(lambda[1] - lambda[2]); }
  ADASPLATS_HD double sphericity() const { return share(lambda[2]); }

 private:
  ADASPLATS_HD double share(double v) const { return lambda[0] > 0.0 ? v / lambda[0] : 0.0; }
};

ADASPLATS_HD inline SymmetricMat3d covariance(const Moments& m) {
  const double n = m.count > 0.0 ? m.count : 1.0;
  const Vec3d mean = m.sum / n;
  return {m.squares.xx / n - mean.x * mean.x, m.squares.xy / n - mean.x * mean.y,
          m.squares.xz / n - mean.x * mean.z, m.squares.yy / n - mean.y * mean.y,
          m.squares.yz / n - mean.y * mean.z, m.squares.zz / n - mean.z * mean.z};
}

/// Whether the smallest variance of a neighbourhood is at most `variance`: else the covariance
/// minus `variance` in all directions is positive definite (Sylvester's criterion). Many times
/// faster than local_shape().
ADASPLATS_HD inline bool is_flat(const Moments& moments, double variance) {
  const SymmetricMat3d c = covariance(moments);
  const double xx = c.xx - variance, yy = c.yy - variance, zz = c.zz - variance;
  const double xy = xx * yy - c.xy * c.xy;  // minor
  const double all = zz * xy - xx * c.yz * c.yz - yy * c.xz * c.xz + 2 * c.xy * c.yz * c.xz;
  return !(xx > 0 && xy > 0 && all > 0);
}

ADASPLATS_HD inline LocalShape shape_from(const SymmetricEigen& eigen) {
  LocalShape shape;
  shape.normal = vec_cast<float>(eigen.vectors[2]);
  // Rounding may leave a variance of zero slightly below it.
  for (int k = 0; k < 3; ++k) shape.lambda[k] = eigen.values[k] > 0.0 ? eigen.values[k] : 0.0;
  return shape;
}

/// PCA of a neighbourhood. With fewer than three points the normal has unit length but is
/// arbitrary.
ADASPLATS_HD inline LocalShape local_shape(const Moments& m) {
  return shape_from(symmetric_eigen(covariance(m)));
}

/// The largest descriptor (paper section "Adaptive Splatting Using Local Descriptors").
enum class ShapeKind : std::uint8_t { linear, planar, spherical };

ADASPLATS_HD inline ShapeKind kind_of(const LocalShape& shape) {
  const double linear = shape.linearity(), planar = shape.planarity(),
               spherical = shape.sphericity();
  if (planar >= linear && planar >= spherical) return ShapeKind::planar;
  return linear >= spherical ? ShapeKind::linear : ShapeKind::spherical;
}

/// |eq. point-to-plane|: distance of a neighbour, `offset` away from a point, to the plane through
/// that point.
ADASPLATS_HD inline float distance_to_plane(Vec3f offset, Vec3f normal) {
  return std::fabs(dot(normal, offset));
}

/// Rounding of PlaneDistances that makes them independent of the order of the points.
struct ExactDistances {
  ExactAddends distances;
  ExactAddends squares;

  /// For `count` distances of at most `largest_m`.
  ADASPLATS_HD ExactDistances(std::uint32_t count, float largest_m)
      : distances(count, static_cast<double>(largest_m)),
        squares(count, static_cast<double>(largest_m) * static_cast<double>(largest_m)) {}
};

/// Mean and spread of the distances of a neighbourhood to its plane.
struct PlaneDistances {
  double sum = 0;
  double sum_of_squares = 0;
  double count = 0;

  ADASPLATS_HD void add(float distance_m, const ExactDistances& exact) {
    const auto distance = static_cast<double>(distance_m);
    sum += exact.distances(distance);
    sum_of_squares += exact.squares(distance * distance);
    count += 1;
  }
  /// Paper section "Splat-Based Resampling and Denoising": the standard deviation of the unsigned
  /// distances.
  ADASPLATS_HD double sigma() const {
    const double mean = sum / count;
    const double variance = sum_of_squares / count - mean * mean;
    return std::sqrt(variance > 0.0 ? variance : 0.0);
  }
};

/// The normal oriented towards the sensor; `to_sensor` is the vector from the point to the sensor.
ADASPLATS_HD inline Vec3f oriented(Vec3f normal, Vec3f to_sensor) {
  return dot(normal, to_sensor) < 0.0F ? -normal : normal;
}

/// The normal with a canonical sign: the largest component is positive, so the result does not
/// depend on the eigensolver.
ADASPLATS_HD inline Vec3f with_canonical_sign(Vec3f normal) {
  const float ax = std::fabs(normal.x), ay = std::fabs(normal.y), az = std::fabs(normal.z);
  const float largest = az >= ax && az >= ay ? normal.z : (ax >= ay ? normal.x : normal.y);
  return largest < 0.0F ? -normal : normal;
}

}  // namespace adasplats
