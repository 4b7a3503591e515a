// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/calibrate_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "adasplats/calibrate/recorded_hall_test.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr std::size_t kRigScans = 24;
constexpr double kStep_s = 0.1;

/// The car in the hall of recorded_hall_test.h.
RigidTransform car_at(double time_s) {
  const double along = time_s / (kStep_s * (kRigScans - 1));
  return {rotation_from_yaw_pitch_roll(1.6 * along, 0.03 * std::sin(5 * along), 0.02 * along),
          {-6 + 12 * along, 2 * std::sin(3 * along), 1.8}};
}

struct RigSensorFaults {
  RigidTransform mount, given_mount;
  double clock_s = 0;  ///< its scans are later than their times state
  double range_m = 0;  ///< added to what it measures
  bool has_lasers = true;
  double half_width_deg = 180;
  bool is_parked = false;  ///< the car
};

/// Adds the scans of a sensor to a cloud.
void add_sensor(const std::string& name, const RigSensorFaults& faults, PointCloud& cloud) {
  const auto first = static_cast<std::uint32_t>(cloud.scan_poses.size());
  cloud.sensors.push_back({name, kRigScans, true});
  for (std::uint32_t scan = 0; scan < kRigScans; ++scan) {
    const double time_s = kStep_s * scan;
    const auto car = [&](double at_s) { return car_at(faults.is_parked ? 0 : at_s); };
    const RigidTransform pose = car(time_s + faults.clock_s) * faults.mount;
    const RigidTransform given = car(time_s) * faults.given_mount;
    cloud.scan_poses.push_back({time_s, given});
    for (std::size_t laser = 0; laser < kHallLasers; ++laser) {
      for (std::size_t column = 0; column < kHallColumns; ++column) {
        const double share = (static_cast<double>(column) + 0.5) / kHallColumns;
        const double azimuth = faults.half_width_deg * kDegree * (2 * share - 1);
        const double elevation = hall_elevation_rad(laser);
        const Vec3d beam = {std::cos(elevation) * std::cos(azimuth),
                            std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
        Random random(5, first + scan, laser * kHallColumns + column);
        const double range_m = range_in_hall(pose.translation, pose.rotation * beam) +
                               0.005 * random.normal() + faults.range_m;
        cloud.positions.push_back(vec_cast<float>(given * (range_m * beam)));
        cloud.sensor_positions.push_back(vec_cast<float>(given.translation));
        cloud.scan_indices.push_back(first + scan);
        cloud.lasers.push_back(faults.has_lasers ? static_cast<std::uint16_t>(laser) : kNoLaser);
      }
    }
  }
}

RigidTransform mount_of(double yaw_deg, double pitch_deg, double roll_deg, Vec3d at) {
  return {rotation_from_yaw_pitch_roll(yaw_deg * kDegree, pitch_deg * kDegree, roll_deg * kDegree),
          at};
}

std::pair<Calibration, CalibrationReport> calibrated(const PointCloud& cloud) {
  const Executor executor(2);
  ProgressSink quiet;
  const CalibrateCloud on_cpu = [&](const PointCloud& part, const CalibrateOptions& options) {
    return calibrate(part, options, executor);
  };
  return calibrate_rig(cloud, {}, {}, on_cpu, executor, quiet);
}

RigSensorFaults upside_down() {
  RigSensorFaults faults;
  faults.mount = mount_of(20, 8, 180, {0.6, 0.3, -0.4});
  faults.given_mount =
      faults.mount * RigidTransform{rotation_by(Vec3d{3, -2.5, 3} * kDegree), {0.3, -0.3, 0.2}};
  faults.clock_s = 0.05;
  return faults;
}

// Oracle: the mount and the clock that were put in.
TEST(CalibrateRig, FindsTheMountAndTheClockOfAnUpsideDownSensor) {
  PointCloud cloud;
  add_sensor("top", {}, cloud);
  const RigSensorFaults faults = upside_down();
  add_sensor("left", faults, cloud);
  const auto [calibration, report] = calibrated(cloud);
  ASSERT_EQ(report.others.size(), 1U);
  EXPECT_EQ(calibration.sensor, "top");
  EXPECT_EQ(calibration.others[0].sensor, "left");
  const MapAlignment& found = *report.others[0].aligned;
  const RigidTransform mount = faults.given_mount * found.mount.given_from_mounted();
  EXPECT_LT(angle_between(mount.rotation, faults.mount.rotation) / kDegree, 0.05);
  EXPECT_LT(length(mount.translation - faults.mount.translation), 0.02);
  EXPECT_NEAR(found.clock_s, faults.clock_s, 0.001);
  EXPECT_LT(found.given_share, 0.5);
  EXPECT_GT(found.share, 0.95);
  EXPECT_TRUE(found.not_observed().empty());
  EXPECT_LT(std::fabs(found.clock_s - faults.clock_s), 4 * found.clock_sd_s);
  EXPECT_LT(found.clock_sd_s, 0.001);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(found.shift_sd_m[axis], 0.02);
    EXPECT_LT(found.rotation_sd_rad[axis] / kDegree, 0.05);
  }
}

