// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

// Oracle of all tests here: analytic.

void expect_near(Vec3f found, Vec3d expected, double tolerance = 1e-6) {
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(static_cast<double>(found[axis]), expected[axis], tolerance) << "axis " << axis;
}

Camera square_camera(double fov_rad) {
  Camera camera;
  camera.width = 100;
  camera.height = 100;
  camera.horizontal_fov_rad = fov_rad;
  return camera;
}

TEST(Camera, TheMiddleLooksForward) {
  const Ray ray = square_camera(1.0).ray(50, 50, {0, 0, 0});
  expect_near(ray.origin, {0, 0, 0});
  expect_near(ray.direction, {1, 0, 0});
}

TEST(Camera, TheFieldOfViewReachesTheBorders) {
  const Camera camera = square_camera(std::acos(0.0));  // 90 degrees
  const double half = std::sqrt(0.5);
  expect_near(camera.ray(0, 50, {}).direction, {half, half, 0});
  expect_near(camera.ray(100, 50, {}).direction, {half, -half, 0});
  expect_near(camera.ray(50, 0, {}).direction, {half, 0, half});
  expect_near(camera.ray(50, 100, {}).direction, {half, 0, -half});
}

TEST(Camera, RaysAreRelativeToTheScenesOrigin) {
  Camera camera = square_camera(1.0);
  camera.world_from_camera.translation = {650'001, 6'860'002, 38};
  expect_near(camera.ray(10, 10, {650'000, 6'860'000, 35}).origin, {1, 2, 3});
}

TEST(Camera, ParallelRaysStartSideBySide) {
  Camera camera = square_camera(1.0);
  camera.height = 50;
  camera.orthographic_width_m = 10;
  expect_near(camera.ray(0, 0, {}).origin, {0, 5, 2.5});
  expect_near(camera.ray(100, 50, {}).origin, {0, -5, -2.5});
  expect_near(camera.ray(100, 50, {}).direction, {1, 0, 0});
}

TEST(LookAt, LooksAtTheTargetWithZUp) {
  const Camera camera = look_at({1, 2, 3}, {1, 12, 3});
  expect_near(camera.ray(1280, 720, {}).origin, {1, 2, 3});
  expect_near(camera.ray(1280, 720, {}).direction, {0, 1, 0});
  EXPECT_GT(camera.ray(2560, 720, {}).direction.x, 0.1F) << "right of +y is +x";
  EXPECT_GT(camera.ray(1280, 0, {}).direction.z, 0.1F) << "the image's top is up";
}

TEST(LookAt, HasARotationForEveryDirection) {
  for (const Vec3d target :
       {Vec3d{0, 0, -1}, Vec3d{0, 0, 1}, Vec3d{1e-12, 0, -1}, Vec3d{1, 2, 3}, Vec3d{-1, 0, 0}}) {
    const Mat3d r = look_at({0, 0, 0}, target).world_from_camera.rotation;
    const Mat3d unit = r * r.transposed();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(unit.rows[i][k], i == k ? 1 : 0, 1e-12);
    EXPECT_NEAR(dot(cross(r.rows[0], r.rows[1]), r.rows[2]), 1.0, 1e-12) << "right-handed";
    expect_near(vec_cast<float>(r * Vec3d{1, 0, 0}), normalized(target));
  }
}

TEST(LookAt, OnePointIsAUsageError) {
  EXPECT_THROW(look_at({1, 2, 3}, {1, 2, 3}), Error);
  EXPECT_THROW(look_at({1, 2, 3}, {std::numeric_limits<double>::quiet_NaN(), 2, 3}), Error);
}

TEST(BirdsEye, LooksDownWithNorthUpAndHoldsTheBox) {
  const Camera camera = birds_eye({-10, -20, 0}, {10, 20, 8}, 400, 200);
  const Ray middle = camera.ray(200, 100, {});
  expect_near(middle.direction, {0, 0, -1});
  EXPECT_GT(middle.origin.z, 8.0F);
  const Ray top_left = camera.ray(0, 0, {}), bottom_right = camera.ray(400, 200, {});
  EXPECT_LT(top_left.origin.x, -10.0F);
  EXPECT_GT(top_left.origin.y, 20.0F);
  EXPECT_GT(bottom_right.origin.x, 10.0F);
  EXPECT_LT(bottom_right.origin.y, -20.0F);
  EXPECT_LT(top_left.origin.y, 21.0F) << "the box fills the image";
}

TEST(BirdsEye, TakesAPointAndRefusesNonsense) {
  expect_near(birds_eye({5, 6, 7}, {5, 6, 7}, 10, 10).ray(5, 5, {}).origin, {5, 6, 8});
  EXPECT_THROW(birds_eye({0, 0, 0}, {1, 1, 1}, 0, 10), Error);
  EXPECT_THROW(birds_eye({0, 0, 0}, {-1, 1, 1}, 10, 10), Error);
  EXPECT_THROW(birds_eye({0, 0, 0}, {std::numeric_limits<double>::infinity(), 1, 1}, 10, 10),
               Error);
}

}  // namespace
}  // namespace adasplats
