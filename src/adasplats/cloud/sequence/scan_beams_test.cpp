// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/scan_beams.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

constexpr double kHdlRevolution_s = 0.1033;

/// A quarter of the beams of KITTI's HDL-64E, of both blocks, none next to where these meet.
constexpr std::array<double, 16> kSomeElevations_deg = {
    1.9367,   0.1806,   -1.4939,  -2.8738,  -4.2155,  -5.6106,  -6.6757,  -7.6788,
    -10.4708, -12.1150, -14.0484, -16.1767, -18.3234, -20.2224, -22.4376, -24.9993};

/// How a sequence of scans was measured: uniformly accelerated, never turning.
struct KittiDrive {
  std::size_t scans = 3;
  std::size_t firings = 400;  ///< of each of 16 beams, a scan
  double yaw_rad = 0;
  Vec3d velocity_mps = {8, 0, 0};  ///< in the scans' frame, of scan 0
  Vec3d acceleration_mps2 = {};    ///< in the scans' frame
  double period_s = 0.1;           ///< from scan to scan
  bool compensated = true;         ///< the points are those of the middle of the revolution
  bool hdl64 = true;               ///< else all beams start at the frame's origin
  double min_m = 9, max_m = 36;    ///< of the points, in the plane

  double time_s(std::size_t scan) const { return period_s * static_cast<double>(scan); }
  /// During the revolution of a scan.
  Vec3d sweep_m(std::size_t scan) const {
    return kHdlRevolution_s * (velocity_mps + time_s(scan) * acceleration_mps2);
  }
  RigidTransform pose(std::size_t scan) const {
    const double t = time_s(scan), c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    const Mat3d rotation = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
    return {rotation, rotation * (t * velocity_mps + (0.5 * t * t) * acceleration_mps2)};
  }
};

/// A point of a scan and where its beam started, both in the scan's frame.
struct Beam {
  Vec3d origin, point;
};

/// The beams of a scan, one firing after the other. Oracle: first where the sensor was, then the
/// beam's cone around that place.
std::vector<Beam> beams_of(const KittiDrive& drive, std::size_t scan) {
  std::vector<Beam> beams;
  for (std::size_t firing = 0; firing < drive.firings; ++firing) {
    // Clockwise from the rear: share 0 looks back, 1/4 to the left, 1/2 ahead, 3/4 to the right.
    const double share = (static_cast<double>(firing) + 0.5) / static_cast<double>(drive.firings);
    const double azimuth_rad = std::numbers::pi * (1 - 2 * share);
    for (std::size_t k = 0; k < kSomeElevations_deg.size(); ++k) {
      Random random(1, scan, firing * kSomeElevations_deg.size() + k);
      const double range_m = random.uniform(drive.min_m, drive.max_m);
      const double e_deg =
          drive.hdl64 ? kSomeElevations_deg[k] : 2 - 1.8 * static_cast<double>(k);  // even fan
      const double upper_m = 0.2065 + 0.00106 * e_deg, lower_m = 0.1309 + 0.00061 * e_deg;
      Vec3d origin;
      if (drive.compensated) origin = (share - 0.5) * drive.sweep_m(scan);
      const Vec3d foot = {range_m * std::cos(azimuth_rad), range_m * std::sin(azimuth_rad), 0};
      const double rho_m = std::hypot(foot.x - origin.x, foot.y - origin.y);
      if (drive.hdl64) origin.z += e_deg > -8.87 ? upper_m : lower_m;
      const double height_m = origin.z + rho_m * std::tan(e_deg * std::numbers::pi / 180);
      beams.push_back({origin, {foot.x, foot.y, height_m}});
    }
  }
  return beams;
}

void write_poses(const TemporaryFolder& folder, const KittiDrive& drive) {
  std::string poses, times;
  for (std::size_t scan = 0; scan < drive.scans; ++scan) {
    const RigidTransform pose = drive.pose(scan);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        poses += std::to_string(pose.rotation.rows[row][column]) + " ";
      poses += std::to_string(pose.translation[row]) + (row == 2 ? "\n" : " ");
    }
    times += std::to_string(drive.time_s(scan)) + "\n";
  }
  folder.write("poses.txt", poses);
  folder.write("calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  folder.write("times.txt", times);
}

