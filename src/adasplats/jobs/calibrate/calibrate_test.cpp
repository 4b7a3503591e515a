// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/calibrate/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSensor = "velodyne-hdl-64e-kitti";

/// How far a ray goes in a hall of 40 x 28 x 10 m with two pillars.
double range_in_hall(Vec3d origin, Vec3d direction) {
  const Vec3d low = {-20, -14, 0}, high = {20, 14, 10};
  double range_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double wall = direction[axis] > 0 ? high[axis] : low[axis];
    range_m = std::min(range_m, (wall - origin[axis]) / direction[axis]);
  }
  for (const Vec3d pillar : {Vec3d{6, 6, 0}, Vec3d{-5, -7, 0}}) {
    double enter = 0, leave = range_m;
    for (int axis = 0; axis < 2; ++axis) {
      const double a = (pillar[axis] - 1 - origin[axis]) / direction[axis];
      const double b = (pillar[axis] + 1 - origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter > 0 && enter < leave) range_m = enter;
  }
  return range_m;
}

struct Faults {
  double turn_deg = 0, shift_m = 0, range_m = 0;
};

/// A SemanticKITTI sequence of KITTI's sensor in a hall: what its lasers and poses get wrong is
/// known.
class HallDrive {
 public:
  explicit HallDrive(const Faults& faults, int scan_count = kScans) {
    for (std::size_t laser = 0; laser < 64; ++laser)
      range_offsets_m.push_back(faults.range_m * (laser % 2 == 0 ? 1 : -1));
    const LidarModel sensor = load_lidar_model(kSensor);
    const std::vector<Firing> firings = firings_of(sensor);
    for (int scan = 0; scan < scan_count; ++scan) {
      const double along = scan / double(scan_count - 1);
      const RigidTransform pose = {rotation_from_yaw_pitch_roll(0.5 * along, 0, 0),
                                   {-3 + 5 * along, std::sin(3 * along), 1.8}};
      const double wave = std::sin(2 * std::numbers::pi * along);
      const double turn = faults.turn_deg * kDegree;
      const RigidTransform given = {
          rotation_from_yaw_pitch_roll(turn * wave, 0.7 * turn * std::cos(4 * along), 0) *
              pose.rotation,
          pose.translation + faults.shift_m * Vec3d{wave, -0.8 * wave, 0.5 * std::cos(6 * along)}};
      true_poses.push_back({0.1 * scan, pose});
      given_poses.push_back({0.1 * scan, given});
      write_scan(firings, pose, scan);
    }
    // The camera 27 cm ahead of the LiDAR and 8 cm below it.
    folder_.write("00/calib.txt", std::string("Tr: 0 -1 0 0 0 0 -1 -0.08 1 0 0 -0.27\n"));
    write_kitti_poses(sequence() / "poses.txt", given_poses, sequence());
  }

  fs::path sequence() const { return folder_.path() / "00"; }
  fs::path below(const std::string& name) const { return folder_.path() / name; }

  static constexpr int kScans = 8;
  Trajectory true_poses, given_poses;
  std::vector<double> range_offsets_m;

 private:
  void write_scan(const std::vector<Firing>& firings, const RigidTransform& pose, int scan) const {
    std::vector<float> values;
    for (std::size_t i = 0; i < firings.size(); i += 11) {
      const Vec3d direction = vec_cast<double>(firings[i].direction);
      const Vec3d origin = vec_cast<double>(firings[i].origin);
      Random random(3, static_cast<std::uint64_t>(scan), i);
      const double range_m = range_in_hall(pose * origin, pose.rotation * direction) +
                             0.004 * random.normal() - range_offsets_m[firings[i].ring];
      const Vec3f point = vec_cast<float>(origin + range_m * direction);
      values.insert(values.end(), {point.x, point.y, point.z, 0.5F});
    }
    folder_.write(
        "00/velodyne/0000" + std::string(scan < 10 ? "0" : "") + std::to_string(scan) + ".bin",
        values);
  }

  TemporaryFolder folder_;
};

class CalibrateDrive : public testing::Test {
 protected:
  static CalibrateJob job(const HallDrive& drive, const std::string& output) {
    CalibrateJob job;
    job.inputs = {drive.sequence()};
    job.output = drive.below(output);
    job.load.own_body_m = 0;
    return job;
  }

  Executor executor_{2};
  RecordedProgress progress_;
  DeviceChoice device_;
  Session session_{executor_, progress_, 1, device_};
};

