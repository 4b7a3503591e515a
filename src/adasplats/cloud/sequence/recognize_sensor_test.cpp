// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/recognize_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr std::size_t kPoints = 3000;

/// How far a ray goes in a hall of 80 by 24 m, whose floor is 1.9 m below the origin and whose roof
/// is 10 m above.
double range_in_long_hall(Vec3d origin, Vec3d way) {
  const Vec3d low = {-40, -12, -1.9}, high = {40, 12, 10};
  double range_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double wall = way[axis] > 0 ? high[axis] : low[axis];
    if (way[axis] != 0) range_m = std::min(range_m, (wall - origin[axis]) / way[axis]);
  }
  return range_m;
}

/// Some of a scan, in the frame of the vehicle, with noise of 2 cm along the beams and of 0.02
/// degrees across.
std::vector<Vec3d> scan_in_hall(const std::string& sensor, const RigidTransform& mount) {
  const std::vector<Firing> firings = firings_of(load_lidar_model(sensor));
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < kPoints; ++i) {
    Random random(11, 0, i);
    const auto at =
        static_cast<std::size_t>(random.uniform() * static_cast<double>(firings.size()));
    const Vec3d noise = {random.normal(), random.normal(), random.normal()};
    const Vec3d origin = mount.rotation * vec_cast<double>(firings[at].origin);
    const Vec3d way = normalized(mount.rotation * vec_cast<double>(firings[at].direction) +
                                 (0.02 * kDegree) * noise);
    const double range_m = range_in_long_hall(origin, way) + 0.02 * random.normal();
    points.push_back(mount.translation + origin + range_m * way);
  }
  return points;
}

std::vector<SensorCones> cones_of_all(const std::vector<std::string>& sensors) {
  std::vector<SensorCones> cones;
  cones.reserve(sensors.size());
  for (const std::string& sensor : sensors) cones.push_back(cones_of(load_lidar_model(sensor)));
  return cones;
}

RigidTransform mount_at(Vec3d origin, double roll_deg, double pitch_deg) {
  return {rotation_from_yaw_pitch_roll(0, pitch_deg * kDegree, roll_deg * kDegree), origin};
}

void expect_recognized(const std::optional<Recognition>& found, const std::string& sensor,
                       const RigidTransform& mount) {
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cones.sensor, sensor);
  EXPECT_LT(length(found->vehicle_from_sensor.translation - mount.translation), 0.02);
  EXPECT_LT(angle_between(found->vehicle_from_sensor.rotation, mount.rotation), 0.05 * kDegree);
  EXPECT_LT(found->residual_rad, 0.03 * kDegree);
  EXPECT_GT(found->confidence(), 0.5);
}

TEST(RecognizeSensor, PointsOfFiringsLieOnTheirCones) {
  const std::vector<SensorCones> library = library_cones();
  // All but a rosette (livox-mid-40) and two that no maker sells.
  EXPECT_EQ(library.size() + 3, lidar_model_names().size());
  for (const SensorCones& cones : library) {
    const std::vector<Firing> firings = firings_of(load_lidar_model(cones.sensor));
    for (std::size_t i = 0; i < firings.size(); i += 97) {
      const Vec3d point =
          vec_cast<double>(firings[i].origin) + 12.0 * vec_cast<double>(firings[i].direction);
      const auto [laser, residual_rad] = cones.nearest(point);
      ASSERT_EQ(laser, firings[i].ring) << cones.sensor;
      ASSERT_NEAR(residual_rad, 0, 1e-5) << cones.sensor;
    }
  }
}

TEST(RecognizeSensor, NearestConeIsThatOfBruteForce) {
  // Tips in two blocks, and in one point.
  const auto tables =
      cones_of_all({"velodyne-hdl-64e-kitti", "velodyne-hdl-64e-s2", "hesai-pandar64"});
  for (std::size_t i = 0; i < 6000; ++i) {
    const SensorCones& cones = tables[i % tables.size()];
    Random random(3, 0, i);
    const double flat_m = random.uniform(3, 60), azimuth_rad = random.uniform(-4, 4);
    const Vec3d p = {flat_m * std::cos(azimuth_rad), flat_m * std::sin(azimuth_rad),
                     flat_m * random.uniform(-0.6, 0.2)};
    double min_rad = 10;
    for (const SensorCones::Cone& cone : cones.cones) {
      const double residual_rad = std::atan2(p.z - cone.height_m, flat_m) - cone.elevation_rad;
      if (std::abs(residual_rad) < std::abs(min_rad)) min_rad = residual_rad;
    }
    EXPECT_NEAR(cones.nearest(p).second, min_rad, 1e-12);
  }
}

// Oracle: the firings, for origins above, before and beside the axis.
TEST(RecognizeSensor, BeamsBeginWhereTheTableHasThem) {
  for (const char* const name :
       {"velodyne-hdl-64e-kitti", "velodyne-hdl-64e-s2", "ouster-os1-64", "hesai-pandar64"}) {
    LidarModel model = load_lidar_model(name);
    model.columns = 36;
    const SensorCones cones = cones_of(model);
    for (const Firing& firing : firings_of(model)) {
      const Vec3d origin = vec_cast<double>(firing.origin);
      const Vec3d point = origin + 12.5 * vec_cast<double>(firing.direction);
      const auto [laser, above_rad] = cones.nearest(point);
      ASSERT_LT(std::fabs(above_rad), 1e-5);
      ASSERT_LT(length(cones.origin_of(laser, point) - origin), 1e-4) << name << firing.ring;
    }
  }
  const SensorCones aside = {"aside", {{0, 0.2, 0.1, 0.3}}};
  EXPECT_EQ(aside.origin_of(0, {0.1, 0, 5}), (Vec3d{0, 0, 0.2})) << "within the lateral offset";
}

