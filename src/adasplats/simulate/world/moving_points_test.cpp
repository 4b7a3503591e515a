// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/moving_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr std::uint16_t kRoad = 40, kCar = 10, kMovingCar = 252, kMovingPerson = 254;

class MovingSplatsTest : public testing::Test {
 protected:
  void add(Vec3f position, std::uint16_t class_id, std::uint16_t instance = 0) {
    scan_.positions.push_back(position);
    scan_.classes.push_back(class_id);
    scan_.instances.push_back(instance);
    scan_.intensities.push_back(static_cast<float>(scan_.positions.size()));
  }
  /// A grid of points in the plane x = `x`.
  void add_wall(float x, std::uint16_t class_id, std::uint16_t instance) {
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 6; ++column)
        add({x, 0.1F * static_cast<float>(column), 0.1F * static_cast<float>(row)}, class_id,
            instance);
  }
  MovingSplats make(int threads = 2) const {
    return moving_splats(scan_, semantickitti_labels(), options_, Executor(threads));
  }

  KittiScan scan_;
  MovingSplatOptions options_;
};

TEST_F(MovingSplatsTest, OneSplatForEveryMovingPoint) {
  add({1, 0, 0}, kRoad, 1);
  add({5, 0, 0}, kMovingPerson, 7);
  add({2, 0, 0}, kCar, 2);
  add({6, 0, 0}, kMovingCar, 9);
  add({7, 0, 0}, 999, 3);
  const MovingSplats moving = make();
  ASSERT_EQ(moving.splats.size(), 2U);
  EXPECT_EQ(moving.splats.classes, (std::vector<std::uint16_t>{kMovingPerson, kMovingCar}));
  EXPECT_EQ(moving.instances, (std::vector<std::uint16_t>{7, 9}));
  EXPECT_EQ(moving.splats.intensities, (std::vector<float>{2, 4}));
  EXPECT_EQ(moving.splats.disks[1].center, (Vec3f{6, 0, 0}));
  EXPECT_EQ(moving.splats.disks[1].radius, 0.14F);
  EXPECT_EQ(moving.splats.origin, Vec3d{});
  EXPECT_EQ(moving.splats.label_scheme, "semantickitti");
}

// Oracle: the tables of the response.
TEST_F(MovingSplatsTest, IntensitiesBecomeReflectances) {
  add_wall(8, kMovingCar, 1);
  add({10, 0, 0}, kMovingPerson, 2);
  IntensityResponse response;
  response.ranges_m = {5, 20};
  response.range_gains = {1, 0.25F};
  response.cos_incidences = {0, 1};
  response.incidence_gains = {0.5F, 1};
  options_.response = &response;
  const MovingSplats moving = make();
  EXPECT_NEAR(moving.splats.intensities.back(), 37 / 0.75F, 1e-4F);
  const Vec3f corner = scan_.positions[35];
  const float range_m = length(corner);
  const float gain = (1 - 0.75F * (range_m - 5) / 15) * (0.5F + 0.5F * corner.x / range_m);
  EXPECT_NEAR(moving.splats.intensities[35], 36 / gain, 1e-3F);
  const IntensityResponse none;
  options_.response = &none;
  EXPECT_EQ(make().splats.intensities.back(), 37);
}

// Oracle: the plane that the points were put in.
TEST_F(MovingSplatsTest, NormalsOfAPlaneOnTheSensorsSide) {
  add_wall(8, kMovingCar, 1);
  add_wall(-3, kMovingCar, 2);
  for (const Disk& disk : make().splats.disks) {
    EXPECT_NEAR(disk.normal.x, disk.center.x > 0 ? -1 : 1, 1e-5);
    EXPECT_NEAR(length(disk.normal), 1, 1e-6);
  }
}

// Oracle: two planes at a right angle, 5 cm apart: what one object has is no neighbour of the
// other.
TEST_F(MovingSplatsTest, NeighboursAreOfTheSameObject) {
  add_wall(8, kMovingCar, 1);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      add({8.05F + 0.1F * static_cast<float>(column), 0.25F, 0.1F * static_cast<float>(row)},
          kMovingCar, 2);
  const MovingSplats moving = make();
  for (std::size_t i = 0; i < moving.splats.size(); ++i) {
    const Vec3f normal = moving.splats.disks[i].normal;
    EXPECT_NEAR(std::fabs(moving.instances[i] == 1 ? normal.x : normal.y), 1, 1e-5) << i;
  }
}

// Oracle: the direction to the sensor.
TEST_F(MovingSplatsTest, PointsWithoutNormalFaceTheSensor) {
  add({3, 4, 0}, kMovingPerson, 1);  // alone
  add({0, 5, 0}, kMovingPerson, 2);  // two
  add({0, 5, 0.1F}, kMovingPerson, 2);
  for (int i = 0; i < 9; ++i)  // a ring
    add({20, 0.05F * static_cast<float>(i), 0.001F * static_cast<float>(i % 2)}, kMovingCar, 3);
  for (int i = 0; i < 4; ++i) add({6, 3, 0}, kMovingCar, 4);  // equal
  for (int i = 0; i < 4; ++i)                                 // beyond the reach of each other
    add({9, 2.0F * static_cast<float>(i), static_cast<float>(i % 2)}, kMovingCar, 5);
  const MovingSplats moving = make();
  ASSERT_EQ(moving.splats.size(), scan_.positions.size());
  for (const Disk& disk : moving.splats.disks)
    EXPECT_NEAR(length(disk.normal + normalized(disk.center)), 0, 1e-6);
}

TEST_F(MovingSplatsTest, NothingAndBrokenPoints) {
  EXPECT_EQ(make().splats.size(), 0U);
  add({NAN, 0, 0}, kMovingCar);
  add({0, HUGE_VALF, 0}, kMovingCar);
  add({0, 0, 0}, kMovingCar);
  EXPECT_EQ(make().splats.size(), 0U);
  add({1, 0, 0}, kMovingCar);
  EXPECT_EQ(make().splats.size(), 1U);
  scan_.instances.clear();
  scan_.intensities.clear();
  EXPECT_EQ(make().instances, std::vector<std::uint16_t>{0});
  EXPECT_TRUE(make().splats.intensities.empty());
  scan_.classes.clear();
  EXPECT_EQ(make().splats.size(), 0U) << "without labels nothing moves";
  for (const double radius_m : {0.0, -1.0, static_cast<double>(NAN)}) {
    options_.radius_m = radius_m;
    EXPECT_THROW(make(), Error);
  }
}

TEST_F(MovingSplatsTest, SameBytesOnAnyThreads) {
  for (std::size_t i = 0; i < 9000; ++i) {
    Random random(5, i, 0);
    const auto draw = [&] { return static_cast<float>(random.normal()); };
    add({10 + draw(), draw(), draw()}, kMovingCar, static_cast<std::uint16_t>(i % 3));
  }
  const MovingSplats expected = make(1);
  const MovingSplats moving = make(3);
  ASSERT_EQ(moving.splats.size(), expected.splats.size());
  for (std::size_t i = 0; i < moving.splats.size(); ++i)
    ASSERT_EQ(moving.splats.disks[i].normal, expected.splats.disks[i].normal);
}

}  // namespace
}  // namespace adasplats
