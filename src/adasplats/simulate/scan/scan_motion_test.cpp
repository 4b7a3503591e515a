// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/core/error.h"
#include "adasplats/simulate/scan/box_mesh_test.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {
namespace {

/// Drives along x with `speed` and turns left with `yaw_rate` from time 0 on.
RigidTransform driven(double time_s, double speed_m_s, double yaw_rate) {
  return {rotation_from_yaw_pitch_roll(yaw_rate * time_s, 0, 0), {speed_m_s * time_s, 0, 2}};
}

Trajectory drive(double step_s, double end_s, double speed_m_s, double yaw_rate) {
  Trajectory poses;
  for (double t = 0; t < end_s + 1e-9; t += step_s)
    poses.push_back({t, driven(t, speed_m_s, yaw_rate)});
  return poses;
}

LidarModel ring_sensor(double elevation_rad, std::uint32_t columns) {
  LidarModel sensor;
  sensor.elevations_rad = {elevation_rad};
  sensor.columns = columns;
  sensor.rotation_hz = 10;
  sensor.max_range_m = 100;
  return sensor;
}

Scan scan_in_box(const TriangleMesh& mesh, const LidarModel& sensor, const ScanMotion& motion,
                 PointFrame frame) {
  const Executor executor(2);
  const SceneView view{{}, &mesh};
  SimulateOptions options;
  options.frame = frame;
  return simulate_scan(*make_brute_force_tracer(view), {}, {}, sensor, firings_of(sensor), motion,
                       0, options, executor);
}

TEST(ScanMotion, AScanIsCentredOnTheTimeOfItsPose) {
  const Trajectory motion = drive(0.1, 2.0, 10, 0);
  const std::vector<TimedPose> poses = {{1.0, driven(1.0, 10, 0)}};
  const auto scans = moving_scans(poses, motion, 0.1);
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_NEAR(pose_at(scans[0], 0.0).translation.x, 9.5, 1e-9);
  EXPECT_NEAR(pose_at(scans[0], 0.5).translation.x, 10.0, 1e-9);
  EXPECT_NEAR(pose_at(scans[0], 1.0).translation.x, 10.5, 1e-9);
  EXPECT_EQ(still_scans(poses)[0].knot_count(), 1U);
}

// Oracle: analytic. The motion's own frame does not matter, only how it changes.
TEST(ScanMotion, TheMotionMayHaveAnotherFrame) {
  const RigidTransform elsewhere = {rotation_from_yaw_pitch_roll(2, 0.1, 0.2), {100, -50, 3}};
  Trajectory motion = drive(0.05, 2.0, 10, 0.5);
  const std::vector<TimedPose> poses = {{1.0, driven(1.0, 10, 0.5)}};
  const auto expected = moving_scans(poses, motion, 0.1);
  for (TimedPose& pose : motion) pose.world_from_sensor = elsewhere * pose.world_from_sensor;
  const auto scans = moving_scans(poses, motion, 0.1);
  for (const double share : {0.0, 0.3, 1.0})
    EXPECT_LT(
        length(pose_at(scans[0], share).translation - pose_at(expected[0], share).translation),
        1e-9);
}

// Oracle: the circle. At rest beyond the poses the ends would be 0.5 m off.
TEST(ScanMotion, GoesOnForHalfAScanBeyondThePoses) {
  const Trajectory motion = drive(0.01, 2.0, 10, 0.8);
  const std::vector<TimedPose> poses = {motion.front(), motion[50], motion.back()};
  const auto scans = moving_scans(poses, motion, 0.1);
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_NEAR(length(pose_at(scans[0], 0).translation - pose_at(scans[0], 0.5).translation), 0.5,
              1e-3);
  EXPECT_NEAR(length(pose_at(scans[2], 1).translation - pose_at(scans[2], 0.5).translation), 0.5,
              1e-3);
  EXPECT_EQ(motion_ends_note(poses, motion, 0.1), "");
  const std::vector<TimedPose> far = {{9.0, {}}};
  EXPECT_NE(motion_ends_note(far, motion, 0.1).find("1 of 1 scans are outside"), std::string::npos);
}

TEST(ScanMotion, FastTurnsHaveMoreKnots) {
  const std::vector<TimedPose> poses = {{1.0, {}}};
  const auto knots = [&](double yaw_rate) {
    return moving_scans(poses, drive(0.5, 2, 0, yaw_rate), 0.1)[0].knots.size();
  };
  EXPECT_EQ(knots(0.0), 3U) << "one pose of the motion lies in the scan";
  EXPECT_GE(knots(std::numbers::pi / 2), 19U) << "nine degrees in steps of half a degree";
  EXPECT_LE(knots(100.0), 64U);
}

TEST(ScanMotion, InvalidMotionsAreRejected) {
  const std::vector<TimedPose> poses = {{1.0, {}}};
  EXPECT_THROW(moving_scans(poses, drive(0.5, 2, 0, 0), 0.0), Error);
  EXPECT_THROW(moving_scans(poses, drive(0.5, 2, 0, 0), std::numeric_limits<double>::quiet_NaN()),
               Error);
  EXPECT_THROW(moving_scans(poses, {}, 0.1), Error);
  EXPECT_TRUE(moving_scans({}, drive(0.5, 2, 0, 0), 0.1).empty());
}

// Oracle: analytic. In a box each point lies on a side from where the sensor is when it fires.
TEST(RollingShutter, RangesInABoxAreThoseOfTheTimeOfFiring) {
  const TriangleMesh mesh = box_mesh(20.0F);
  const LidarModel sensor = ring_sensor(0.0, 3600);
  const Trajectory motion = drive(0.02, 2.0, 15, 0.8);
  const std::vector<TimedPose> poses = {{0.5, driven(0.5, 15, 0.8)}};
  const auto scans = moving_scans(poses, motion, 0.1);
  const Scan scan = scan_in_box(mesh, sensor, scans[0], PointFrame::raw);
  const auto firings = firings_of(sensor);
  ASSERT_EQ(scan.size(), firings.size());
  double largest_shift_m = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double time_s = 0.45 + static_cast<double>(scan.times_s[i]);
    const RigidTransform world_from_sensor = driven(time_s, 15, 0.8);
    const Vec3d p = world_from_sensor * vec_cast<double>(scan.positions[i]);
    EXPECT_NEAR(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}), 20.0, 2e-4);
    const Vec3d still = scans[0].reference.world_from_sensor * vec_cast<double>(scan.positions[i]);
    largest_shift_m = std::max(largest_shift_m, length(p - still));
  }
  EXPECT_GT(largest_shift_m, 0.7) << "the sensor drove 1.5 m during the scan";
}

