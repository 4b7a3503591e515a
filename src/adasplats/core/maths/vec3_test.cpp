// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/vec3.h"

#include <gtest/gtest.h>

#include <limits>

#include "adasplats/core/constants.h"

namespace adasplats {
namespace {

TEST(Vec3, Arithmetic) {
  constexpr Vec3d a{1, 2, 3}, b{-4, 5, 0.5};
  EXPECT_TRUE((a + b == Vec3d{-3, 7, 3.5}));
  EXPECT_TRUE((a - b == Vec3d{5, -3, 2.5}));
  EXPECT_TRUE((-a == Vec3d{-1, -2, -3}));
  EXPECT_TRUE((2.0 * a == Vec3d{2, 4, 6}));
  EXPECT_TRUE((a * 2.0 == a / 0.5));
  EXPECT_EQ(dot(a, b), 7.5);
  EXPECT_EQ(length(Vec3d{2, 3, 6}), 7.0);
  EXPECT_TRUE((min(a, b) == Vec3d{-4, 2, 0.5}));
  EXPECT_TRUE((max(a, b) == Vec3d{1, 5, 3}));
}

// Oracle: analytic, the right hand.
TEST(Vec3, CrossIsRightHanded) {
  EXPECT_TRUE((cross(Vec3d{1, 0, 0}, Vec3d{0, 1, 0}) == Vec3d{0, 0, 1}));
  EXPECT_TRUE((cross(Vec3d{0, 1, 0}, Vec3d{0, 0, 1}) == Vec3d{1, 0, 0}));
  const Vec3d a{1, 2, 3}, b{-4, 5, 0.5};
  EXPECT_EQ(dot(cross(a, b), a), 0.0);
  EXPECT_EQ(dot(cross(a, b), b), 0.0);
}

TEST(Vec3, Elements) {
  Vec3f v{1, 2, 3};
  v[1] = 7;
  EXPECT_EQ(v.y, 7.0F);
  const Vec3f& fixed = v;
  EXPECT_EQ(fixed[0] + fixed[1] + fixed[2], 11.0F);
  EXPECT_TRUE((vec_cast<double>(v) == Vec3d{1, 7, 3}));
  EXPECT_TRUE((Vec3f{} == Vec3f{0, 0, 0}));
}

TEST(Vec3, Normalized) {
  EXPECT_NEAR(length(normalized(Vec3d{3, -4, 12})), 1.0, 1e-15);
  EXPECT_FALSE(is_finite(normalized(Vec3d{})));
}

TEST(Vec3, IsFinite) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kMax = std::numeric_limits<float>::max();
  EXPECT_TRUE(is_finite(Vec3f{kMax, -kMax, 0}));
  for (const float bad : {kInf, -kInf, static_cast<float>(kNaN)}) {
    EXPECT_FALSE(is_finite(Vec3f{bad, 0, 0}));
    EXPECT_FALSE(is_finite(Vec3f{0, bad, 0}));
    EXPECT_FALSE(is_finite(Vec3f{0, 0, bad}));
  }
}

}  // namespace
}  // namespace adasplats
