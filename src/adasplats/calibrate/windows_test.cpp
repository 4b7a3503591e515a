// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/windows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "adasplats/calibrate/chain_system.h"
#include "adasplats/calibrate/common_errors.h"
#include "adasplats/calibrate/trajectory_fit.h"
#include "adasplats/calibrate/window_gauges.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/recorded_progress_test.h"

namespace adasplats {
namespace {

std::pair<Calibration, CalibrationReport> on_cpu(const PointCloud& cloud,
                                                 const CalibrateOptions& options) {
  return calibrate(cloud, options, Executor(2));
}

constexpr double kStep_m = 1.5;
constexpr std::uint32_t kPoints = 2000;  // of a scan
constexpr std::size_t kLasers = 7;       // not 8: every eighth point is held out

/// A straight street with buttresses on its walls; between two scans of the drive a tunnel.
struct Street {
  std::size_t scans = 120;
  std::size_t tunnel_begin = 0, tunnel_end = 0;
  double turn_deg = 0.1, shift_m = 0.05, range_m = 0.02;
};

Vec3d street_point(Random& random, double x) {
  const double along = x + random.uniform(-12, 12);
  const double side = random.uniform(0, 1) < 0.5 ? -1 : 1;
  const double surface = random.uniform(0, 1);
  if (surface < 0.4) return {along, random.uniform(-8, 8), 0};
  if (surface < 0.7) return {along, 8 * side, random.uniform(0, 6)};
  return {6 * std::round(along / 6), side * random.uniform(6, 8), random.uniform(0, 6)};
}

Vec3d tunnel_point(Random& random, double x) {
  const double along = x + random.uniform(-12, 12);
  if (random.uniform(0, 1) < 0.3) return {along, random.uniform(-4, 4), 0};
  const double angle = random.uniform(0, std::numbers::pi);
  return {along, 4 * std::cos(angle), 4 * std::sin(angle)};
}

double range_offset_m(const Street& street, std::size_t laser) {
  return street.range_m * (static_cast<double>(laser) - 3) / 3;
}

RigidTransform true_pose(std::size_t scan) {
  const double s = static_cast<double>(scan);
  return {rotation_from_yaw_pitch_roll(0.1 * std::sin(0.07 * s), 0.01 * std::sin(0.3 * s), 0),
          {kStep_m * s, std::sin(0.1 * s), 1.8 + 0.05 * std::sin(0.2 * s)}};
}

/// Drift over a minute of 60 scans.
RigidTransform given_pose(const Street& street, std::size_t scan) {
  const double phase = 2 * std::numbers::pi * static_cast<double>(scan) / 60;
  const double turn = street.turn_deg * kDegree;
  const RigidTransform pose = true_pose(scan);
  return {rotation_from_yaw_pitch_roll(turn * std::sin(phase), 0.7 * turn * std::cos(phase),
                                       0.5 * turn * std::sin(2 * phase)) *
              pose.rotation,
          pose.translation +
              street.shift_m * Vec3d{std::sin(phase), std::cos(phase), 0.5 * std::sin(phase)}};
}

/// Reads scans [begin, end) of the drive, as calibrate_windows() requests them.
PointCloud record_street(const Street& street, ScanSpan span) {
  PointCloud cloud;
  for (std::size_t scan = span.begin; scan < span.end; ++scan) {
    const RigidTransform given = given_pose(street, scan), pose = true_pose(scan);
    const double x = pose.translation.x;
    cloud.scan_poses.push_back({0.1 * static_cast<double>(scan), given});
    for (std::size_t i = 0; i < kPoints; ++i) {
      Random random(4, scan, i);
      const bool in_tunnel = scan >= street.tunnel_begin && scan < street.tunnel_end;
      const Vec3d world = in_tunnel ? tunnel_point(random, x) : street_point(random, x);
      const Vec3d way = pose.inverse() * world;
      const std::size_t laser = i % kLasers;
      const double range_m = length(way) + 0.005 * random.normal() - range_offset_m(street, laser);
      cloud.positions.push_back(vec_cast<float>(given * (range_m / length(way) * way)));
      cloud.sensor_positions.push_back(vec_cast<float>(given.translation));
      cloud.scan_indices.push_back(static_cast<std::uint32_t>(scan - span.begin));
      cloud.lasers.push_back(static_cast<std::uint16_t>(laser));
    }
  }
  return cloud;
}

/// A street that is read in pieces, and a record of the reads.
struct ReadStreet {
  Street street;
  std::vector<ScanSpan> reads;