// Oracle: analytic. De-skewed points are where the box is, in the frame of the scan's pose.
TEST(RollingShutter, DeskewedPointsAreInTheFrameOfThePose) {
  const TriangleMesh mesh = box_mesh(20.0F);
  const LidarModel sensor = ring_sensor(0.1, 1000);
  const Trajectory motion = drive(0.02, 2.0, 15, -0.8);
  const std::vector<TimedPose> poses = {{0.5, driven(0.5, 15, -0.8)}};
  const ScanMotion scan_motion = moving_scans(poses, motion, 0.1)[0];
  const Scan scan = scan_in_box(mesh, sensor, scan_motion, PointFrame::deskewed);
  ASSERT_EQ(scan.size(), 1000U);
  for (const Vec3f& point : scan.positions) {
    const Vec3d p = poses[0].world_from_sensor * vec_cast<double>(point);
    EXPECT_NEAR(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}), 20.0, 2e-4);
  }
}

// Oracle: analytic. Above a plane a beam that looks down by e from the height h has the range
// h / sin(e); one that leaves 0.2 m higher, (h + 0.2) / sin(e).
TEST(RollingShutter, BeamsLeaveFromTheirOrigins) {
  TriangleMesh mesh;
  mesh.vertices = {{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  LidarModel sensor = ring_sensor(-0.2, 360);
  sensor.elevations_rad = {-0.2, -0.2};
  sensor.beam_origins_m = {{0, 0, 0.2}, {0.05, 0, 0}};
  ScanMotion motion;
  motion.reference.world_from_sensor.translation.z = 2;
  const Scan scan = scan_in_box(mesh, sensor, motion, PointFrame::raw);
  ASSERT_EQ(scan.size(), 720U);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double height_m = scan.rings[i] == 0 ? 2.2 : 2.0;
    EXPECT_NEAR(static_cast<double>(scan.ranges_m[i]), height_m / std::sin(0.2), 1e-4);
    EXPECT_NEAR(static_cast<double>(scan.positions[i].z), -2.0, 1e-4);
    const double rho_m = std::hypot(static_cast<double>(scan.positions[i].x),
                                    static_cast<double>(scan.positions[i].y));
    const double ahead_m = scan.rings[i] == 0 ? 0.0 : 0.05;
    EXPECT_NEAR(rho_m, ahead_m + height_m / std::tan(0.2), 1e-4);
  }
}

}  // namespace
}  // namespace adasplats
