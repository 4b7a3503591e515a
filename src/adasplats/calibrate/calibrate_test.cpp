// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/calibrate/recorded_hall_test.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

double rms(const std::vector<double>& found, const std::vector<double>& expected) {
  double sum = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    sum += std::pow(found[i] - expected[i], 2) / static_cast<double>(expected.size());
  return std::sqrt(sum);
}

/// Error of the elevation offsets, without the part that stretches the scene (proportional to
/// cos * sin of the elevation): the walls and floors of a hall do not observe it.
double rms_but_for_stretch(const std::vector<double>& found, const std::vector<double>& expected) {
  double product = 0, square = 0;
  std::vector<double> difference(kHallLasers), stretch(kHallLasers);
  double mean = 0;
  for (std::size_t laser = 0; laser < kHallLasers; ++laser) {
    const double elevation = hall_elevation_rad(laser);
    stretch[laser] = std::sin(elevation) * std::cos(elevation);
    mean += stretch[laser] / kHallLasers;
  }
  for (std::size_t laser = 0; laser < kHallLasers; ++laser) {
    stretch[laser] -= mean;
    difference[laser] = found[laser] - expected[laser];
    product += stretch[laser] * difference[laser];
    square += stretch[laser] * stretch[laser];
  }
  for (std::size_t laser = 0; laser < kHallLasers; ++laser)
    difference[laser] -= product / square * stretch[laser];
  return rms(difference, std::vector<double>(kHallLasers));
}

/// Largest errors of the poses relative to that of the first scan.
struct PoseErrors {
  double turn_deg = 0, shift_m = 0;
};
PoseErrors errors_of(const Calibration& found, const HallRecording& recording) {
  const auto pose = [&](std::size_t scan) {
    return found.poses[scan].corrected_from_given() *
           recording.cloud.scan_poses[scan].world_from_sensor;
  };
  PoseErrors worst;
  for (std::size_t scan = 1; scan < recording.true_poses.size(); ++scan) {
    const RigidTransform step = pose(0).inverse() * pose(scan);
    const RigidTransform expected = recording.true_poses[0].inverse() * recording.true_poses[scan];
    worst.turn_deg =
        std::max(worst.turn_deg, angle_between(step.rotation, expected.rotation) / kDegree);
    worst.shift_m = std::max(worst.shift_m, length(step.translation - expected.translation));
  }
  return worst;
}

// Oracle: the simulated errors.
TEST(Calibrate, FindsPoseAndLaserErrors) {
  const HallRecording recording = record_hall({0.3, 0.1, 0.03, 0.05});
  const auto [found, report] = calibrate(recording.cloud, {}, Executor(2));
  EXPECT_EQ(report.objection, "");
  EXPECT_LT(report.calibrated_m, 0.25 * report.given_m);
  EXPECT_LT(rms(found.lasers.range_m, recording.offsets.range_m), 0.003);
  EXPECT_LT(rms_but_for_stretch(found.lasers.elevation_rad, recording.offsets.elevation_rad),
            0.025 * kDegree);
  const PoseErrors errors = errors_of(found, recording);
  EXPECT_LT(errors.turn_deg, 0.04);
  EXPECT_LT(errors.shift_m, 0.01);
}

// Oracle: the same beams without the errors.
TEST(Calibrate, CorrectedPointsAndSensorsMatchTheTruth) {
  HallRecording recording = record_hall({0.2, 0.05, 0.03, 0});
  const PointCloud expected = record_hall({0, 0, 0, 0}).cloud;
  const double before_m = length(vec_cast<double>(recording.cloud.positions[999]) -
                                 vec_cast<double>(expected.positions[999]));
  const Calibration found = calibrate(recording.cloud, {}, Executor(2)).first;
  apply(found, recording.cloud, Executor(2));
  double worst_m = 0, mean_m = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    mean_m += length(vec_cast<double>(recording.cloud.positions[i] - expected.positions[i])) /
              static_cast<double>(expected.size());
    worst_m = std::max(worst_m, length(vec_cast<double>(recording.cloud.sensor_positions[i] -
                                                        expected.sensor_positions[i])));
  }
  EXPECT_GT(before_m, 0.02);
  EXPECT_LT(mean_m, 0.04);  // the absolute position follows the given poses, which drift
  EXPECT_LT(worst_m, 0.06);
  EXPECT_EQ(length(vec_cast<double>(recording.cloud.sensor_positions[0]) -
                   recording.cloud.scan_poses[0].world_from_sensor.translation) < 1e-5,
            true);
}

TEST(Calibrate, CorrectDataIsNotChanged) {
  const auto [found, report] = calibrate(record_hall({}).cloud, {}, Executor(1));
  EXPECT_TRUE(found.empty());
  EXPECT_NE(report.objection.find("lie no better"), std::string::npos) << report.objection;
}

TEST(Calibrate, PosesNeedNoLaserNumbers) {
  HallRecording recording = record_hall({0.3, 0.1, 0, 0});
  recording.cloud.lasers.clear();
  const Calibration found = calibrate(recording.cloud, {}, Executor(2)).first;
  EXPECT_TRUE(found.lasers.empty());
  EXPECT_LT(errors_of(found, recording).shift_m, 0.01);
}