TEST(RecognizeSensor, ARosetteHasNoCones) {
  EXPECT_TRUE(cones_of(load_lidar_model("livox-mid-40")).cones.empty());
}

TEST(RecognizeSensor, KnowsPointsInTheSensorsOwnFrameAmongTheLibrary) {
  const std::vector<Vec3d> points = scan_in_hall("velodyne-hdl-64e-kitti", {});
  expect_recognized(recognize_sensor(points, library_cones(), Executor(1)),
                    "velodyne-hdl-64e-kitti", {});
}

TEST(RecognizeSensor, FindsTheMountOfAnUnevenTable) {
  const RigidTransform mount = mount_at({0.1, 0.8, 1.85}, 0.9, -0.2);
  const std::vector<Vec3d> points = scan_in_hall("hesai-pandar64", mount);
  const auto candidates = cones_of_all({"hesai-pandar64", "velodyne-vls-128"});
  expect_recognized(recognize_sensor(points, candidates, Executor(1)), "hesai-pandar64", mount);
}

TEST(RecognizeSensor, FindsTheMountOfAnEvenTableWhateverTheThreads) {
  const RigidTransform mount = mount_at({-1.1, 0.4, 1.3}, -0.5, 0.7);
  const std::vector<Vec3d> points = scan_in_hall("velodyne-vlp-16", mount);
  const auto candidates = cones_of_all({"velodyne-vlp-16"});
  const auto one = recognize_sensor(points, candidates, Executor(1));
  const auto three = recognize_sensor(points, candidates, Executor(3));
  expect_recognized(one, "velodyne-vlp-16", mount);
  ASSERT_TRUE(three);
  EXPECT_TRUE(one->vehicle_from_sensor.translation == three->vehicle_from_sensor.translation);
  EXPECT_EQ(one->residual_rad, three->residual_rad);
}

TEST(RecognizeSensor, ATableThatPointsDoNotFillDoesNotWin) {
  // Every laser of the VLP-16 has its twin among 31 that are a degree apart.
  SensorCones twice;
  for (int degrees = 15; degrees >= -15; --degrees) twice.cones.push_back({degrees * kDegree, 0});
  const std::vector<Vec3d> points = scan_in_hall("velodyne-vlp-16", {});
  const std::vector<SensorCones> both = {twice, cones_of(load_lidar_model("velodyne-vlp-16"))};
  EXPECT_FALSE(recognize_sensor(points, std::span(both).first(1), Executor(1)));
  expect_recognized(recognize_sensor(points, both, Executor(1)), "velodyne-vlp-16", {});
}

TEST(RecognizeSensor, ATableWithHalfOfTheLasersDoesNotWin) {
  const std::vector<Vec3d> points = scan_in_hall("hesai-pandarxt-32", {});
  EXPECT_FALSE(recognize_sensor(points, cones_of_all({"velodyne-vlp-16"}), Executor(1)));
}

TEST(RecognizeSensor, RefusesTablesThatFitAboutAsWell) {
  // The second is of another kind by one laser of sixteen.
  const std::vector<Vec3d> points = scan_in_hall("velodyne-vlp-16", {});
  std::vector<SensorCones> two = cones_of_all({"velodyne-vlp-16", "velodyne-vlp-16"});
  two[1].sensor = "nearly";
  two[1].cones.front().elevation_rad += 0.6 * kDegree;
  EXPECT_FALSE(recognize_sensor(points, two, Executor(1)));
}

TEST(RecognizeSensor, RefusesABall) {
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < 4 * kPoints; ++i) {
    Random random(5, 0, i);
    const Vec3d way = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    // Of the ball what a VLP-16 could see.
    if (std::abs(way.z) < std::sin(15.5 * kDegree))
      points.push_back(40 * std::cbrt(random.uniform()) * way);
  }
  EXPECT_FALSE(recognize_sensor(points, cones_of_all({"velodyne-vlp-16"}), Executor(1)));
}

TEST(RecognizeSensor, RefusesTheDenseGridOfATerrestrialScanner) {
  std::vector<Vec3d> points;
  for (int row = -155; row <= 155; ++row) {
    for (int column = 0; column < 20; ++column) {
      const double elevation_rad = 0.1 * row * kDegree;
      const double azimuth_rad = (18 * column + 0.06 * row) * kDegree;
      const Vec3d way = {std::cos(elevation_rad) * std::cos(azimuth_rad),
                         std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
      points.push_back(range_in_long_hall({}, way) * way);
    }
  }
  EXPECT_FALSE(recognize_sensor(points, cones_of_all({"velodyne-vlp-16"}), Executor(1)));
}

TEST(RecognizeSensor, RefusesFewPointsAndNoCandidates) {
  const auto candidates = cones_of_all({"velodyne-vlp-16"});
  std::vector<Vec3d> points = scan_in_hall("velodyne-vlp-16", {});
  EXPECT_FALSE(recognize_sensor(points, {}, Executor(1)));
  EXPECT_FALSE(recognize_sensor({}, candidates, Executor(1)));
  for (std::size_t i = 500; i < points.size(); ++i) points[i] = {kNaN, 0, 0};
  EXPECT_TRUE(recognize_sensor(points, candidates, Executor(1)));
  points[499] = {0, kNaN, 0};
  EXPECT_FALSE(recognize_sensor(points, candidates, Executor(1)));
}

}  // namespace
}  // namespace adasplats