/// Of positions relative to that of the first scan: the whole is held by the given poses.
double worst_position_m(const Trajectory& found, const Trajectory& expected) {
  double worst_m = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const auto step = [&](const Trajectory& poses) {
      return (poses[0].world_from_sensor.inverse() * poses[k].world_from_sensor).translation;
    };
    worst_m = std::max(worst_m, length(step(found) - step(expected)));
  }
  return worst_m;
}

double worst_difference(const Trajectory& a, const Trajectory& b) {
  double worst = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    const RigidTransform &p = a[k].world_from_sensor, &q = b[k].world_from_sensor;
    worst = std::max(worst, length(p.translation - q.translation));
    for (int r = 0; r < 3; ++r)
      worst = std::max(worst, length(p.rotation.rows[r] - q.rotation.rows[r]));
  }
  return worst;
}

// Oracle: the faults that were put in, and round trips through the readers of what is written.
TEST_F(CalibrateDrive, WhatIsWrittenIsReadBackAndRight) {
  const HallDrive drive({0.15, 0.05, 0.03});
  const CalibrateResult result = run_calibrate(job(drive, "out"), session_);
  const fs::path out = drive.below("out");
  EXPECT_EQ(result.sensor, kSensor);
  EXPECT_EQ(result.files, (std::vector<std::string>{"trajectory.csv", "poses.txt", "lasers.csv",
                                                    "sensor.toml", "report.json", "report.html"}));
  EXPECT_GT(worst_position_m(drive.given_poses, drive.true_poses), 0.05);
  EXPECT_LT(worst_position_m(result.corrected, drive.true_poses), 0.01);
  EXPECT_LT(worst_difference(read_trajectory(out / "trajectory.csv"), result.corrected), 1e-8);

  const LidarModel unit = load_lidar_model((out / "sensor.toml").string());
  ASSERT_EQ(unit.range_offsets_m.size(), 64U);
  double error_m = 0;  // no point of the topmost lasers is on a plane that others saw
  for (std::size_t k = 0; k < 64; ++k)
    error_m += std::fabs(unit.range_offsets_m[k] - drive.range_offsets_m[k]) / 64;
  EXPECT_LT(error_m, 0.005);

  const auto report = nlohmann::ordered_json::parse(read_file(out / "report.json"));
  EXPECT_EQ(report, to_json(result));
  EXPECT_EQ(report["scans"]["time_s"].size(), 8U);
  EXPECT_LT(report["residual_calibrated_m"], report["residual_given_m"]);
  EXPECT_NE(read_file(out / "report.html").find("<svg"), std::string::npos);
}

// Oracle: the calibration that the poses are from.
TEST_F(CalibrateDrive, PosesStandInPlaceOfTheSequencesOwn) {
  const HallDrive drive({0.15, 0.05, 0.03});
  const CalibrateResult first = run_calibrate(job(drive, "first"), session_);
  fs::copy_file(drive.below("first") / "poses.txt", drive.sequence() / "poses.txt",
                fs::copy_options::overwrite_existing);
  EXPECT_LT(worst_difference(open_kitti_sequence(drive.sequence()).trajectory, first.corrected),
            1e-9);
  const CalibrateResult again = run_calibrate(job(drive, "again"), session_);
  EXPECT_GT(sizes_of(first.calibration).largest_shift_m, 0.03);
  EXPECT_LT(sizes_of(again.calibration).largest_shift_m, 0.004);
}

TEST_F(CalibrateDrive, WhatIsRightIsRefusedAndOnlyReported) {
  const HallDrive drive({});
  expect_error(ErrorKind::data, {"nothing calibrated: points that took no part lie no better"},
               [&] { run_calibrate(job(drive, "out"), session_); });
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(drive.below("out")))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"adasplats.json", "report.html", "report.json"}));
  const auto report = nlohmann::ordered_json::parse(read_file(drive.below("out") / "report.json"));
  EXPECT_EQ(report["applied"], false);
}

TEST_F(CalibrateDrive, ScansTooFarFromTheChosenOnesHaveNoPosesInKittisForm) {
  const HallDrive drive({0.15, 0.05, 0.03});
  CalibrateJob some = job(drive, "out");
  some.load.scan_count = 5;
  const CalibrateResult result = run_calibrate(some, session_);
  EXPECT_EQ(result.corrected.size(), 5U);
  EXPECT_FALSE(fs::exists(drive.below("out") / "poses.txt"));
  EXPECT_TRUE(fs::exists(drive.below("out") / "trajectory.csv"));
  ASSERT_FALSE(progress_.warnings.empty());
  EXPECT_NE(progress_.warnings.back().find("no poses.txt"), std::string::npos);
}

