// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <eigen3/Eigen/Dense>
#include <limits>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

Vec3d times(const SymmetricMat3d& m, Vec3d v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

/// Checks values against Eigen and vectors against what defines them.
void expect_eigen(const SymmetricMat3d& m, const SymmetricEigen& eigen) {
  Eigen::Matrix3d matrix;
  matrix << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> oracle(matrix);
  const double size = std::max(matrix.norm(), std::numeric_limits<double>::min());
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(eigen.values[k], oracle.eigenvalues()(2 - k), 1e-13 * size);
    EXPECT_NEAR(length(eigen.vectors[k]), 1, 1e-13);
    EXPECT_NEAR(dot(eigen.vectors[k], eigen.vectors[(k + 1) % 3]), 0, 1e-13);
    const Vec3d residual = times(m, eigen.vectors[k]) - eigen.values[k] * eigen.vectors[k];
    EXPECT_LE(length(residual), 1e-13 * size);
  }
}

TEST(SymmetricEigen, RandomMatricesOfAllSizes) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Random random(5, 0, i);
    const double size = std::pow(10.0, random.uniform(-12, 12));
    const auto element = [&] { return size * random.uniform(-1, 1); };
    const SymmetricMat3d m{element(), element(), element(), element(), element(), element()};
    expect_eigen(m, symmetric_eigen(m));
  }
}

// What points of a plane and of a line give: the interesting eigenvalue is next to nothing.
TEST(SymmetricEigen, NearlyFlatAndNearlyStraight) {
  for (std::uint64_t i = 0; i < 500; ++i) {
    Random random(6, 0, i);
    const auto element = [&] { return random.uniform(-1, 1); };
    const Vec3d a{element(), element(), element()};
    const Vec3d b = (i % 2 == 0 ? 1.0 : 1e-5) * Vec3d{element(), element(), element()};
    const SymmetricMat3d m{a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.x * a.z + b.x * b.z,
                           a.y * a.y + b.y * b.y, a.y * a.z + b.y * b.z, a.z * a.z + b.z * b.z};
    const SymmetricEigen eigen = symmetric_eigen(m);
    expect_eigen(m, eigen);
    EXPECT_NEAR(std::fabs(dot(eigen.vectors[2], normalized(cross(a, b)))), 1, 1e-6);
  }
}

// Oracle: analytic.
TEST(SymmetricEigen, DiagonalEqualAndZero) {
  const SymmetricEigen diagonal = symmetric_eigen({2, 0, 0, -7, 0, 5});
  EXPECT_EQ(diagonal.values[0], 5);
  EXPECT_EQ(diagonal.values[1], 2);
  EXPECT_EQ(diagonal.values[2], -7);
  EXPECT_TRUE((diagonal.vectors[0] == Vec3d{0, 0, 1}));
  for (const double value : {0.0, 3.0, 1e-300}) {
    const SymmetricMat3d m{value, 0, 0, value, 0, value};
    expect_eigen(m, symmetric_eigen(m));
  }
  const SymmetricMat3d one_direction{1, 1, 1, 1, 1, 1};
  const SymmetricEigen eigen = symmetric_eigen(one_direction);
  expect_eigen(one_direction, eigen);
  EXPECT_NEAR(eigen.values[0], 3, 1e-15);
}

TEST(SymmetricEigen, NaNComesBackAndDoesNotHang) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const SymmetricEigen eigen = symmetric_eigen({nan, nan, nan, nan, nan, nan});
  EXPECT_TRUE(std::isnan(eigen.values[0]));
}

}  // namespace
}  // namespace adasplats