void write_frame(const TemporaryFolder& folder, std::size_t scan,
                 const std::vector<Vec3d>& points) {
  std::vector<float> values;
  for (const Vec3d p : points)
    values.insert(values.end(), {static_cast<float>(p.x), static_cast<float>(p.y),
                                 static_cast<float>(p.z), 0.5F});
  folder.write("velodyne/00000" + std::to_string(scan) + ".bin", values);
}

KittiSequence write_sequence(const TemporaryFolder& folder, const KittiDrive& drive) {
  for (std::size_t scan = 0; scan < drive.scans; ++scan) {
    std::vector<Vec3d> points;
    for (const Beam& beam : beams_of(drive, scan)) points.push_back(beam.point);
    write_frame(folder, scan, points);
  }
  write_poses(folder, drive);
  return open_kitti_sequence(folder.path());
}

ScanBeams recognized(const KittiDrive& drive) {
  const TemporaryFolder folder;
  return recognize_beams(write_sequence(folder, drive), Executor(2));
}

void expect_frame_origin(const ScanBeams& beams) {
  EXPECT_FALSE(beams.from_hdl64);
  EXPECT_TRUE(beams.sweeps_m.empty());
  EXPECT_EQ(beams.description(), "frame origin");
  EXPECT_EQ(beams.origin_of(0, {-3, 4, -1}), Vec3d{});
}

TEST(RecognizeBeams, PointsAsMeasuredLieOnTheConesThemselves) {
  KittiDrive drive;
  drive.compensated = false;
  const ScanBeams beams = recognized(drive);
  EXPECT_TRUE(beams.from_hdl64);
  EXPECT_TRUE(beams.sweeps_m.empty());
  EXPECT_EQ(beams.description(), "HDL-64E blocks");
}

// Oracle: the velocity times the duration of a revolution.
TEST(RecognizeBeams, CompensatedPointsGiveTheWayOfEveryRevolution) {
  for (const std::size_t scans : {2, 3, 9}) {
    KittiDrive drive;
    drive.scans = scans;
    const ScanBeams beams = recognized(drive);
    EXPECT_TRUE(beams.from_hdl64);
    EXPECT_EQ(beams.description(), "HDL-64E blocks, moving");
    ASSERT_EQ(beams.sweeps_m.size(), scans);
    for (const Vec3d sweep_m : beams.sweeps_m)
      EXPECT_LT(length(sweep_m - Vec3d{0.8264, 0, 0}), 1e-4);
  }
}

TEST(RecognizeBeams, SweepsAreInTheFrameOfTheScan) {
  for (const double yaw_rad : {0.5, 2.0, -1.2}) {
    KittiDrive drive;
    drive.yaw_rad = yaw_rad;
    drive.velocity_mps = {9, -2, 0.5};  // drifts to its right and up
    const ScanBeams beams = recognized(drive);
    EXPECT_EQ(beams.description(), "HDL-64E blocks, moving");
    ASSERT_EQ(beams.sweeps_m.size(), 3U);
    for (const Vec3d sweep_m : beams.sweeps_m)
      EXPECT_LT(length(sweep_m - Vec3d{0.9297, -0.2066, 0.05165}), 1e-4);
  }
}

TEST(RecognizeBeams, SweepsFollowTimesAndSpeeds) {
  KittiDrive drive;
  drive.scans = 5;
  drive.period_s = 0.25;
  drive.velocity_mps = {4, 0, 0};
  drive.acceleration_mps2 = {2, 0, 0};
  const ScanBeams beams = recognized(drive);
  ASSERT_EQ(beams.sweeps_m.size(), 5U);
  for (const std::size_t scan : {1, 2, 3})  // the others have no neighbour on one side
    EXPECT_NEAR(beams.sweeps_m[scan].x, kHdlRevolution_s * (4 + 0.5 * static_cast<double>(scan)),
                1e-5);
  EXPECT_NEAR(beams.sweeps_m[0].x, kHdlRevolution_s * 4.25, 1e-5);  // of the way to the next one
}