TEST(Calibrate, TheSameOnAnyNumberOfThreads) {
  const PointCloud cloud = record_hall({0.2, 0.05, 0.02, 0.03}, 6).cloud;
  const auto [one, report_of_one] = calibrate(cloud, {}, Executor(1));
  const auto [three, report_of_three] = calibrate(cloud, {}, Executor(3));
  ASSERT_FALSE(one.empty());
  EXPECT_EQ(one.lasers.range_m, three.lasers.range_m);
  EXPECT_EQ(one.lasers.elevation_rad, three.lasers.elevation_rad);
  EXPECT_EQ(one.poses.back().shift_m, three.poses.back().shift_m);
  EXPECT_EQ(report_of_one.calibrated_m, report_of_three.calibrated_m);
}

PointCloud ball_of_points() {
  PointCloud cloud;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    Random random(5, 0, i);
    const auto number = [&] { return static_cast<float>(random.uniform(-10, 10)); };
    cloud.positions.push_back({number(), number(), number()});
    cloud.sensor_positions.push_back({0, 0, 0});
    cloud.scan_indices.push_back(i % 2);
  }
  cloud.scan_poses = {{0, {}}, {0.1, {}}};
  return cloud;
}

TEST(Calibrate, NothingIsAppliedWithoutPlanes) {
  const auto [found, report] = calibrate(ball_of_points(), {}, Executor(1));
  EXPECT_TRUE(found.empty());
  EXPECT_NE(report.objection.find("too few planes"), std::string::npos) << report.objection;
}

/// A tunnel along x with an arched profile, scanned from inside.
TEST(Calibrate, AStraightTunnelDoesNotConstrainPoses) {
  PointCloud cloud;
  for (std::uint32_t scan = 0; scan < 8; ++scan) {
    const double x = 1.5 * scan;
    cloud.scan_poses.push_back({0.1 * scan, {{}, {x, 0.03 * (scan % 3), 1.8}}});
    for (std::uint32_t i = 0; i < 8000; ++i) {
      Random random(6, scan, i);
      const double along = random.uniform(-15, 15), angle = random.uniform(0, std::numbers::pi);
      const double radius_m = 4 + 0.005 * random.normal();
      const bool is_road = i % 3 == 0;
      cloud.positions.push_back(vec_cast<float>(
          is_road ? Vec3d{x + along, random.uniform(-4, 4), 0.005 * random.normal()}
                  : Vec3d{x + along, radius_m * std::cos(angle), radius_m * std::sin(angle)}));
      cloud.sensor_positions.push_back({static_cast<float>(x), 0, 1.8F});
      cloud.scan_indices.push_back(scan);
    }
  }
  const auto [found, report] = calibrate(cloud, {}, Executor(2));
  EXPECT_TRUE(found.empty());
  EXPECT_NE(report.objection.find("straight tunnel"), std::string::npos) << report.objection;
  EXPECT_GT(std::fabs(report.weakest.x), 0.99);
}

TEST(Calibrate, MissingDataIsNamed) {
  PointCloud cloud = record_hall({}, 3).cloud;
  PointCloud no_poses = cloud;
  no_poses.scan_poses.clear();
  EXPECT_STREQ(missing_for_calibration(no_poses), "no scans with a pose each");
  PointCloud no_sensors = cloud;
  no_sensors.sensor_positions.clear();
  EXPECT_STREQ(missing_for_calibration(no_sensors), "no sensor positions");
  cloud.scan_poses.pop_back();
  EXPECT_STREQ(missing_for_calibration(cloud), "scans without a pose");
  EXPECT_TRUE(calibrate(cloud, {}, Executor(1)).first.empty());
}

Calibration drive_along_x() {
  Calibration calibration;
  for (int k = 0; k < 4; ++k)
    calibration.poses.push_back(
        {10 + 0.2 * k, {2.0 * k, 0, 0}, {0, 0, 0.001 * k}, {0.01 * k, 0, 0}});
  return calibration;
}

TEST(Calibration, IsInterpolatedBetweenScans) {
  const auto found = drive_along_x().at(10.3, {3.1, 0.2, 0});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->shift_m.x, 0.015, 1e-12);
  EXPECT_NEAR(found->rotation_rad.z, 0.0015, 1e-12);
  EXPECT_EQ(found->position, (Vec3d{3.1, 0.2, 0}));
}

TEST(Calibration, LaserOffsetsMoveNoScan) {
  EXPECT_TRUE(drive_along_x().moves_scans());
  Calibration calibration;
  calibration.lasers.range_m = {0.01, 0.02};
  calibration.poses.push_back({10, {}, {}, {}});
  EXPECT_FALSE(calibration.moves_scans());
  calibration.mount.shift_m.z = 0.1;
  EXPECT_TRUE(calibration.moves_scans());
}

