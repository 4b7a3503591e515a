// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_alignment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/city/small_city_test.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats::city_alignment {
namespace {

constexpr std::size_t kScans = 45, kPoints = 500;  // a scan

/// What the pose of a scan gets wrong: more and more, about the middle of the city.
RigidTransform error_of(std::size_t scan) {
  const double t = static_cast<double>(scan) / kScans;
  return moved_about({5005, 6005, 0}, {0, 0, 0.004 * t}, {0, 0.3 + 0.1 * t, -0.1});
}

/// A drive along x over the floor of the city and by its walls at y = 6000 and 6010, as it is.
PointCloud drive() {
  PointCloud cloud;
  cloud.origin = {4000, 6000, 0};
  for (std::size_t scan = 0; scan < kScans; ++scan) {
    const Vec3d sensor = {4992 + 0.5 * static_cast<double>(scan), 6005, 1.8};
    cloud.scan_poses.push_back({100 + 0.1 * static_cast<double>(scan), {Mat3d{}, sensor}});
    for (std::size_t i = 0; i < kPoints; ++i) {
      Random random(9, scan, i);
      Vec3d end = {sensor.x + random.uniform(-8, 8), random.uniform(6002, 6008), 0};
      if (i % 3 == 0) end = {end.x, i % 2 == 0 ? 5999.9 : 6009.9, random.uniform(0.2, 1.6)};
      cloud.positions.push_back(vec_cast<float>(end - cloud.origin));
      cloud.sensor_positions.push_back(vec_cast<float>(sensor - cloud.origin));
      cloud.scan_indices.push_back(static_cast<std::uint32_t>(scan));
    }
  }
  return cloud;
}

/// The same as a recording with those errors gives it.
PointCloud given_drive() {
  PointCloud cloud = drive();
  const auto moved = [&](const RigidTransform& motion, Vec3f p) {
    return vec_cast<float>(motion * (cloud.origin + vec_cast<double>(p)) - cloud.origin);
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const RigidTransform error = error_of(cloud.scan_indices[i]);
    cloud.positions[i] = moved(error, cloud.positions[i]);
    cloud.sensor_positions[i] = moved(error, cloud.sensor_positions[i]);
  }
  for (std::size_t scan = 0; scan < kScans; ++scan) {
    RigidTransform& pose = cloud.scan_poses[scan].world_from_sensor;
    pose = error_of(scan) * pose;
  }
  return cloud;
}

/// The largest distance in y and z: nothing in the city says where along x a scan is.
double largest_difference(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec3d apart = a.world(i) - b.world(i);
    largest = std::max(largest, std::hypot(apart.y, apart.z));
  }
  return largest;
}

class LayingOn : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const CityManifest city_ = small_city::write_city(folder_.path());
  const Executor executor_{2};
};

TEST_F(LayingOn, LaysScansOnTheCity) {
  PointCloud cloud = given_drive();
  EXPECT_GT(largest_difference(cloud, drive()), 0.3);
  CityAlignment alignment(folder_.path(), city_, executor_);
  alignment.lay_on(cloud);
  EXPECT_LT(largest_difference(cloud, drive()), 0.02);
  const AlignmentReport report = alignment.report();
  EXPECT_EQ(report.groups, 5U);
  EXPECT_EQ(report.aligned, 5U);
  EXPECT_NEAR(report.median_shift_m, std::hypot(0.35, 0.1), 0.03);
  for (std::size_t scan = 0; scan < kScans; ++scan) {
    const Vec3d pose = cloud.scan_poses[scan].world_from_sensor.translation;
    EXPECT_NEAR(pose.y, 6005, 0.02);
    EXPECT_NEAR(pose.z, 1.8, 0.02);
  }
}

TEST_F(LayingOn, SaysWhatItCorrectedBehindAnotherCalibration) {
  const PointCloud given = given_drive();
  Calibration first;
  for (std::size_t scan = 0; scan < kScans; ++scan)
    first.poses.push_back({given.scan_poses[scan].time_s,
                           given.scan_poses[scan].world_from_sensor.translation,
                           {0, 0.001, 0},
                           {0, 0.05, 0.02}});
  for (const Calibration& applied : {Calibration(), first}) {
    PointCloud aligned = given;
    if (!applied.empty()) {
      ASSERT_TRUE(apply(applied, aligned, executor_));
    }
    CityAlignment alignment(folder_.path(), city_, executor_);
    alignment.lay_on(aligned);
    PointCloud corrected = given;
    ASSERT_TRUE(apply(alignment.behind(applied), corrected, executor_));
    EXPECT_LT(largest_difference(corrected, aligned), 1e-3);
    EXPECT_LT(largest_difference(corrected, drive()), 0.02);
  }
}

TEST_F(LayingOn, ScansBesideTheCityFollowTheLastOnesInIt) {
  CityAlignment alignment(folder_.path(), city_, executor_);
  PointCloud beyond = given_drive();
  for (Vec3f& p : beyond.positions) p.x += 200;
  for (Vec3f& p : beyond.sensor_positions) p.x += 200;
  for (TimedPose& pose : beyond.scan_poses) pose.world_from_sensor.translation.x += 200;
  const PointCloud before = beyond;
  alignment.lay_on(beyond);  // nothing is known yet
  EXPECT_LT(largest_difference(beyond, before), 1e-3);
  EXPECT_EQ(alignment.report().aligned, 0U);
  PointCloud inside = given_drive();
  alignment.lay_on(inside);
  beyond = before;
  alignment.lay_on(beyond);
  EXPECT_LT(largest_difference(beyond, before), 1.5);
  EXPECT_GT(largest_difference(beyond, before), 0.3);
  EXPECT_EQ(alignment.report().groups, 15U);
  EXPECT_EQ(alignment.report().aligned, 5U);
}

TEST_F(LayingOn, PointsWithoutScansStay) {
  PointCloud cloud = given_drive();
  cloud.scan_poses.clear();
  const PointCloud before = cloud;
  CityAlignment alignment(folder_.path(), city_, executor_);
  alignment.lay_on(cloud);
  EXPECT_EQ(cloud.positions, before.positions);
  EXPECT_EQ(alignment.report().groups, 0U);
}

}  // namespace
}  // namespace adasplats::city_alignment
