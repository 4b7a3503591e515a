// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/recognize_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// How far a ray goes in a yard of 50 x 30 m with walls of 12 m, the road at z = 0; 0: to the sky.
double range_in_yard(Vec3d origin, Vec3d direction) {
  const Vec3d low = {-22, -12, 0}, high = {28, 18, 12};
  double range_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0 || (axis == 2 && direction.z > 0)) continue;
    const double wall = direction[axis] > 0 ? high[axis] : low[axis];
    range_m = std::min(range_m, (wall - origin[axis]) / direction[axis]);
  }
  return origin.z + range_m * direction.z > high.z ? 0 : range_m;
}

/// Points of two places in the vehicle's frame, whose origin is on the road.
std::vector<Vec3d> scan_with(const std::string& name, const RigidTransform& mount) {
  const LidarModel sensor = load_lidar_model(name);
  const std::vector<Firing> firings = firings_of(sensor);
  std::vector<Vec3d> points;
  for (int place = 0; place < 2; ++place) {
    const RigidTransform vehicle = {rotation_from_yaw_pitch_roll(0.7 * place, 0, 0),
                                    {6.0 * place, 2.0 * place, 0}};
    const RigidTransform pose = vehicle * mount;
    for (std::size_t i = 0; i < firings.size(); i += 11) {
      Random random(4, static_cast<std::uint64_t>(place), i);
      const Vec3d from = pose * vec_cast<double>(firings[i].origin);
      const Vec3d direction = pose.rotation * vec_cast<double>(firings[i].direction);
      const double range_m = range_in_yard(from, direction);
      if (range_m > 0)
        points.push_back(vehicle.inverse() *
                         (from + (range_m + 0.02 * random.normal()) * direction));
    }
  }
  return points;
}

std::vector<SensorCones> tables(const std::vector<std::string>& names) {
  std::vector<SensorCones> cones;
  for (const std::string& name : names) cones.push_back(cones_of(load_lidar_model(name)));
  return cones;
}

void expect_found(const std::string& name, const RigidTransform& mount,
                  const std::vector<SensorCones>& candidates) {
  const auto found = recognize_sensor(scan_with(name, mount), candidates, Executor(2));
  ASSERT_TRUE(found) << name;
  EXPECT_EQ(found->cones.sensor, name);
  EXPECT_GT(found->confidence(), 0.4);
  const Vec3d axis = mount.rotation * Vec3d{0, 0, 1};
  const Vec3d found_axis = found->vehicle_from_sensor.rotation * Vec3d{0, 0, 1};
  EXPECT_LT(length(found_axis - axis), 0.05 * kDegree);
  EXPECT_LT(length(found->vehicle_from_sensor.translation - mount.translation), 0.02);
}

// Oracle: the mount that the points were made with.
TEST(RecognizeSensor, FindsTheSensorAndItsMount) {
  const auto candidates = tables({"hesai-pandar64", "velodyne-hdl-32e"});
  expect_found("hesai-pandar64",
               {rotation_from_yaw_pitch_roll(0, 0.1 * kDegree, 0.9 * kDegree), {0, 0.76, 1.85}},
               candidates);
}

TEST(RecognizeSensor, PointsInTheSensorsFrameNeedNoSearch) {
  const std::vector<Vec3d> points = scan_with("velodyne-hdl-32e", {{}, {0, 0, 1.7}});
  std::vector<Vec3d> of_sensor;
  for (const Vec3d p : points) of_sensor.push_back(p - Vec3d{0, 0, 1.7});
  const auto found = recognize_sensor(of_sensor, library_cones(), Executor(2));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cones.sensor, "velodyne-hdl-32e");
  EXPECT_LT(length(found->vehicle_from_sensor.translation), 0.02);
}

TEST(RecognizeSensor, TheSameOnAnyNumberOfThreads) {
  const auto candidates = tables({"velodyne-vlp-32c"});
  const auto points = scan_with("velodyne-vlp-32c", {{}, {0.5, 0, 1.6}});
  const auto one = recognize_sensor(points, candidates, Executor(1));
  const auto three = recognize_sensor(points, candidates, Executor(3));
  ASSERT_EQ(one.has_value(), three.has_value());
  if (one) {
    EXPECT_EQ(one->vehicle_from_sensor.translation, three->vehicle_from_sensor.translation);
    EXPECT_EQ(one->residual_rad, three->residual_rad);
  }
}

TEST(RecognizeSensor, WhatNoTableExplainsIsRefused) {
  const auto candidates = tables({"velodyne-vlp-16"});
  std::vector<Vec3d> ball;
  for (std::size_t i = 0; i < 4000; ++i) {
    Random random(9, 0, i);
    const auto number = [&] { return random.uniform(-20, 20); };
    ball.push_back({number(), number(), 0.3 * number()});
  }
  EXPECT_FALSE(recognize_sensor(ball, candidates, Executor(2)));
  EXPECT_FALSE(recognize_sensor(std::span(ball).first(300), candidates, Executor(2)));
  EXPECT_FALSE(recognize_sensor({}, candidates, Executor(1)));
  EXPECT_FALSE(recognize_sensor(ball, {}, Executor(1)));
}

TEST(RecognizeSensor, AnotherTableIsNotTaken) {
  const auto points = scan_with("hesai-pandar64", {{}, {0, 0, 1.8}});
  EXPECT_FALSE(recognize_sensor(points, tables({"velodyne-vlp-16"}), Executor(2)));
}

TEST(SensorCones, TheNearestLaserIsThatOfTheElevation) {
  const SensorCones cones = cones_of(load_lidar_model("velodyne-vlp-16"));
  ASSERT_EQ(cones.cones.size(), 16U);
  const auto [laser, residual_rad] =
      cones.nearest({10 * std::cos(3.2 * kDegree), 0, 10 * std::sin(3.2 * kDegree)});
  EXPECT_NEAR(cones.cones[laser].elevation_rad, 3 * kDegree, 1e-6);
  EXPECT_NEAR(residual_rad, 0.2 * kDegree, 0.02 * kDegree);
}

TEST(SensorCones, OfTheLibraryAreSortedFromTheTop) {
  const auto library = library_cones();
  EXPECT_GE(library.size(), 12U);
  for (const SensorCones& cones : library)
    EXPECT_TRUE(std::is_sorted(
        cones.cones.begin(), cones.cones.end(),
        [](const auto& a, const auto& b) { return a.elevation_rad > b.elevation_rad; }))
        << cones.sensor;
}

}  // namespace
}  // namespace adasplats
