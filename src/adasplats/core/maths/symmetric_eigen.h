// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Symmetric 3x3 matrix, upper triangle.
struct SymmetricMat3d {
  double xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
};

/// Eigenvalues in descending order (lambda_1 >= lambda_2 >= lambda_3) with unit eigenvectors.
struct SymmetricEigen {
  double values[3];
  Vec3d vectors[3];
};

// The numbers of jacobi(): one double, or several in lanes (surface/shape_lanes.cpp).
ADASPLATS_HD_INLINED bool any_lane(bool mask) { return mask; }
ADASPLATS_HD_INLINED double chosen(bool mask, double yes, double no) { return mask ? yes : no; }
ADASPLATS_HD_INLINED double root_of(double x) { return std::sqrt(x); }
ADASPLATS_HD_INLINED double magnitude_of(double x) { return std::fabs(x); }

/// A symmetric matrix `a` on its way to diagonal form, and the rotations so far.
template <class Number>
struct JacobiState {
  Number a[3][3], v[3][3];

  /// Makes a[p][q] zero in the lanes of `active`.
  template <int p, int q, class Mask>
  ADASPLATS_HD_INLINED void rotate(const Mask& active) {
    constexpr int r = 3 - p - q;
    const Number apq = a[p][q];
    const Mask turned = active & (apq != Number(0.0));
    if (!any_lane(turned)) return;
    const Number one(1.0);
    const Number tau = (a[q][q] - a[p][p]) / (Number(2.0) * apq);
    const Number t = chosen(tau >= Number(0.0), one, Number(-1.0)) /
                     (magnitude_of(tau) + root_of(one + tau * tau));
    const Number c = one / root_of(one + t * t);
    const Number s = t * c;
    a[p][p] = chosen(turned, a[p][p] - t * apq, a[p][p]);
    a[q][q] = chosen(turned, a[q][q] + t * apq, a[q][q]);
    a[p][q] = a[q][p] = chosen(turned, Number(0.0), apq);
    const Number arp = a[r][p], arq = a[r][q];
    a[r][p] = a[p][r] = chosen(turned, c * arp - s * arq, arp);
    a[r][q] = a[q][r] = chosen(turned, s * arp + c * arq, arq);
    for (int k = 0; k < 3; ++k) {
      const Number vkp = v[k][p], vkq = v[k][q];
      v[k][p] = chosen(turned, c * vkp - s * vkq, vkp);
      v[k][q] = chosen(turned, s * vkp + c * vkq, vkq);
    }
  }
  /// Swaps the values and vectors i and j where value i is the smaller one.
  template <int i, int j>
  ADASPLATS_HD_INLINED void sort() {
    const auto swapped = a[i][i] < a[j][j];
    const Number first = a[i][i];
    a[i][i] = chosen(swapped, a[j][j], first);
    a[j][j] = chosen(swapped, first, a[j][j]);
    for (int k = 0; k < 3; ++k) {
      const Number vki = v[k][i];
      v[k][i] = chosen(swapped, v[k][j], vki);
      v[k][j] = chosen(swapped, vki, v[k][j]);
    }
  }
};

/// Cyclic Jacobi (Golub and Van Loan, "Matrix computations", 8.5): only + - * / and sqrt, which
/// IEEE 754 rounds the same way everywhere, so host and device agree bit by bit. Leaves the
/// eigenvalues in the diagonal of a, descending, and their vectors in the columns of v.
template <class Number>
ADASPLATS_HD_INLINED void jacobi(JacobiState<Number>& m) {
  const Number size = m.a[0][0] * m.a[0][0] + m.a[1][1] * m.a[1][1] + m.a[2][2] * m.a[2][2];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) m.v[row][column] = Number(row == column ? 1.0 : 0.0);
  for (int sweep = 0; sweep < 12; ++sweep) {
    const Number off = m.a[0][1] * m.a[0][1] + m.a[0][2] * m.a[0][2] + m.a[1][2] * m.a[1][2];
    const auto active = off > Number(1e-30) * size;
    if (!any_lane(active)) break;
    m.template rotate<0, 1>(active);
    m.template rotate<0, 2>(active);
    m.template rotate<1, 2>(active);
  }
  m.template sort<0, 1>();
  m.template sort<1, 2>();
  m.template sort<0, 1>();
}

ADASPLATS_HD inline SymmetricEigen symmetric_eigen(const SymmetricMat3d& m) {
  JacobiState<double> state = {{{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}}, {}};
  jacobi(state);
  SymmetricEigen result;
  for (int k = 0; k < 3; ++k) {
    result.values[k] = state.a[k][k];
    result.vectors[k] = {state.v[0][k], state.v[1][k], state.v[2][k]};
  }
  return result;
}

}  // namespace adasplats
