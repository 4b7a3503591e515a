// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/sweep_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/sequence/scan_beams.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

// A street whose facades go forward and back by 3 m every 8 m, driven along at 8 m/s by an HDL-64E
// whose scans are as they were measured.
constexpr double kSpeed_mps = 8, kRevolution_s = 0.1033, kPeriod_s = 0.1, kGround_m = -1.7;
constexpr std::size_t kStreetScans = 12;

/// From the middle of the street, m: facades lie at both of its signs.
double facade_m(double along_m) {
  const double phase = along_m / 8 - std::floor(along_m / 8);
  return 6 + 6 * std::fabs(phase - 0.5);
}

/// How far the facade is from a place in the middle of the street, in the plane: the first change
/// of side on the way, by halving.
double distance_to_facade_m(double along_m, double azimuth_rad) {
  const auto outside = [&](double rho_m) {
    return std::fabs(rho_m * std::sin(azimuth_rad)) >
           facade_m(along_m + rho_m * std::cos(azimuth_rad));
  };
  double near_m = 0, far_m = 0.05;
  while (far_m < 60 && !outside(far_m)) near_m = std::exchange(far_m, far_m + 0.05);
  if (far_m >= 60) return std::numeric_limits<double>::infinity();
  for (int k = 0; k < 40; ++k) {
    const double middle_m = 0.5 * (near_m + far_m);
    (outside(middle_m) ? far_m : near_m) = middle_m;
  }
  return far_m;
}

/// What scan `scan` has in its file; `sense` -1: of a sensor that turns the other way;
/// 0: of one that is at rest during each revolution.
std::vector<float> scan_of(std::size_t scan, double sense) {
  constexpr std::size_t kFirings = 1000;
  std::vector<float> values;
  for (std::size_t firing = 0; firing < kFirings; ++firing) {
    const double phase = (static_cast<double>(firing) + 0.5) / kFirings - 0.5;
    const double azimuth_rad = -2 * std::numbers::pi * phase;
    const double time_s = kPeriod_s * static_cast<double>(scan) + sense * phase * kRevolution_s;
    const double facade_rho_m = distance_to_facade_m(kSpeed_mps * time_s, azimuth_rad);
    for (const double e_deg : {1.9367, 0.1806, -1.4939, -2.8738, -4.2155, -5.6106, -6.6757, -7.6788,
                               -10.4708, -12.1150, -14.0484, -16.1767, -18.3234}) {
      const double height_m = e_deg > -8.87 ? 0.2065 + 0.00106 * e_deg : 0.1309 + 0.00061 * e_deg;
      const double slope = std::tan(e_deg * std::numbers::pi / 180);
      const double ground_rho_m =
          slope < 0 ? (kGround_m - height_m) / slope : std::numeric_limits<double>::infinity();
      const double rho_m = std::min(facade_rho_m, ground_rho_m);
      if (rho_m > 60) continue;
      for (const double v : {rho_m * std::cos(azimuth_rad), rho_m * std::sin(azimuth_rad),
                             height_m + slope * rho_m, 0.5})
        values.push_back(static_cast<float>(v));
    }
  }
  return values;
}

KittiSequence write_drive(const TemporaryFolder& folder, double sense, double seconds = 1) {
  std::string poses, times;
  for (std::size_t k = 0; k < kStreetScans; ++k) {
    const double time_s = kPeriod_s * static_cast<double>(k);
    folder.write("velodyne/" + std::to_string(100 + k) + ".bin", scan_of(k, sense));
    poses += "1 0 0 " + std::to_string(kSpeed_mps * time_s) + " 0 1 0 0 0 0 1 0\n";
    times += std::to_string(seconds * time_s) + "\n";
  }
  folder.write("poses.txt", poses);
  folder.write("times.txt", times);
  folder.write("calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  return open_kitti_sequence(folder.path());
}

PointCloud loaded(const TemporaryFolder& folder) {
  const std::filesystem::path inputs[] = {folder.path()};
  ProgressSink quiet;
  return load_cloud(inputs, {}, Executor(2), quiet).first;
}

/// Of points at least a metre above the ground, from the facades, m.
double from_facades_m(const PointCloud& cloud) {
  std::vector<double> away_m;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3d p = cloud.world(i);
    if (p.z > kGround_m + 1) away_m.push_back(std::fabs(std::fabs(p.y) - facade_m(p.x)));
  }
  std::ranges::sort(away_m);
  return away_m.at(away_m.size() * 9 / 10);
}