TEST(RecognizeBeams, OtherSensorsStartAtTheOrigin) {
  KittiDrive even;
  even.hdl64 = false;
  expect_frame_origin(recognized(even));
  even.compensated = false;
  expect_frame_origin(recognized(even));
}

TEST(RecognizeBeams, PointsAnywhereAreOfNoSensor) {
  const TemporaryFolder folder;
  const KittiDrive drive;
  for (std::size_t scan = 0; scan < drive.scans; ++scan) {
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < 8000; ++i) {
      Random random(2, scan, i);
      const double azimuth_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
      const double range_m = random.uniform(9, 36);
      points.push_back({range_m * std::cos(azimuth_rad), range_m * std::sin(azimuth_rad),
                        range_m * random.uniform(-0.45, 0.03)});
    }
    write_frame(folder, scan, points);
  }
  write_poses(folder, drive);
  expect_frame_origin(recognize_beams(open_kitti_sequence(folder.path()), Executor(2)));
}

TEST(RecognizeBeams, FewPointsOrNoneInTheRangesAreNotEnough) {
  KittiDrive drive;
  drive.scans = 2;
  drive.firings = 160;  // every 11th of 2 * 16 * 160 points: 466
  expect_frame_origin(recognized(drive));
  drive.firings = 180;  // 524
  EXPECT_TRUE(recognized(drive).from_hdl64);
  drive.firings = 400;
  drive.min_m = 2;
  drive.max_m = 6;
  expect_frame_origin(recognized(drive));
  drive.min_m = 42;
  drive.max_m = 80;
  expect_frame_origin(recognized(drive));
}

TEST(RecognizeBeams, EmptyScansAndPointsThatAreNotFinite) {
  const TemporaryFolder folder;
  KittiDrive drive;
  drive.scans = 2;
  const Vec3d nowhere = {NAN, 10, -1};
  std::vector<Vec3d> points;
  for (const Beam& beam : beams_of(drive, 1)) {
    points.push_back(beam.point);
    points.push_back(nowhere);
  }
  write_frame(folder, 0, {});
  write_frame(folder, 1, std::vector<Vec3d>(9000, nowhere));
  write_poses(folder, drive);
  expect_frame_origin(recognize_beams(open_kitti_sequence(folder.path()), Executor(2)));
  write_frame(folder, 0, points);
  write_frame(folder, 1, points);
  EXPECT_TRUE(recognize_beams(open_kitti_sequence(folder.path()), Executor(2)).from_hdl64);
}

// Seconds that are none would make the vehicle stand during a revolution.
TEST(RecognizeBeams, TimesInAnotherUnitThanSecondsAreRefused) {
  const TemporaryFolder folder;
  const KittiSequence sequence = write_sequence(folder, KittiDrive{});
  EXPECT_FALSE(recognize_beams(sequence, Executor(2)).sweeps_m.empty());
  for (const auto& [factor, text] :
       {std::pair{1e3, "1000"}, {1e6, "1000000"}, {1e9, "1000000000"}}) {
    KittiSequence wrong = sequence;
    for (TimedPose& pose : wrong.trajectory) pose.time_s *= factor;
    expect_error(ErrorKind::data,
                 {folder.path().string(), "times.txt", std::string("divided by ") + text},
                 [&] { recognize_beams(wrong, Executor(2)); });
  }
  KittiDrive drive;
  drive.compensated = false;  // the times say nothing of such points
  const TemporaryFolder other;
  KittiSequence raw = write_sequence(other, drive);
  for (TimedPose& pose : raw.trajectory) pose.time_s *= 1e3;
  EXPECT_TRUE(recognize_beams(raw, Executor(2)).from_hdl64);
}

TEST(RecognizeBeams, NoTimeBetweenPosesIsNoWay) {
  KittiDrive drive;
  drive.compensated = false;
  const TemporaryFolder folder;
  KittiSequence sequence = write_sequence(folder, drive);
  for (TimedPose& pose : sequence.trajectory) pose.time_s = 7;
  const ScanBeams still = recognize_beams(sequence, Executor(2));
  drive.scans = 1;
  const ScanBeams single = recognized(drive);
  for (const ScanBeams& beams : {still, single}) {
    EXPECT_TRUE(beams.from_hdl64);
    for (const Vec3d sweep_m : beams.sweeps_m) EXPECT_EQ(sweep_m, Vec3d{});
    const Vec3d origin = beams.origin_of(0, {-10, 10, 0.2});
    EXPECT_EQ(origin.x, 0);
    EXPECT_EQ(origin.y, 0);
    EXPECT_NEAR(origin.z, 0.2065, 1e-3);
  }
}

