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

/// Cyclic Jacobi (Golub and Van Loan, "Matrix computations", 8.5): only + - * / and sqrt, which
/// IEEE 754 rounds the same way everywhere, so host and device agree bit by bit.
ADASPLATS_HD inline SymmetricEigen symmetric_eigen(const SymmetricMat3d& m) {
  double a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double size = m.xx * m.xx + m.yy * m.yy + m.zz * m.zz;
  for (int sweep = 0; sweep < 12; ++sweep) {
    const double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    if (!(off > 1e-30 * size)) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0.0) continue;
        const double tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        const double t = (tau >= 0 ? 1.0 : -1.0) / (std::fabs(tau) + std::sqrt(1.0 + tau * tau));
        const double c = 1.0 / std::sqrt(1.0 + t * t);
        const double s = t * c;
        const int r = 3 - p - q;
        const double apq = a[p][q];
        a[p][p] -= t * apq;
        a[q][q] += t * apq;
        a[p][q] = a[q][p] = 0.0;
        const double arp = a[r][p], arq = a[r][q];
        a[r][p] = a[p][r] = c * arp - s * arq;
        a[r][q] = a[q][r] = s * arp + c * arq;
        for (int k = 0; k < 3; ++k) {
          const double vkp = v[k][p], vkq = v[k][q];
          v[k][p] = c * vkp - s * vkq;
          v[k][q] = s * vkp + c * vkq;
        }
      }
    }
  }
  int order[3] = {0, 1, 2};
  const auto swap_if_less = [&](int i, int j) {
    if (a[order[i]][order[i]] < a[order[j]][order[j]]) {
      const int o = order[i];
      order[i] = order[j];
      order[j] = o;
    }
  };
  swap_if_less(0, 1);
  swap_if_less(1, 2);
  swap_if_less(0, 1);
  SymmetricEigen result;
  for (int k = 0; k < 3; ++k) {
    result.values[k] = a[order[k]][order[k]];
    result.vectors[k] = {v[0][order[k]], v[1][order[k]], v[2][order[k]]};
  }
  return result;
}

}  // namespace adasplats