// Oracle: a car that stands still has the same poses at all times.
TEST(CalibrateRig, TheClockOfAParkedCarIsNotObserved) {
  PointCloud cloud;
  RigSensorFaults faults;
  faults.is_parked = true;
  add_sensor("top", faults, cloud);
  faults.mount = faults.given_mount = mount_of(20, 8, 0, {0.6, 0.3, -0.4});
  add_sensor("left", faults, cloud);
  const auto [calibration, report] = calibrated(cloud);
  const MapAlignment& found = *report.others.at(0).aligned;
  EXPECT_EQ(found.not_observed(), std::vector<std::string>{"clock"});
  EXPECT_NEAR(found.clock_s, 0, 1e-3);
}

// Oracle: the ranges that were put in. The sensor looks ahead only; its lasers are unknown.
TEST(CalibrateRig, FindsTheRangeOffsetOfASensorWithoutLasers) {
  PointCloud cloud;
  add_sensor("top", {}, cloud);
  RigSensorFaults faults;
  faults.mount = faults.given_mount = mount_of(5, 3, 0, {1, 0, 0.2});
  faults.range_m = 0.06;
  faults.has_lasers = false;
  faults.half_width_deg = 50;
  add_sensor("front", faults, cloud);
  const auto [calibration, report] = calibrated(cloud);
  const LaserOffsets& lasers = calibration.others[0].lasers;
  ASSERT_FALSE(lasers.cells.empty());
  double sum_m = 0, count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.scan_indices[i] < kRigScans) continue;
    const RigidTransform& pose = cloud.scan_poses[cloud.scan_indices[i]].world_from_sensor;
    const Vec3d direction = pose.rotation.transposed() *
                            vec_cast<double>(cloud.positions[i] - cloud.sensor_positions[i]);
    sum_m += lasers.range_of(lasers.cells.of(direction));
    ++count;
  }
  EXPECT_NEAR(sum_m / count, -faults.range_m, 0.01);
}

// Oracle: calibrate_drives() of the first sensor alone.
TEST(CalibrateRig, OtherSensorsDoNotChangeTheFirst) {
  PointCloud alone, both;
  add_sensor("top", {}, alone);
  add_sensor("top", {}, both);
  add_sensor("left", upside_down(), both);
  alone.sensors.clear();
  const Executor executor(2);
  const auto [expected, report] = calibrate(alone, {}, executor);
  const auto [found, rig_report] = calibrated(both);
  EXPECT_EQ(found.lasers.range_m, expected.lasers.range_m);
  for (std::size_t scan = 0; scan < expected.poses.size(); ++scan)
    EXPECT_EQ(found.poses[scan].shift_m, expected.poses[scan].shift_m);
}

TEST(CalibrateRig, RejectsScansOfUnknownMotion) {
  PointCloud cloud;
  add_sensor("top", {}, cloud);
  add_sensor("left", upside_down(), cloud);
  cloud.sensors[1].unknown_sweep_m = 0.5;
  try {
    calibrated(cloud);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find("sensor 'left': points at 10 m move by 0.50 m"),
              std::string::npos)
        << error.what();
  }
}

TEST(CalibrateRig, RejectsASensorThatFitsNowhere) {
  PointCloud cloud;
  add_sensor("top", {}, cloud);
  RigSensorFaults faults;
  faults.mount = mount_of(90, 0, 0, {1, 0, 0.2});
  faults.given_mount = mount_of(90 * kDegree, 0, 0, {1, 0, 0.2});  // radians for degrees
  faults.half_width_deg = 40;
  add_sensor("left", faults, cloud);
  try {
    calibrated(cloud);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find("sensor 'left'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("degrees, not radians"), std::string::npos);
  }
}

}  // namespace
}  // namespace adasplats