TEST(RecognizeBeams, PosesAtEqualTimesSayNothingOfTheOthers) {
  const TemporaryFolder folder;
  KittiDrive drive;
  drive.scans = 9;
  KittiSequence sequence = write_sequence(folder, drive);
  for (const std::size_t scan : {5, 7}) sequence.trajectory[scan].time_s = drive.time_s(6);
  const ScanBeams beams = recognize_beams(sequence, Executor(2));
  ASSERT_EQ(beams.sweeps_m.size(), 9U);
  for (std::size_t scan = 0; scan < 9; ++scan) {
    if (scan == 4 || scan == 8) continue;  // theirs are next to times that are wrong
    EXPECT_NEAR(beams.sweeps_m[scan].x, scan == 6 ? 0.0 : 0.8264, 1e-4) << scan;
  }
}

TEST(OriginOf, IsTheFramesUnlessMoreIsKnown) {
  const ScanBeams unknown;
  for (const Vec3d point : {Vec3d{10, 0, 0}, {-10, -3, -1}, {0, 0, 0}})
    EXPECT_EQ(unknown.origin_of(0, point), Vec3d{});
}

TEST(OriginOf, IsWhereTheSensorWasAsItLookedThere) {
  // Oracle: the revolution starts at the rear and goes by the left; a point to the left was
  // measured a quarter of it before the middle.
  ScanBeams beams;
  beams.sweeps_m = {{100, 0, 0}, {0.8, 0.04, -0.08}};
  const auto origin_is = [&](Vec3d point, Vec3d expected) {
    EXPECT_LT(length(beams.origin_of(1, point) - expected), 1e-12);
  };
  origin_is({10, 0, -1}, {0, 0, 0});
  origin_is({0, 10, -1}, {-0.2, -0.01, 0.02});
  origin_is({0, -10, -1}, {0.2, 0.01, -0.02});
  origin_is({10, 10, -1}, {-0.1, -0.005, 0.01});
  origin_is({10, -10, 3}, {0.1, 0.005, -0.01});
  origin_is({-10, 10, -1}, {-0.3, -0.015, 0.03});  // soon after the start
  origin_is({-10, -10, -1}, {0.3, 0.015, -0.03});  // soon before the end
  EXPECT_NEAR(beams.origin_of(1, {-10, 1e-6, 0}).x, -0.4, 1e-6);
  EXPECT_NEAR(beams.origin_of(1, {-10, -1e-6, 0}).x, 0.4, 1e-6);
  EXPECT_NEAR(beams.origin_of(0, {0, 10, 0}).x, -25, 1e-9);  // of the scan asked for
  EXPECT_EQ(beams.origin_of(2, {0, 10, 0}), Vec3d{});        // no such scan
}

TEST(OriginOf, IsInTheBlockThatTheBeamIsOf) {
  // 20 m away: the two heights differ by 0.07 m, 0.2 degrees.
  ScanBeams beams;
  beams.from_hdl64 = true;
  const auto height_of = [&](double elevation_deg, double azimuth_rad) {
    const Vec3d origin =
        beams.origin_of(0, {20 * std::cos(azimuth_rad), 20 * std::sin(azimuth_rad),
                            0.165 + 20 * std::tan(elevation_deg * std::numbers::pi / 180)});
    EXPECT_EQ(origin.x, 0);
    EXPECT_EQ(origin.y, 0);
    return origin.z;
  };
  for (const double azimuth_rad : {0.0, 1.0, 3.0, -2.0}) {
    EXPECT_NEAR(height_of(2, azimuth_rad), 0.20862, 1e-9);
    EXPECT_NEAR(height_of(0, azimuth_rad), 0.2065, 1e-9);
    EXPECT_NEAR(height_of(-8.5, azimuth_rad), 0.19749, 1e-9);
    EXPECT_NEAR(height_of(-9.2, azimuth_rad), 0.125288, 1e-9);
    EXPECT_NEAR(height_of(-25, azimuth_rad), 0.11565, 1e-9);
  }
  beams.sweeps_m = {{0.8, 0, 0.4}};  // both together
  EXPECT_NEAR(beams.origin_of(0, {0, 20, 0.165}).x, -0.2, 1e-12);
  EXPECT_NEAR(beams.origin_of(0, {0, 20, 0.165}).z, 0.2065 - 0.1, 1e-12);
}

