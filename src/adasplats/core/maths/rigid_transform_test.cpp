// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/rigid_transform.h"

#include <gtest/gtest.h>

#include <eigen3/Eigen/Dense>
#include <numbers>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/yaw_pitch_roll.h"

namespace adasplats {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_near(Vec3d a, Vec3d b, double tolerance = 1e-15) {
  EXPECT_LE(length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

// Oracle: analytic, quarter turns.
TEST(Rotation, YawTurnsLeftPitchTurnsDownRollTurnsLeftSideUp) {
  expect_near(rotation_from_yaw_pitch_roll(kPi / 2, 0, 0) * Vec3d{1, 0, 0}, {0, 1, 0});
  expect_near(rotation_from_yaw_pitch_roll(0, kPi / 2, 0) * Vec3d{1, 0, 0}, {0, 0, -1});
  expect_near(rotation_from_yaw_pitch_roll(0, 0, kPi / 2) * Vec3d{0, 1, 0}, {0, 0, 1});
  // Roll first, yaw last.
  expect_near(rotation_from_yaw_pitch_roll(kPi / 2, 0, kPi / 2) * Vec3d{0, 1, 0}, {0, 0, 1});
  expect_near(rotation_from_yaw_pitch_roll(kPi / 2, 0, kPi / 2) * Vec3d{1, 0, 0}, {0, 1, 0});
}

// Oracle: Eigen.
TEST(Rotation, AsEigen) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    Random random(3, 0, i);
    const double yaw = random.uniform(-4, 4), pitch = random.uniform(-2, 2),
                 roll = random.uniform(-4, 4);
    const Eigen::Quaterniond q = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
    const Eigen::Matrix3d expected = q.toRotationMatrix();
    const Mat3d by_angles = rotation_from_yaw_pitch_roll(yaw, pitch, roll);
    const Mat3d by_quaternion = rotation_from_quaternion(q.w(), q.x(), q.y(), q.z());
    for (int r = 0; r < 3; ++r) {
      const Vec3d row{expected(r, 0), expected(r, 1), expected(r, 2)};
      expect_near(by_angles.rows[r], row, 1e-14);
      expect_near(by_quaternion.rows[r], row, 1e-14);
    }
  }
}

// Oracle: round trip, also straight up and down, where noise must not decide.
TEST(Rotation, YawPitchAndRollOfIt) {
  const Vec3d angles = yaw_pitch_roll_deg(rotation_from_yaw_pitch_roll(-2.5, 0.7, 3));
  expect_near(angles, (180 / kPi) * Vec3d{-2.5, 0.7, 3}, 1e-12);
  const Mat3d turn = rotation_from_yaw_pitch_roll(0.3, 0.2, 0.1);
  for (const double pitch_deg : {0.0, 45.0, 89.9, 90.0, -90.0}) {
    const Mat3d rotation =
        turn.transposed() * (turn * rotation_from_yaw_pitch_roll(1, pitch_deg * kPi / 180, 2));
    const Vec3d back = (kPi / 180) * yaw_pitch_roll_deg(rotation);
    EXPECT_LT(angle_between(rotation_from_yaw_pitch_roll(back.x, back.y, back.z), rotation), 2e-7)
        << pitch_deg;
  }
}

TEST(Mat3d, ProductsAndTranspose) {
  const Mat3d a{{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}}, b{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
  const Vec3d v{1, -1, 2};
  expect_near((a * b) * v, a * (b * v), 0);
  EXPECT_TRUE((a.transposed().rows[0] == Vec3d{1, 4, 7}));
  EXPECT_TRUE((Mat3d{} * v == v));
}

TEST(RigidTransform, CompositionAndInverse) {
  const RigidTransform world_from_car{rotation_from_yaw_pitch_roll(0.3, -0.1, 0.7), {10, -20, 3}};
  const RigidTransform car_from_sensor{rotation_from_yaw_pitch_roll(-2, 0.4, 0), {1, 0, 1.7}};
  const Vec3d p{5, 6, 7};
  expect_near((world_from_car * car_from_sensor) * p, world_from_car * (car_from_sensor * p),
              1e-14);
  expect_near(world_from_car.inverse() * (world_from_car * p), p, 1e-14);
  expect_near(RigidTransform{} * p, p, 0);
}

// Oracle: analytic; a turn far below the square root of the precision, where a cosine sees nothing.
TEST(Rotation, AngleBetweenTwoHoldsFromNothingToHalfATurn) {
  const Mat3d a = rotation_from_yaw_pitch_roll(0.4, -0.2, 1.1);
  EXPECT_LE(angle_between(a, a), 1e-15);
  for (const double angle : {1e-12, 0.3, 3.1}) {
    EXPECT_NEAR(angle_between(a, a * rotation_from_yaw_pitch_roll(0, angle, 0)), angle, 1e-15);
  }
  EXPECT_NEAR(angle_between(a, a * rotation_from_yaw_pitch_roll(kPi, 0, 0)), kPi, 1e-15);
}

}  // namespace
}  // namespace adasplats
