// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/mount.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {
namespace {

struct Box {
  Vec3d low, high;
};

/// Houses on both sides of a curved street on flat ground.
const std::vector<Box>& houses() {
  static const std::vector<Box> all = [] {
    std::vector<Box> made;
    for (int k = 0; k < 5; ++k) {
      const double x = -14.0 + 9 * k, depth = 0.6 * (k % 3);
      made.push_back({{x, -16, 0}, {x + 7, -7 - depth, 6.0 + k}});
      if (k < 3) made.push_back({{x, 7 + depth, 0}, {x + 7, 15, 7.0 - k}});
      const double y = -3 + 9.0 * k;
      made.push_back({{31 - depth, y, 0}, {40, y + 7, 5.0 + k}});
      if (k > 1) made.push_back({{5, y, 0}, {14.5 + depth, y + 7, 8.0 - k}});
    }
    for (const Vec3d post :
         {Vec3d{4, 4.5, 0}, Vec3d{18, 9, 0}, Vec3d{27.5, 14, 0}, Vec3d{-6, -5, 0}})
      made.push_back({post, post + Vec3d{0.5, 0.7, 3}});
    return made;
  }();
  return all;
}

/// Range of a ray; infinite if it hits nothing.
double range_in_scene(Vec3d origin, Vec3d direction) {
  double range_m =
      direction.z < 0 ? -origin.z / direction.z : std::numeric_limits<double>::infinity();
  for (const Box& box : houses()) {
    double enter = 0, leave = range_m;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.low[axis] - origin[axis]) / direction[axis];
      const double b = (box.high[axis] - origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter > 0 && enter < leave) range_m = enter;
  }
  return range_m;
}

enum class Way { straight, turning, hilly };

RigidTransform pose_on(Way way, double along) {
  if (way == Way::straight) return {{}, {-10 + 24 * along, -1, 1.8}};
  // 20 m straight, a quarter of a circle and a bit of radius 8 m, 14 m straight.
  const double arc_rad = 100 * kDegree, radius_m = 8;
  const double travelled = along * (20 + radius_m * arc_rad + 14);
  const double turned = std::clamp((travelled - 20) / radius_m, 0.0, arc_rad);
  const double before = std::min(travelled, 20.0);
  const double behind = std::max(0.0, travelled - 20 - radius_m * arc_rad);
  const Vec3d at = {-5 + before + radius_m * std::sin(turned) + behind * std::cos(turned),
                    -1 + radius_m * (1 - std::cos(turned)) + behind * std::sin(turned), 1.8};
  const double pitch = way == Way::hilly ? 0.15 * std::sin(9 * along) : 0;
  return {rotation_from_yaw_pitch_roll(turned, pitch, 0.5 * pitch), at};
}

struct Recording {
  PointCloud cloud;
  std::vector<RigidTransform> true_poses;
};

