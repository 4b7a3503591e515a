// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/calibrate/recorded_hall_test.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/base/engines.h"

// The oracle of all tests is the CPU on the same drive.
namespace adasplats {
namespace {

using PointSet = CalibrationSteps::PointSet;

class CalibrateOnGpu : public testing::Test {
 protected:
  void SetUp() override {
    if (find_gpus().devices.empty()) GTEST_SKIP() << find_gpus().reason;
  }

  Executor executor_{2};
};

/// Number of values that differ in any bit, including surplus values of either side.
template <class T>
std::size_t count_different(const std::vector<T>& a, const std::vector<T>& b) {
  const std::size_t common = std::min(a.size(), b.size());
  std::size_t different = std::max(a.size(), b.size()) - common;
  for (std::size_t i = 0; i < common; ++i)
    different += std::memcmp(&a[i], &b[i], sizeof(T)) == 0 ? 0 : 1;
  return different;
}

void expect_same(const PlaneBlocks& a, const PlaneBlocks& b) {
  EXPECT_EQ(count_different(a.poses, b.poses), 0U) << "blocks of scans";
  EXPECT_EQ(count_different(a.lasers, b.lasers), 0U) << "blocks of lasers";
}

void expect_same(const PlaneStep& a, const PlaneStep& b) {
  EXPECT_EQ(count_different(a.poses, b.poses), 0U) << "scans";
  EXPECT_EQ(count_different(a.lasers, b.lasers), 0U) << "lasers";
}

/// Every other point belongs to the coarse set; the corrections are those of a mount error.
struct Drive {
  const PointCloud& cloud;
  ChosenPoints few, all;
  std::vector<Vec3d> axes;
  ScanCorrections corrections;
  std::size_t lasers = 0;

  explicit Drive(const PointCloud& given) : cloud(given) {
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
      all.indices.push_back(i);
      all.scans.push_back(cloud.scan_indices[i]);
      if (i % 2 != 0) continue;
      few.indices.push_back(i);
      few.scans.push_back(cloud.scan_indices[i]);
    }
    all.left_out_every = 8;
    all.left_out_end = static_cast<std::uint32_t>(all.indices.size() / 2);
    const RigidTransform correction = {rotation_from_yaw_pitch_roll(0.01, -0.02, 0.005),
                                       {0.02, 0.01, -0.03}};
    for (const TimedPose& pose : cloud.scan_poses) {
      axes.push_back(pose.world_from_sensor.rotation * Vec3d{0, 0, 1});
      corrections.corrected_from_given.push_back(correction);
      corrections.pivots.push_back(correction * pose.world_from_sensor.translation);
    }
    lasers = cloud.lasers.empty() ? 0 : kHallLasers;
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      corrections.offsets.range_m.push_back(0.002 * static_cast<double>(laser));
      corrections.offsets.elevation_rad.push_back(1e-4 * static_cast<double>(laser));
      corrections.offsets.azimuth_rad.push_back(-2e-4 * static_cast<double>(laser));
    }
  }
};

/// Runs all steps in sequence; returns the number of planes.
std::size_t compare_steps(const Drive& drive, PointSet set, const RowOptions& options,
                          const Executor& executor) {
  const auto cpu = make_cpu_calibration_steps(executor);
  const auto gpu = make_cuda_calibration_steps(0);
  std::vector<ScanPlane> planes;
  for (CalibrationSteps* steps : {cpu.get(), gpu.get()})
    steps->load(drive.cloud, drive.few, drive.all, drive.axes, drive.lasers);
  for (const double flatness_m : {0.25, 0.01}) {  // the other one leaves cells to divide
    ScanPlaneOptions of_planes;
    of_planes.flatness_m = flatness_m;
    for (CalibrationSteps* steps : {cpu.get(), gpu.get()}) steps->correct(set, drive.corrections);
    planes = cpu->find_planes(set, of_planes);
    EXPECT_EQ(count_different(planes, gpu->find_planes(set, of_planes)), 0U) << "planes";
    EXPECT_EQ(count_different(cpu->left_out_residuals(), gpu->left_out_residuals()), 0U);
    EXPECT_EQ(
        count_different(cpu->left_out_distances(0.25, 200), gpu->left_out_distances(0.25, 200)),
        0U);
    cpu->choose_rows(options);
    gpu->choose_rows(options);
    const PlaneBlocks blocks = cpu->sum_rows(drive.corrections, options);
    expect_same(blocks, gpu->sum_rows(drive.corrections, options));
    PlaneStep x;
    for (std::size_t i = 0; i < 6 * blocks.poses.size(); ++i)
      x.poses.push_back(std::sqrt(static_cast<double>(i)));
    for (std::size_t i = 0; i < kLaserUnknowns * blocks.lasers.size(); ++i)
      x.lasers.push_back(1 / (1 + static_cast<double>(i)));
    expect_same(cpu->coupled(x), gpu->coupled(x));
  }
  return planes.size();
}

RowOptions row_options() {
  RowOptions options;
  options.max_points = 60;
  options.max_weight = 30;
  options.width_m = 0.1;
  options.azimuths = true;
  return options;
}

TEST_F(CalibrateOnGpu, EveryStepMatchesTheCpu) {
  const PointCloud cloud = record_hall({0.3, 0.1, 0.03, 0.05}).cloud;
  const Drive drive(cloud);
  EXPECT_GT(compare_steps(drive, PointSet::all, row_options(), executor_), 100U);
  // A fifth of the points gives fewer planes.
  EXPECT_GT(compare_steps(drive, PointSet::few, row_options(), executor_), 20U);
}