  std::vector<DriveSource> sources() {
    return {{street.scans, [this](ScanSpan span) {
               reads.push_back(span);
               return record_street(street, span);
             }}};
  }
};

WindowedCalibration calibrated(ReadStreet& street, std::size_t window_scans,
                               const CalibrateOptions& options = {}) {
  RecordedProgress progress;
  return calibrate_windows(street.sources(), options, {window_scans}, on_cpu, Executor(2),
                           progress);
}

/// Largest error of the motion between scans that are `apart` scans apart.
double worst_step_m(const Calibration& found, const Street& street, std::size_t apart) {
  double worst_m = 0;
  const auto pose = [&](std::size_t scan) {
    return found.poses[scan].corrected_from_given() * given_pose(street, scan);
  };
  for (std::size_t scan = 0; scan + apart < street.scans; ++scan) {
    const Vec3d way = (pose(scan).inverse() * pose(scan + apart)).translation;
    const Vec3d expected = (true_pose(scan).inverse() * true_pose(scan + apart)).translation;
    worst_m = std::max(worst_m, length(way - expected));
  }
  return worst_m;
}

// Oracle: the required properties, for all small numbers.
TEST(Windows, CoverADriveAndOverlapByHalf) {
  for (std::size_t window = 2; window < 40; ++window) {
    for (std::size_t scans = 1; scans < 130; ++scans) {
      const std::vector<ScanSpan> spans = cut_windows(scans, window);
      ASSERT_EQ(spans.front().begin, 0U);
      ASSERT_EQ(spans.back().end, scans);
      ASSERT_EQ(spans.size() == 1, scans <= window);
      for (std::size_t k = 0; k < spans.size(); ++k) {
        ASSERT_LE(spans[k].size(), window) << scans;
        if (k == 0) continue;
        const std::size_t overlap = spans[k - 1].end - spans[k].begin;
        ASSERT_LE(std::max(2 * overlap, spans[k].size()),
                  std::min(2 * overlap, spans[k].size()) + 1)
            << scans << " by " << window;
        if (k > 1) {
          ASSERT_EQ(spans[k].begin, spans[k - 2].end);
        }
      }
    }
  }
}

// Oracle: elimination in the dense matrix.
TEST(Windows, AChainIsSolvedLikeTheDenseMatrix) {
  constexpr std::size_t kCount = 4, kSize = kCount * ChainSystem::kUnknowns;
  ChainSystem chain(kCount);
  std::vector<std::vector<double>> whole(kSize, std::vector<double>(kSize + 1));
  Random random(9, 0, 0);
  for (std::size_t k = 0; k < kCount; ++k) {
    ChainSystem::Block own{}, coupling{};
    ChainSystem::Column right{};
    for (std::size_t r = 0; r < ChainSystem::kUnknowns; ++r) {
      right[r] = random.normal();
      for (std::size_t c = 0; c <= r; ++c) own[r][c] = own[c][r] = random.uniform(-0.3, 0.3);
      own[r][r] = 8;
      for (double& value : coupling[r]) value = random.uniform(-0.3, 0.3);
    }
    chain.add(k, k, own);
    chain.add(k, right);
    if (k > 0) chain.add(k, k - 1, coupling);
    for (std::size_t r = 0; r < ChainSystem::kUnknowns; ++r) {
      const std::size_t row = k * ChainSystem::kUnknowns + r;
      whole[row][kSize] = right[r];
      for (std::size_t c = 0; c < ChainSystem::kUnknowns; ++c) {
        whole[row][k * ChainSystem::kUnknowns + c] = own[r][c];
        if (k == 0) continue;
        const std::size_t before = (k - 1) * ChainSystem::kUnknowns + c;
        whole[row][before] = whole[before][row] = coupling[r][c];
      }
    }
  }
  for (std::size_t pivot = 0; pivot < kSize; ++pivot)
    for (std::size_t row = 0; row < kSize; ++row) {
      if (row == pivot) continue;
      const double factor = whole[row][pivot] / whole[pivot][pivot];
      for (std::size_t c = 0; c <= kSize; ++c) whole[row][c] -= factor * whole[pivot][c];
    }
  const std::vector<double> x = chain.solve();
  for (std::size_t row = 0; row < kSize; ++row)
    EXPECT_NEAR(x[row], whole[row][kSize] / whole[row][row], 1e-12);
}

/// Slowly drifting corrections along a curved path.
std::vector<PoseCorrection> drifting(std::size_t scans) {
  std::vector<PoseCorrection> poses;
  for (std::size_t k = 0; k < scans; ++k) {
    const double s = static_cast<double>(k);
    poses.push_back({0.1 * s,
                     {s, 5 * std::sin(0.05 * s), 1.8},
                     {0.001 * std::sin(0.1 * s), 0, 0.002 * std::cos(0.1 * s)},
                     {0.05 * std::sin(0.08 * s), 0.03 * std::cos(0.1 * s), 0}});
  }
  return poses;
}

std::vector<WindowPoses> windows_of(const std::vector<PoseCorrection>& poses,
                                    std::size_t window_scans) {
  std::vector<WindowPoses> windows;
  for (const ScanSpan& span : cut_windows(poses.size(), window_scans)) {
    WindowPoses window;
    window.begin = span.begin;
    window.poses.assign(poses.begin() + static_cast<std::ptrdiff_t>(span.begin),
                        poses.begin() + static_cast<std::ptrdiff_t>(span.end));
    windows.push_back(window);
  }
  return windows;
}

Trajectory given_of(const std::vector<PoseCorrection>& poses) {
  Trajectory given;
  for (const PoseCorrection& pose : poses) given.push_back({pose.time_s, {{}, pose.position}});
  return given;
}

/// Largest difference of corrections after a rigid alignment.
PoseDisagreement apart_as_a_whole(std::vector<PoseCorrection> a, std::vector<PoseCorrection> b) {
  align_to_given(a);
  align_to_given(b);
  return disagreement_of(a, b);
}

// Oracle: the corrections from which the windows were cut.
TEST(Windows, RigidMotionsOfWindowsAreUndone) {
  const std::vector<PoseCorrection> truth = drifting(130);
  std::vector<WindowPoses> windows = windows_of(truth, 40);
  ASSERT_EQ(windows.size(), 6U);
  for (std::size_t k = 0; k < windows.size(); ++k) {
    Random random(2, 0, k);
    const auto number = [&](double size) { return random.uniform(-size, size); };
    const RigidTransform motion = moved_about(windows[k].poses.front().position,
                                              {number(0.003), number(0.003), number(0.003)},
                                              {number(0.05), number(0.05), number(0.05)});
    for (PoseCorrection& pose : windows[k].poses) pose = moved(pose, motion);
  }
  const std::vector<PoseDisagreement> apart = settle_windows(windows, {});
  EXPECT_EQ(apart[0].scans, 0U);
  for (std::size_t k = 1; k < windows.size(); ++k) {
    EXPECT_EQ(apart[k].scans, windows[k - 1].end() - windows[k].begin);
    EXPECT_LT(apart[k].largest_shift_m, 1e-4);
    EXPECT_LT(apart[k].largest_rotation_rad, 1e-5);
  }
  EXPECT_LT(apart_as_a_whole(blended(windows, given_of(truth)), truth).largest_shift_m, 5e-4);
}

TEST(Windows, ASingleWindowIsAlignedToTheGivenPoses) {
  std::vector<WindowPoses> windows = windows_of(drifting(30), 40);
  ASSERT_EQ(windows.size(), 1U);
  for (PoseCorrection& pose : windows[0].poses)
    pose = {pose.time_s, pose.position, {}, {0.2, -0.1, 0.3}};
  settle_windows(windows, {});
  for (const PoseCorrection& pose : windows[0].poses) EXPECT_LT(length(pose.shift_m), 1e-9);
  EXPECT_TRUE(settle_windows({}, {}).empty());
}

// Oracle: windows with corrections of alternately 0 and 1, so the blended value is the weight.
TEST(Windows, BlendingLeavesNoSteps) {
  const std::vector<PoseCorrection> truth = drifting(120);
  std::vector<WindowPoses> windows = windows_of(truth, 40);
  for (std::size_t k = 0; k < windows.size(); ++k)
    for (PoseCorrection& pose : windows[k].poses)
      pose.shift_m = pose.rotation_rad = {static_cast<double>(k % 2), 0, 0};
  const std::vector<PoseCorrection> poses = blended(windows, given_of(truth));
  // Of a squared sine over the 20 scans of an overlap.
  const double steepest = 0.5 * std::numbers::pi / 20;
  for (std::size_t scan = 1; scan < poses.size(); ++scan) {
    EXPECT_LE(std::fabs(poses[scan].shift_m.x - poses[scan - 1].shift_m.x), steepest);
    EXPECT_GE(poses[scan].shift_m.x, 0);
    EXPECT_LE(poses[scan].shift_m.x, 1);
  }
  EXPECT_EQ(poses[0].shift_m.x, 0);
  EXPECT_GT(poses[39].shift_m.x, 0.99);
  EXPECT_LT(poses[59].shift_m.x, 0.01);
}

TEST(Windows, GapsAreInterpolatedBetweenNeighbours) {
  const std::vector<PoseCorrection> truth = drifting(100);
  std::vector<WindowPoses> windows = windows_of(truth, 20);
  for (std::size_t k = 3; k < 6; ++k) windows[k].poses.clear();
  const std::vector<PoseCorrection> poses = blended(windows, given_of(truth));
  const std::size_t before = windows[2].end() - 1, behind = windows[6].begin;
  ASSERT_LT(before + 1, behind);
  EXPECT_EQ(poses[before].shift_m, truth[before].shift_m);
  EXPECT_EQ(poses[behind].shift_m, truth[behind].shift_m);
  const std::size_t middle = (before + behind) / 2;
  const double share = static_cast<double>(middle - before) / static_cast<double>(behind - before);
  const Vec3d expected =
      truth[before].shift_m + share * (truth[behind].shift_m - truth[before].shift_m);
  EXPECT_LT(length(poses[middle].shift_m - expected), 1e-12);
  for (WindowPoses& window : windows) window.poses.clear();
  EXPECT_TRUE(blended(windows, given_of(truth)).empty());
}

// Oracle: the applied motion; the mean of the poses would follow the outlier.
TEST(TrajectoryFit, UndoesARigidMotionDespiteAnOutlier) {
  Random random(1, 0, 0);
  std::vector<PoseCorrection> poses;
  for (std::size_t k = 0; k < 60; ++k) {
    const auto normal = [&](double size) {
      return size * Vec3d{random.normal(), random.normal(), random.normal()};
    };
    poses.push_back(
        {0.1 * static_cast<double>(k), {static_cast<double>(k), 0, 0}, normal(1e-4), normal(1e-3)});
  }
  poses[20].shift_m = {0, 0, 1};
  const RigidTransform motion = moved_about({30, 0, 0}, {0.002, -0.003, 0.004}, {0.1, 0.2, -0.1});
  std::vector<PoseCorrection> shifted;
  for (const PoseCorrection& pose : poses) shifted.push_back(moved(pose, motion));
  const RigidTransform whole = onto_given(shifted) * motion;
  for (const double x : {0.0, 30.0, 60.0})
    EXPECT_LT(length(whole * Vec3d{x, 0, 0} - Vec3d{x, 0, 0}), 0.001);
  EXPECT_LT(length(rotation_vector(whole.rotation)), 5e-5);
  EXPECT_EQ(onto_given({}).translation, Vec3d{});
}

TEST(CommonErrors, AWrongWindowIsOutvoted) {
  std::vector<WindowFinding> findings(5);
  for (std::size_t k = 0; k < findings.size(); ++k) {
    const double error = k == 2 ? 0.1 : 0.0001 * static_cast<double>(k);
    findings[k].lasers = {{0.02 + error, -0.02 - error}, {0.001, -0.001}};
    findings[k].weight = 1;
  }
  const CommonErrors common = pooled(findings, {});
  EXPECT_EQ(common.laser_windows, 5U);
  EXPECT_NEAR(common.lasers.range_m[0], 0.02, 3e-4);
  EXPECT_NEAR(common.lasers.range_m[1], -0.02, 3e-4);
  EXPECT_NEAR(common.lasers.elevation_rad[0], 0.001, 1e-9);
  EXPECT_NEAR(common.range_disagreement_m, 0.1 / std::sqrt(5.0), 1e-3);
  EXPECT_TRUE(pooled({}, {}).lasers.empty());
}

MountReport mount_report(Vec3d rotation_rad, Vec3d shift_m) {
  MountReport report;
  report.found.mount = {rotation_rad, shift_m};
  report.found.rotation_sd_rad = {1e-4, 1e-4, 1e-4};
  report.found.shift_sd_m = {0.002, 0.002, 0.002};
  report.found.planes = 1000;
  report.found.deviations = 20;
  return report;
}

// Oracle: the mount; each window observes a part of it.
TEST(CommonErrors, AMountIsPooledFromTheObservedDirections) {
  std::vector<WindowFinding> findings(2);
  findings[0].mount = mount_report({0, 0, 0.02}, {0.3, 0, 0});
  findings[0].mount->found.not_observed = {{"lever arm along y", {}, {0, 1, 0}},
                                           {"lever arm along z", {}, {0, 0, 1}}};
  findings[1].mount = mount_report({0, 0, 0.02}, {0, 0.2, 0});
  findings[1].mount->found.not_observed = {{"lever arm along x", {}, {1, 0, 0}},
                                           {"lever arm along z", {}, {0, 0, 1}}};
  const CommonErrors common = pooled(findings, {});
  ASSERT_TRUE(common.mount);
  EXPECT_EQ(common.mount->objection, "");
  EXPECT_EQ(common.mount_windows, 2U);
  EXPECT_LT(length(common.mount->found.mount.shift_m - Vec3d{0.3, 0.2, 0}), 1e-4);
  EXPECT_LT(length(common.mount->found.mount.rotation_rad - Vec3d{0, 0, 0.02}), 1e-6);
  ASSERT_EQ(common.mount->found.not_observed.size(), 1U);
  EXPECT_EQ(common.mount->found.not_observed[0].name, "lever arm along z");
}

TEST(CommonErrors, AMinorityOfWindowsCorrectsNoMount) {
  std::vector<WindowFinding> findings(4);
  for (WindowFinding& finding : findings) {
    finding.mount = mount_report({}, {});
    finding.mount->objection = "it is not clear from the data";
  }
  EXPECT_EQ(pooled(findings, {}).mount->objection, "it is not clear from the data");
  findings[1].mount->objection.clear();
  EXPECT_NE(pooled(findings, {}).mount->objection.find("only 1 of 4"), std::string::npos);
}

// Oracle: one solve of the same scans, and the simulated errors.
TEST(CalibrateWindows, MatchASingleSolve) {
  ReadStreet street;
  const PointCloud whole = record_street(street.street, {0, street.street.scans});
  const Calibration one = calibrate(whole, {}, Executor(2)).first;
  const WindowedCalibration found = calibrated(street, 40);
  ASSERT_TRUE(found.report.windows);
  EXPECT_EQ(found.report.objection, "");
  EXPECT_EQ(found.report.windows->windows.size(), 5U);
  EXPECT_EQ(found.report.windows->without_evidence(), 0U);
  EXPECT_LT(found.report.windows->overlaps.largest_shift_m, 0.002);
  EXPECT_LT(found.report.windows->range_disagreement_m, 0.002);
  EXPECT_LT(found.report.calibrated_m, 0.5 * found.report.given_m);
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    EXPECT_NEAR(found.calibration.lasers.range_m[laser], one.lasers.range_m[laser], 0.001);
    EXPECT_NEAR(found.calibration.lasers.range_m[laser], range_offset_m({}, laser), 0.002);
  }
  const PoseDisagreement apart = disagreement_of(one.poses, found.calibration.poses);
  EXPECT_LT(apart.median_shift_m, 0.003);
  EXPECT_LT(apart.largest_shift_m, 0.01);
  EXPECT_LT(apart.largest_rotation_rad, 0.01 * kDegree);
  EXPECT_LT(worst_step_m(found.calibration, street.street, 1), 0.002);
  EXPECT_LT(worst_step_m(found.calibration, street.street, 20), 0.005);
  Calibration nothing = found.calibration;
  for (PoseCorrection& pose : nothing.poses) pose.rotation_rad = pose.shift_m = {};
  EXPECT_GT(worst_step_m(nothing, street.street, 20), 0.04);
}

TEST(CalibrateWindows, ATunnelInTheMiddleIsReportedAndNotCorrected) {
  ReadStreet street;
  street.street.tunnel_begin = 31;
  street.street.tunnel_end = 89;
  const WindowedCalibration found = calibrated(street, 40);
  const std::vector<WindowReport>& windows = found.report.windows->windows;
  ASSERT_EQ(windows.size(), 5U);
  EXPECT_EQ(found.report.windows->without_evidence(), 1U);
  EXPECT_NE(windows[2].objection.find("straight tunnel"), std::string::npos)
      << windows[2].objection;
  EXPECT_EQ(windows[2].begin, 40U);
  EXPECT_EQ(windows[2].end, 80U);
  EXPECT_EQ(windows[2].overlap.scans, 0U);
  // The common laser offsets apply to it, too.
  EXPECT_NEAR(found.calibration.lasers.range_m[0], range_offset_m({}, 0), 0.003);
  EXPECT_LT(windows[2].common_m, windows[2].given_m);
  ASSERT_EQ(found.calibration.poses.size(), 120U);
}

// Oracle: the recorded reads are all that is in memory.
TEST(CalibrateWindows, ReadHalfAWindowAtATime) {
  ReadStreet street;
  street.street.scans = 100;
  CalibrateOptions options;
  options.ranges = options.elevations = options.mount_correction = false;
  const WindowedCalibration found = calibrated(street, 40, options);
  ASSERT_EQ(street.reads.size(), 5U);
  std::size_t next = 0;
  for (const ScanSpan& span : street.reads) {
    EXPECT_EQ(span.begin, next);
    EXPECT_LE(span.size(), 20U);
    next = span.end;
  }
  EXPECT_EQ(next, 100U);
  EXPECT_EQ(found.given.size(), 100U);
  EXPECT_EQ(found.calibration.poses.size(), 100U);
  EXPECT_TRUE(found.calibration.lasers.empty());
}

TEST(CalibrateWindows, NothingIsAppliedWithoutErrors) {
  ReadStreet street;
  street.street.scans = 80;
  street.street.turn_deg = street.street.shift_m = street.street.range_m = 0;
  const WindowedCalibration found = calibrated(street, 40);
  EXPECT_TRUE(found.calibration.empty());
  EXPECT_NE(found.report.objection.find("no window has evidence"), std::string::npos)
      << found.report.objection;
}

// Oracle: reading the same scans piece by piece.
TEST(CalibrateWindows, MatchForACloudInMemory) {
  ReadStreet street;
  street.street.scans = 60;
  PointCloud cloud = record_street(street.street, {0, 60});
  const WindowedCalibration read = calibrated(street, 30);
  // Shuffled: the points of a scan need not be contiguous.
  std::vector<std::uint32_t> order(cloud.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = (i % 60) * kPoints + i / 60;
  RecordedProgress progress;
  const auto [found, report] =
      calibrate_drives(gather(cloud, order), {}, {30}, on_cpu, Executor(2), progress);
  ASSERT_TRUE(report.windows);
  EXPECT_EQ(report.windows->windows.size(), 3U);
  EXPECT_EQ(disagreement_of(found.poses, read.calibration.poses).largest_shift_m, 0);
  EXPECT_EQ(found.lasers.range_m, read.calibration.lasers.range_m);
  // Not longer than a window: solved together.
  EXPECT_FALSE(calibrate_drives(cloud, {}, {60}, on_cpu, Executor(2), progress).second.windows);
}

}  // namespace
}  // namespace adasplats