TEST_F(CalibrateDrive, SeveralDrivesOfOnePlaceHaveAFolderEach) {
  const HallDrive drive({0.15, 0.05, 0.03}), other({-0.1, 0.04, 0.03});
  CalibrateJob both = job(drive, "out");
  both.inputs.push_back(other.sequence());
  const CalibrateResult result = run_calibrate(both, session_);
  ASSERT_EQ(result.corrected.size(), 16U);
  const Trajectory first(result.corrected.begin(), result.corrected.begin() + 8);
  const Trajectory second(result.corrected.begin() + 8, result.corrected.end());
  const fs::path out = drive.below("out");
  EXPECT_LT(worst_difference(read_trajectory(out / "drive_0" / "trajectory.csv"), first), 1e-8);
  EXPECT_LT(worst_difference(read_trajectory(out / "drive_1" / "trajectory.csv"), second), 1e-8);
  EXPECT_LT(worst_position_m(second, other.true_poses), 0.01);
  EXPECT_TRUE(fs::exists(out / "drive_1" / "poses.txt"));
  EXPECT_TRUE(fs::exists(out / "sensor.toml"));
}

// Oracle: the faults that were put in, and one solve of the same scans.
TEST_F(CalibrateDrive, LongDrivesAreReadAndSolvedInWindows) {
  const HallDrive drive({0.15, 0.05, 0.03}, 20);
  const CalibrateResult whole = run_calibrate(job(drive, "whole"), session_);
  CalibrateJob in_windows = job(drive, "windows");
  in_windows.windows.window_scans = 10;
  const CalibrateResult result = run_calibrate(in_windows, session_);
  EXPECT_FALSE(whole.report.windows);
  ASSERT_TRUE(result.report.windows);
  EXPECT_EQ(result.report.windows->windows.size(), 3U);
  EXPECT_EQ(result.sensor, kSensor);
  EXPECT_EQ(result.files, whole.files);
  EXPECT_EQ(result.loaded.points_read, whole.loaded.points_read);
  EXPECT_EQ(result.loaded.drives.size(), 1U);
  EXPECT_EQ(result.loaded.drives[0].scans, 20U);
  ASSERT_EQ(result.corrected.size(), 20U);
  EXPECT_GT(worst_position_m(drive.given_poses, drive.true_poses), 0.05);
  EXPECT_LT(worst_position_m(result.corrected, drive.true_poses), 0.015);
  EXPECT_LT(worst_difference(result.corrected, whole.corrected), 0.02);
  const auto report =
      nlohmann::ordered_json::parse(read_file(drive.below("windows") / "report.json"));
  EXPECT_EQ(report, to_json(result));
  EXPECT_EQ(report["windows"]["each"].size(), 3U);
  EXPECT_EQ(report["windows"]["count"], 3);
  EXPECT_GT(report["windows"]["overlaps"]["scans"], 0);
  EXPECT_NE(read_file(drive.below("windows") / "report.html").find("overlaps of windows"),
            std::string::npos);
  in_windows.output = drive.below("none");
  in_windows.windows.window_scans = 2;
  expect_error(ErrorKind::usage, {"window_scans", "8"},
               [&] { run_calibrate(in_windows, session_); });
}

TEST_F(CalibrateDrive, WhatCannotBeIsSaidBeforeLongWork) {
  const HallDrive drive({});
  CalibrateJob nothing = job(drive, "out");
  nothing.calibrate.poses = nothing.calibrate.ranges = nothing.calibrate.elevations = false;
  nothing.calibrate.mount_correction = false;
  expect_error(ErrorKind::usage, {"nothing to estimate"},
               [&] { run_calibrate(nothing, session_); });
  expect_error(ErrorKind::usage, {"00"}, [&] { run_calibrate(job(drive, "00/out"), session_); });
  fs::create_directory(drive.below("full"));
  std::ofstream(drive.below("full") / "note.txt") << "mine";
  expect_error(ErrorKind::cannot_create, {"not empty"},
               [&] { run_calibrate(job(drive, "full"), session_); });
}

}  // namespace
}  // namespace adasplats