TEST(Calibration, IsHeldForOneScanBeyondTheEndsWithoutExtrapolation) {
  EXPECT_NEAR(drive_along_x().at(10.7, {7, 0, 0})->shift_m.x, 0.03, 1e-12);
  EXPECT_NEAR(drive_along_x().at(9.9, {-1, 0, 0})->shift_m.x, 0, 1e-12);
  EXPECT_FALSE(drive_along_x().at(11.0, {10, 0, 0}));
  EXPECT_FALSE(drive_along_x().at(9.7, {-3, 0, 0}));
}

TEST(Calibration, ScansOfAnotherDriveAreNotCorrected) {
  EXPECT_FALSE(drive_along_x().at(10.3, {3.1, 8, 0}));
  EXPECT_FALSE(drive_along_x().at(1e9, {3.1, 0, 0}));
}

TEST(Calibration, DriftIsEstimatedFromNeighboursAndNoiseFromManyScans) {
  Calibration drift, noise;
  for (int k = 0; k < 40; ++k) {
    Random random(8, 0, static_cast<std::uint64_t>(k));
    const double wave = std::sin(0.35 * k);
    drift.poses.push_back({0.1 * k, {1.0 * k, 0, 0}, {0, 0, 0.003 * wave}, {0.1 * wave, 0, 0}});
    noise.poses.push_back({0.1 * k,
                           {1.0 * k, 0, 0},
                           {0, 0, 0.002 * random.normal()},
                           {0.05 * random.normal(), 0, 0}});
  }
  drift.smooth_s = best_smoothing(drift);
  noise.smooth_s = best_smoothing(noise);
  EXPECT_LE(drift.smooth_s, 0.1001);
  EXPECT_GE(noise.smooth_s, 0.3999);
  EXPECT_NEAR(drift.at(2.05, {20.5, 0, 0})->shift_m.x, 0.1 * std::sin(0.35 * 20.5), 0.005);
  // Limit: the mean of two neighbours would err by 0.035 m.
  double square = 0;
  for (int k = 0; k < 39; ++k)
    square += std::pow(noise.at(0.1 * k + 0.05, {k + 0.5, 0, 0})->shift_m.x, 2) / 39;
  EXPECT_LT(std::sqrt(square), 0.03);
  // A scan of the calibration has its own correction.
  EXPECT_EQ(noise.at(0.1 * 7, {7, 0, 0})->shift_m, noise.poses[7].shift_m);
}

/// A periodic drift with this amplitude in metres over 80 scans, with 5 cm of noise.
Calibration noisy_drive(double wave_m, std::uint64_t seed) {
  Calibration calibration;
  for (std::size_t k = 0; k < 80; ++k) {
    const double s = static_cast<double>(k);
    Random random(11, seed, k);
    const auto noise = [&](double size) {
      return size * Vec3d{random.normal(), random.normal(), random.normal()};
    };
    calibration.poses.push_back({0.2 * s,
                                 {s, 0, 0},
                                 noise(0.0017),
                                 noise(0.05) + Vec3d{wave_m * std::sin(0.16 * s), 0, 0}});
  }
  calibration.smooth_s = best_smoothing(calibration);
  return calibration;
}

// Oracle: no drift. Single corrections are 8.7 cm long.
TEST(Calibration, PureNoiseIsSmoothedOverManyScans) {
  double square = 0;
  int by_many = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Calibration calibration = noisy_drive(0, seed);
    if (calibration.smooth_s < 0.2 * 7.9) continue;  // by chance neighbours predict nearly as well
    ++by_many;
    const Vec3d middle = calibration.at(7.9, {39.5, 0, 0})->shift_m;
    square += dot(middle, middle);
  }
  EXPECT_GE(by_many, 8);
  EXPECT_LT(std::sqrt(square / by_many), 0.025);
}

TEST(Calibration, DriftPartlyHiddenByNoiseIsKept) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Calibration calibration = noisy_drive(0.1, seed);
    EXPECT_LT(calibration.smooth_s, 0.2 * 16) << seed;
    if (calibration.smooth_s == 0) continue;  // neighbours predict nearly as well
    double square = 0;
    for (int k = 0; k < 79; ++k)
      square += std::pow(calibration.at(0.2 * k + 0.1, {k + 0.5, 0, 0})->shift_m.x -
                             0.1 * std::sin(0.16 * (k + 0.5)),
                         2) /
                79;
    EXPECT_LT(std::sqrt(square), 0.04) << seed;
  }
}

TEST(Calibration, DrivesHaveSeparateTimes) {
  Calibration calibration = drive_along_x();
  for (PoseCorrection pose : drive_along_x().poses) {
    pose.position.y = 100;
    pose.shift_m.x += 1;
    calibration.poses.push_back(pose);
  }
  EXPECT_NEAR(calibration.at(10.3, {3, 100, 0})->shift_m.x, 1.015, 1e-12);
  EXPECT_NEAR(calibration.at(10.3, {3, 0, 0})->shift_m.x, 0.015, 1e-12);
}

}  // namespace
}  // namespace adasplats