// Oracle: the facades, and where the sensor was as it looked there.
TEST(SweepCheck, TheMotionIsTakenOutOfScansAsMeasured) {
  const TemporaryFolder folder;
  const KittiSequence sequence = write_drive(folder, 1);
  const ScanBeams beams = recognize_beams(sequence, Executor(2));
  EXPECT_EQ(beams.description(), "HDL-64E blocks, rolling");
  EXPECT_EQ(beams.raw_motions.size(), kStreetScans);
  EXPECT_EQ(beams.unknown_sweep_m, 0);
  const PointCloud cloud = loaded(folder);
  EXPECT_LT(from_facades_m(cloud), 1e-3);
  ASSERT_EQ(cloud.sensor_positions.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); i += 97) {
    const Vec3d origin = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
    const Vec3d way = cloud.world(i) - origin;
    const double phase = -std::atan2(way.y, way.x) / (2 * std::numbers::pi);
    const double time_s = kPeriod_s * cloud.scan_indices[i] + phase * kRevolution_s;
    ASSERT_NEAR(origin.x, kSpeed_mps * time_s, 2e-3) << i;
    ASSERT_NEAR(origin.y, 0, 1e-4);
  }
}

TEST(SweepCheck, WhatPointsContradictIsNotTakenOut) {
  const TemporaryFolder folder;
  const KittiSequence sequence = write_drive(folder, -1);
  const ScanBeams beams = recognize_beams(sequence, Executor(2));
  EXPECT_EQ(beams.description(), "HDL-64E blocks");
  EXPECT_TRUE(beams.raw_motions.empty());
  EXPECT_NEAR(beams.unknown_sweep_m, kSpeed_mps * kRevolution_s, 1e-3);
}

TEST(SweepCheck, ScansOfASensorAtRestStayAsTheyAre) {
  const TemporaryFolder folder;
  const KittiSequence sequence = write_drive(folder, 0);
  const ScanBeams beams = recognize_beams(sequence, Executor(2));
  EXPECT_TRUE(beams.raw_motions.empty());
  EXPECT_EQ(beams.unknown_sweep_m, 0);  // nothing to warn of
  EXPECT_LT(from_facades_m(loaded(folder)), 1e-3);
}

TEST(SweepCheck, EvidenceHasTheFigures) {
  const TemporaryFolder folder;
  const KittiSequence sequence = write_drive(folder, 1);
  ScanBeams beams = recognize_beams(sequence, Executor(1));
  const SweepEvidence evidence = weigh_sweeps(sequence, beams, Executor(2));
  EXPECT_TRUE(evidence.confirms());
  EXPECT_GT(evidence.points, 1000U);
  EXPECT_LT(evidence.moved_m, 0.5 * evidence.still_m);
  EXPECT_GT(evidence.reversed_m, evidence.still_m);
  EXPECT_FALSE(evidence.at_rest());
  for (SweepMotion& motion : beams.raw_motions)
    std::swap(motion.frame_from_begin, motion.frame_from_end);
  EXPECT_FALSE(weigh_sweeps(sequence, beams, Executor(2)).confirms());
  EXPECT_FALSE(SweepEvidence{}.confirms());
  EXPECT_FALSE(SweepEvidence{}.at_rest());
  // A wrong mount, too, is mended by some of the motion.
  EXPECT_FALSE((SweepEvidence{100000, 0.125, 0.107, 0.155}.confirms()));
}

// Poses too far apart say too little of a tenth of a second.
TEST(SweepCheck, PosesSecondsApartTellNothing) {
  const TemporaryFolder folder;
  const KittiSequence sequence = write_drive(folder, 1, 10);
  const ScanBeams beams = recognize_beams(sequence, Executor(2));
  EXPECT_TRUE(beams.raw_motions.empty());
  EXPECT_NEAR(beams.unknown_sweep_m, 0.1 * kSpeed_mps * kRevolution_s, 1e-3);
}

}  // namespace
}  // namespace adasplats