// Oracle: where the beams were made to start. The block heights are linear in the elevation, which
// is off by a degree at most, seen from the middle of the frame: 1 mm.
TEST(LoadCloud, SensorPositionsAreWhereBeamsStart) {
  const TemporaryFolder folder;
  KittiDrive drive;
  drive.scans = 6;
  drive.yaw_rad = 0.7;
  drive.acceleration_mps2 = {3, -1, 0};
  write_sequence(folder, drive);
  LoadOptions options;
  options.first_scan = 1;
  options.scan_stride = 2;
  options.scan_count = 2;
  const std::filesystem::path inputs[] = {folder.path()};
  ProgressSink quiet;
  const auto [cloud, report] = load_cloud(inputs, options, Executor(2), quiet);
  EXPECT_EQ(report.beams, std::vector<std::string>{"HDL-64E blocks, moving"});
  options.beams_from_poses = true;
  const auto [plain, plain_report] = load_cloud(inputs, options, Executor(2), quiet);
  EXPECT_EQ(plain_report.beams, std::vector<std::string>{"frame origin"});
  std::size_t i = 0;
  for (const std::size_t scan : {1, 3}) {
    const RigidTransform pose = drive.pose(scan);
    for (const Beam& beam : beams_of(drive, scan)) {
      ASSERT_LT(i, cloud.size());
      ASSERT_LT(length(cloud.world(i) - pose * beam.point), 1e-4);
      const auto sensor = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
      ASSERT_LT(length(sensor - pose * beam.origin), 1.5e-3) << beam.point.x << " " << beam.point.y;
      const auto plain_sensor = plain.origin + vec_cast<double>(plain.sensor_positions[i]);
      ASSERT_LT(length(plain_sensor - pose.translation), 1e-5);
      ++i;
    }
  }
  EXPECT_EQ(i, cloud.size());
  EXPECT_EQ(i, plain.size());
}

// Oracle: analytic. The beam to the front is in the middle of the sweep, that to the rear at its
// ends, those to the left and right a quarter before and behind.
TEST(RawMotions, PointsAreBroughtToTheFrameOfTheMiddle) {
  Trajectory motion;
  for (int i = 0; i < 30; ++i) {
    const double time_s = 0.1 * i;
    motion.push_back({time_s, {rotation_from_yaw_pitch_roll(0.5, 0, 0), {10 * time_s, 0, 0}}});
  }
  ScanBeams beams;
  expect_error(ErrorKind::data, {"1001", "`motion` is of", "the clocks differ"}, [&] {
    set_raw_motions(beams, {{1001.0, {}}}, motion, 0.1);
  });
  set_raw_motions(beams, {{1.0, {}}}, motion, 0.1);
  ASSERT_EQ(beams.raw_motions.size(), 1U);
  const Vec3d ahead = {std::cos(0.5), -std::sin(0.5), 0};  // the drive's direction in the frame
  const auto expect_moved = [&](Vec3d point, double metres) {
    const MeasuredBeam beam = beams.beam_of(0, point);
    EXPECT_LT(length(beam.origin - metres * ahead), 1e-12) << metres;
    EXPECT_LT(length(beam.end - (point + metres * ahead)), 1e-12) << metres;
  };
  expect_moved({7, 0, 1}, 0.0);
  expect_moved({0, 7, 1}, -0.25);
  expect_moved({0, -7, 1}, 0.25);
  expect_moved({-7, 1e-12, 1}, -0.5);
  expect_moved({-7, -1e-12, 1}, 0.5);
  EXPECT_EQ(beams.description(), "frame origin, rolling");
}

}  // namespace
}  // namespace adasplats