TEST_F(CalibrateOnGpu, PartialUnknownsMatchTheCpu) {
  PointCloud cloud = record_hall({0.3, 0.1, 0.03, 0.05}).cloud;
  RowOptions options = row_options();
  options.ranges = false;
  EXPECT_GT(compare_steps(Drive(cloud), PointSet::all, options, executor_), 100U);
  options.poses = false;
  options.ranges = true;
  EXPECT_GT(compare_steps(Drive(cloud), PointSet::all, options, executor_), 100U);
  // Some lasers are unknown.
  for (std::size_t i = 0; i < cloud.size(); i += 3) cloud.lasers[i] = kNoLaser;
  EXPECT_GT(compare_steps(Drive(cloud), PointSet::all, row_options(), executor_), 100U);
  cloud.lasers.clear();
  EXPECT_GT(compare_steps(Drive(cloud), PointSet::all, row_options(), executor_), 100U);
}

TEST_F(CalibrateOnGpu, NoPlanesAndNoPointsMatchTheCpu) {
  PointCloud cloud = record_hall({}, 2).cloud;
  for (std::uint32_t& scan : cloud.scan_indices) scan = 1;  // no plane was seen by two
  EXPECT_EQ(compare_steps(Drive(cloud), PointSet::all, row_options(), executor_), 0U);
  Drive none(cloud);
  none.all = none.few = {};
  EXPECT_EQ(compare_steps(none, PointSet::all, row_options(), executor_), 0U);
}

void expect_same(const Calibration& a, const Calibration& b) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  EXPECT_EQ(count_different(a.poses, b.poses), 0U) << "poses";
  EXPECT_EQ(count_different(a.lasers.range_m, b.lasers.range_m), 0U) << "ranges";
  EXPECT_EQ(count_different(a.lasers.elevation_rad, b.lasers.elevation_rad), 0U) << "elevations";
  EXPECT_EQ(a.mount.rotation_rad, b.mount.rotation_rad);
  EXPECT_EQ(a.mount.shift_m, b.mount.shift_m);
  EXPECT_EQ(a.smooth_s, b.smooth_s);
}

/// Returns the report of the CPU.
CalibrationReport compare(const PointCloud& cloud, const CalibrateOptions& options,
                          const Executor& executor) {
  const auto [cpu, report] = calibrate(cloud, options, executor);
  const auto steps = make_cuda_calibration_steps(0);
  const auto [gpu, report_of_gpu] = calibrate(cloud, options, *steps, executor);
  expect_same(cpu, gpu);
  EXPECT_EQ(report.objection, report_of_gpu.objection);
  EXPECT_EQ(report.planes, report_of_gpu.planes);
  EXPECT_EQ(report.points, report_of_gpu.points);
  EXPECT_EQ(report.given_m, report_of_gpu.given_m);
  EXPECT_EQ(report.calibrated_m, report_of_gpu.calibrated_m);
  EXPECT_EQ(report.given.counts, report_of_gpu.given.counts);
  EXPECT_EQ(report.calibrated.counts, report_of_gpu.calibrated.counts);
  EXPECT_EQ(report.weakest_share, report_of_gpu.weakest_share);
  EXPECT_EQ(report.mount.has_value(), report_of_gpu.mount.has_value());
  if (report.mount && report_of_gpu.mount) {
    EXPECT_EQ(report.mount->objection, report_of_gpu.mount->objection);
    EXPECT_EQ(report.mount->given_m, report_of_gpu.mount->given_m);
    EXPECT_EQ(report.mount->mounted_m, report_of_gpu.mount->mounted_m);
  }
  return report;
}

TEST_F(CalibrateOnGpu, CalibrationsMatchTheCpu) {
  PointCloud cloud = record_hall({0.3, 0.1, 0.03, 0.05}).cloud;
  EXPECT_EQ(compare(cloud, {}, executor_).objection, "");
  CalibrateOptions options;
  options.points_a_scan = 2000;  // some points are skipped
  options.poses = false;
  compare(cloud, options, executor_);
  cloud.origin_kinds.assign(cloud.size(), OriginKind::measured);
  for (std::size_t i = 0; i < cloud.size(); i += 5) cloud.origin_kinds[i] = OriginKind::guessed;
  compare(cloud, {}, executor_);
  cloud.lasers.clear();
  compare(cloud, {}, executor_);
}

// A mount error is validated on both.
TEST_F(CalibrateOnGpu, MountsMatchTheCpu) {
  PointCloud cloud = record_hall({0, 0, 0, 0}, 16).cloud;
  const RigidTransform fault = {rotation_from_yaw_pitch_roll(0.03, 0.02, 0), {0.2, 0.1, 0}};
  for (TimedPose& pose : cloud.scan_poses) {
    const RigidTransform given = pose.world_from_sensor * fault;
    const std::size_t scan = static_cast<std::size_t>(&pose - cloud.scan_poses.data());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (cloud.scan_indices[i] != scan) continue;
      cloud.positions[i] = vec_cast<float>(
          given * (pose.world_from_sensor.inverse() * vec_cast<double>(cloud.positions[i])));
      cloud.sensor_positions[i] = vec_cast<float>(given.translation);
    }
    pose.world_from_sensor = given;
  }
  const CalibrationReport report = compare(cloud, {}, executor_);
  ASSERT_TRUE(report.mount);
  EXPECT_GT(report.mount->given_m, 0) << report.mount->objection;
}

TEST_F(CalibrateOnGpu, RejectedCalibrationsMatchTheCpu) {
  EXPECT_NE(compare(record_hall({}).cloud, {}, executor_).objection, "");
}

}  // namespace
}  // namespace adasplats
