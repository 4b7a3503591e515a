// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/rotation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adasplats {

namespace {

double determinant(const Mat3d& m) { return dot(m.rows[0], cross(m.rows[1], m.rows[2])); }

Quaternion normalized(Quaternion q) {
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const double sign = q.w < 0 ? -1.0 / norm : 1.0 / norm;
  return {sign * q.w, sign * q.x, sign * q.y, sign * q.z};
}

}  // namespace

Quaternion quaternion_from_rotation(const Mat3d& rotation) {
  const Vec3d* m = rotation.rows;
  // Shepperd's method: divide by the largest of the four components, which is at least 1/2.
  const double trace = m[0].x + m[1].y + m[2].z;
  if (trace >= m[0].x && trace >= m[1].y && trace >= m[2].z)
    return normalized({1 + trace, m[2].y - m[1].z, m[0].z - m[2].x, m[1].x - m[0].y});
  if (m[0].x >= m[1].y && m[0].x >= m[2].z)
    return normalized(
        {m[2].y - m[1].z, 1 + m[0].x - m[1].y - m[2].z, m[0].y + m[1].x, m[2].x + m[0].z});
  if (m[1].y >= m[2].z)
    return normalized(
        {m[0].z - m[2].x, m[0].y + m[1].x, 1 + m[1].y - m[0].x - m[2].z, m[1].z + m[2].y});
  return normalized(
      {m[1].x - m[0].y, m[2].x + m[0].z, m[1].z + m[2].y, 1 + m[2].z - m[0].x - m[1].y});
}

Mat3d slerp(const Quaternion& a, const Quaternion& b, double s) {
  double cosine = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
  // q and -q are the same rotation; the one on a's side is the short way.
  const double side = cosine < 0 ? -1.0 : 1.0;
  cosine = std::min(1.0, side * cosine);
  const double angle = std::acos(cosine);
  const double sine = std::sin(angle);
  // For a vanishing angle, linear interpolation is exact and avoids 0 / 0.
  const double of_a = sine > 1e-9 ? std::sin((1 - s) * angle) / sine : 1 - s;
  const double of_b = side * (sine > 1e-9 ? std::sin(s * angle) / sine : s);
  const Quaternion q = normalized({of_a * a.w + of_b * b.w, of_a * a.x + of_b * b.x,
                                   of_a * a.y + of_b * b.y, of_a * a.z + of_b * b.z});
  return rotation_from_quaternion(q.w, q.x, q.y, q.z);
}

double orthonormality_error(const Mat3d& m) {
  if (determinant(m) < 0) return std::numeric_limits<double>::infinity();
  const Mat3d product = m * m.transposed();
  double worst = 0;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::fabs(product.rows[r][c] - (r == c ? 1.0 : 0.0)));
  return worst;
}

Mat3d orthonormalized(const Mat3d& m) {
  // Newton's iteration to the polar factor (Higham 1986): m <- (m + inverse(transposed(m))) / 2
  // squares the error each time, so from 1e-3 four steps reach the last bit.
  Mat3d r = m;
  for (int step = 0; step < 4; ++step) {
    const double det = determinant(r);
    const Vec3d cofactors[3] = {cross(r.rows[1], r.rows[2]), cross(r.rows[2], r.rows[0]),
                                cross(r.rows[0], r.rows[1])};
    for (int row = 0; row < 3; ++row) r.rows[row] = 0.5 * (r.rows[row] + cofactors[row] / det);
  }
  return r;
}

}  // namespace adasplats