/// Scans along the path with a mount error: given pose = true pose * `fault`.
Recording record(Way way, const RigidTransform& fault, double pose_noise_m = 0) {
  constexpr std::uint32_t kScans = 40, kLasers = 24, kColumns = 240;
  Recording made;
  for (std::uint32_t scan = 0; scan < kScans; ++scan) {
    const RigidTransform pose = pose_on(way, scan / double{kScans - 1});
    Random random(11, 0, scan);
    const auto noise = [&] { return pose_noise_m * random.normal(); };
    RigidTransform given = pose * fault;
    given.translation = given.translation + Vec3d{noise(), noise(), noise()};
    made.true_poses.push_back(pose);
    made.cloud.scan_poses.push_back({0.1 * scan, given});
    for (std::uint32_t i = 0; i < kLasers * kColumns; ++i) {
      const double elevation = (12 - 36.0 * (i / kColumns) / (kLasers - 1)) * kDegree;
      const double azimuth = 2 * std::numbers::pi * (i % kColumns) / kColumns + 0.001;
      const Vec3d beam = {std::cos(elevation) * std::cos(azimuth),
                          std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      const double range_m = range_in_scene(pose.translation, pose.rotation * beam);
      if (!(range_m < 60)) continue;
      Random of_beam(3, scan, i);
      made.cloud.positions.push_back(
          vec_cast<float>(given * ((range_m + 0.005 * of_beam.normal()) * beam)));
      made.cloud.sensor_positions.push_back(vec_cast<float>(given.translation));
      made.cloud.scan_indices.push_back(scan);
    }
  }
  return made;
}

RigidTransform fault_of(Vec3d axis, double angle_deg, Vec3d shift_m) {
  return {rotation_by((angle_deg * kDegree / length(axis)) * axis), shift_m};
}

/// Remaining mount error, in the true sensor frame.
RigidTransform left_of(const RigidTransform& fault, const MountCorrection& found) {
  return fault * found.given_from_mounted();
}

double degrees_of(const RigidTransform& motion) {
  return length(rotation_vector(motion.rotation)) / kDegree;
}

std::vector<std::string> names_of(const MountEstimate& found) {
  std::vector<std::string> names;
  for (const MountDirection& direction : found.not_observed) names.push_back(direction.name);
  std::ranges::sort(names);
  return names;
}

// Oracle: the simulated error. A vehicle that stays level does not observe the sensor height.
TEST(Mount, FindsFiveDegreesAndHalfAMetreOnACurvedDrive) {
  const RigidTransform faults[] = {
      fault_of({1, 0, 0}, 5, {0.4, -0.3, 0}), fault_of({0, 1, 0}, -5, {0, 0.5, 0}),
      fault_of({0, 0, 1}, 5, {-0.5, 0, 0}), fault_of({1, -1, 1}, 5, {0.3, 0.3, -0.26})};
  for (const RigidTransform& fault : faults) {
    const Recording recording = record(Way::turning, fault);
    const auto [found, report] = calibrate(recording.cloud, {}, Executor(2));
    ASSERT_TRUE(report.mount);
    EXPECT_EQ(report.mount->objection, "");
    const RigidTransform left = left_of(fault, found.mount);
    EXPECT_LT(degrees_of(left), 0.05);
    EXPECT_LT(std::hypot(left.translation.x, left.translation.y), 0.02);
    EXPECT_NEAR(left.translation.z, fault.translation.z, 0.02);
    EXPECT_EQ(names_of(report.mount->found), std::vector<std::string>{"lever arm along z"});
  }
}

// Oracle: the points of the same beams without the error, except for the unobserved direction.
TEST(Mount, CorrectsPosesAndPoints) {
  const RigidTransform fault = fault_of({0.2, 0.1, 1}, 5, {0.4, -0.3, 0});
  Recording recording = record(Way::turning, fault);
  const Calibration found = calibrate(recording.cloud, {}, Executor(2)).first;
  const Trajectory given = recording.cloud.scan_poses;
  ASSERT_TRUE(apply(found, recording.cloud, Executor(2)));
  const auto relative = [](const RigidTransform& a, const RigidTransform& b) {
    return a.inverse() * b;
  };
  const PointCloud expected = record(Way::turning, {}).cloud;
  const RigidTransform whole = recording.cloud.scan_poses[0].world_from_sensor *
                               recording.true_poses[0].inverse();  // the absolute position is free
  double worst_m = 0;
  for (std::size_t scan = 0; scan < given.size(); ++scan) {
    const RigidTransform& pose = recording.cloud.scan_poses[scan].world_from_sensor;
    const RigidTransform step = relative(recording.cloud.scan_poses[0].world_from_sensor, pose);
    const RigidTransform true_step = relative(recording.true_poses[0], recording.true_poses[scan]);
    worst_m = std::max(worst_m, length(step.translation - true_step.translation));
    const auto at = found.corrected(given[scan]);
    ASSERT_TRUE(at);
    EXPECT_EQ(at->translation, pose.translation);
  }
  EXPECT_LT(worst_m, 0.02);
  double mean_m = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    mean_m += length(vec_cast<double>(recording.cloud.positions[i]) -
                     whole * vec_cast<double>(expected.positions[i])) /
              static_cast<double>(expected.size());
  EXPECT_LT(mean_m, 0.02);
}

// Oracle: the simulated error; directions that a straight drive does not observe stay as given.
TEST(Mount, AStraightDriveConstrainsOnlyYawAndPitch) {
  const RigidTransform fault = fault_of({0, 0, 1}, 5, {0.3, 0.4, 0});
  const auto [found, report] = calibrate(record(Way::straight, fault).cloud, {}, Executor(2));
  ASSERT_TRUE(report.mount);
  EXPECT_EQ(report.mount->objection, "");
  EXPECT_EQ(names_of(report.mount->found),
            (std::vector<std::string>{"lever arm along x", "lever arm along y", "lever arm along z",
                                      "roll (about x)"}));
  EXPECT_LT(degrees_of(left_of(fault, found.mount)), 0.05);
  EXPECT_LT(length(found.mount.shift_m), 1e-3);
}

// Oracle: the simulated error.
TEST(Mount, FindsTheHeightIfTheVehiclePitches) {
  const RigidTransform fault = fault_of({0, 1, 0}, 5, {0.2, 0, 0.45});
  const auto [found, report] = calibrate(record(Way::hilly, fault).cloud, {}, Executor(2));
  EXPECT_EQ(report.mount->objection, "");
  EXPECT_TRUE(report.mount->found.not_observed.empty());
  const RigidTransform left = left_of(fault, found.mount);
  EXPECT_LT(degrees_of(left), 0.05);
  EXPECT_LT(length(left.translation), 0.02);
}

// Oracle: the simulated error. The standard deviations include the effect of the poses.
TEST(Mount, NoisyPosesIncreaseTheStandardDeviations) {
  const RigidTransform fault = fault_of({0, 0.3, 1}, 5, {0.3, -0.4, 0});
  const auto [found, report] = calibrate(record(Way::turning, fault, 0.03).cloud, {}, Executor(2));
  EXPECT_EQ(report.mount->objection, "");
  const RigidTransform left = left_of(fault, found.mount);
  const double sd_m = length(report.mount->found.shift_sd_m);
  EXPECT_GT(sd_m, 0.001);
  EXPECT_LT(std::hypot(left.translation.x, left.translation.y), 4 * sd_m);
  EXPECT_LT(degrees_of(left), 4 * length(report.mount->found.rotation_sd_rad) / kDegree);
}

TEST(Mount, ACorrectMountAndTheRestStayAsGiven) {
  const PointCloud cloud = record(Way::turning, {}).cloud;
  const auto [found, report] = calibrate(cloud, {}, Executor(2));
  EXPECT_TRUE(found.empty());
  EXPECT_NE(report.mount->objection.find("no more than"), std::string::npos);
  CalibrateOptions without;
  without.mount_correction = false;
  const auto [same, report_without] = calibrate(cloud, without, Executor(2));
  EXPECT_FALSE(report_without.mount);
  EXPECT_EQ(report.calibrated_m, report_without.calibrated_m);
  CalibrateOptions alone{.poses = false, .ranges = false, .elevations = false};
  EXPECT_NE(calibrate(cloud, alone, Executor(2)).second.objection.find("the mount: "),
            std::string::npos);
}

// Single poses absorb small errors: drives with accurate mounts are calibrated as before.
TEST(Mount, SmallErrorsAreLeftToThePoses) {
  const RigidTransform fault = fault_of({0, 0, 1}, 0.2, {0.05, 0, 0});
  const auto [found, report] = calibrate(record(Way::turning, fault).cloud, {}, Executor(2));
  EXPECT_TRUE(found.mount.empty());
  EXPECT_FALSE(found.poses.empty());
  EXPECT_NE(report.mount->objection.find("no more than"), std::string::npos);
}

TEST(Mount, OnlyTheMountIsCorrectedIfTheRestIsCorrect) {
  const RigidTransform fault = fault_of({0, 0, 1}, 5, {0.3, 0, 0});
  const auto [found, report] = calibrate(record(Way::turning, fault).cloud, {}, Executor(2));
  ASSERT_FALSE(found.mount.empty());
  EXPECT_NE(report.mount->alone_because, "");
  for (const PoseCorrection& pose : found.poses) {
    EXPECT_EQ(pose.rotation_rad, Vec3d{});
    EXPECT_EQ(pose.shift_m, Vec3d{});
  }
}

TEST(Mount, TheSameOnAnyNumberOfThreads) {
  const PointCloud cloud = record(Way::turning, fault_of({1, 1, 0}, 4, {0, 0.3, 0.1})).cloud;
  const Calibration one = calibrate(cloud, {}, Executor(1)).first;
  const Calibration three = calibrate(cloud, {}, Executor(3)).first;
  ASSERT_FALSE(one.mount.empty());
  EXPECT_EQ(one.mount.rotation_rad, three.mount.rotation_rad);
  EXPECT_EQ(one.mount.shift_m, three.mount.shift_m);
}

TEST(Mount, TooFewScansGiveAnObjection) {
  PointCloud cloud = record(Way::turning, fault_of({0, 0, 1}, 5, {0.3, 0, 0})).cloud;
  const auto behind = std::ranges::find(cloud.scan_indices, 11U) - cloud.scan_indices.begin();
  cloud.positions.resize(static_cast<std::size_t>(behind));
  cloud.sensor_positions.resize(cloud.positions.size());
  cloud.scan_indices.resize(cloud.positions.size());
  cloud.scan_poses.resize(11);
  const auto [found, report] = calibrate(cloud, {}, Executor(2));
  EXPECT_TRUE(found.mount.empty());
  EXPECT_EQ(report.mount->objection, "too few scans (11)");
}

TEST(Mount, NoPointsGiveNoMount) {
  const MountEstimate found =
      search_mount({}, std::vector<TimedPose>(3), MountOptions{}, Executor(1));
  EXPECT_TRUE(found.mount.empty());
  EXPECT_EQ(found.planes, 0U);
  EXPECT_EQ(found.not_observed.size(), 6U);
}

}  // namespace
}  // namespace adasplats
