// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

#include "adasplats/cloud/poses/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {

namespace {

constexpr double kPi = std::numbers::pi;

double rotation_distance(const Mat3d& a, const Mat3d& b) {
  double worst = 0;
  for (int r = 0; r < 3; ++r) worst = std::max(worst, length(a.rows[r] - b.rows[r]));
  return worst;
}

double pose_distance(const RigidTransform& a, const RigidTransform& b) {
  return std::max(rotation_distance(a.rotation, b.rotation), length(a.translation - b.translation));
}

RigidTransform yawed(double yaw_rad, Vec3d translation) {
  return {rotation_from_yaw_pitch_roll(yaw_rad, 0, 0), translation};
}

const std::string kHeader = "time,x,y,z,qw,qx,qy,qz\n";
constexpr const char* kIdentityLine = "1 0 0 0 0 1 0 0 0 0 1 0\n";

// Oracle: analytic, a quarter turn to the left at (1, 2, 3).
TEST(ReadTrajectory, KittiWithoutCalibrationIsWorldFromSensor) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("poses.txt", std::string(kIdentityLine) + "0 -1 0 1.5e0 1 0 0 2 0 0 1 3\n\n");
  const Trajectory trajectory = read_trajectory(file);
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[0].time_s, 0.0);
  EXPECT_EQ(trajectory[1].time_s, 0.1);
  EXPECT_LT(pose_distance(trajectory[1].world_from_sensor, yawed(kPi / 2, {1.5, 2, 3})), 1e-15);
}

// Oracle: analytic. Camera z is forward; a camera that moves 2 m along its z and turns right about
// its y (down) is a vehicle that moves 2 m along x and turns right about z (up).
TEST(ReadTrajectory, KittiWithCalibrationIsBroughtToTheLidar) {
  const TemporaryFolder folder;
  folder.write("calib.txt", "P0: 1 2 3\r\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\r\n");
  folder.write("times.txt", "5.0\r\n6.5e+00\r\n");
  const double c = std::cos(0.3), s = std::sin(0.3);
  std::string line;
  for (const double v : {c, 0.0, s, 0.0, 0.0, 1.0, 0.0, 0.0, -s, 0.0, c, 2.0})
    line += std::to_string(v) + " ";
  const Trajectory trajectory =
      read_trajectory(folder.write("poses.txt", kIdentityLine + line + "\r\n"));
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[1].time_s, 6.5);
  EXPECT_LT(pose_distance(trajectory[0].world_from_sensor, {}), 1e-15);
  EXPECT_LT(pose_distance(trajectory[1].world_from_sensor, yawed(-0.3, {2, 0, 0})), 2e-6);
}

TEST(ReadTrajectory, CalibrationWithoutTrSaysNoFrame) {
  const TemporaryFolder folder;
  const auto file = folder.write("poses.txt", "1 0 0 7 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(read_trajectory(file)[0].world_from_sensor.translation.x, 7.0);
  folder.write("calib.txt", "Tr_velo: 1 2 3\n");
  expect_error(ErrorKind::data, {"calib.txt", "'Tr:'", "'Tr_velo:'"},
               [&] { read_trajectory(file); });
}

// Oracle: R * transposed(R) = unit matrix.
TEST(ReadTrajectory, RoundedRotationsBecomeOrthonormal) {
  const TemporaryFolder folder;
  std::string text;
  const Mat3d exact = rotation_from_yaw_pitch_roll(0.7, -0.2, 0.4);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      text += std::to_string(std::round(exact.rows[r][c] * 1e5) / 1e5) + " ";
    text += "0 ";
  }
  const Mat3d read = read_trajectory(folder.write("poses.txt", text))[0].world_from_sensor.rotation;
  EXPECT_LT(orthonormality_error(read), 1e-15);
  EXPECT_LT(rotation_distance(read, exact), 2e-5);
}

TEST(ReadTrajectory, CsvWithAHeader) {
  const TemporaryFolder folder;
  const std::string rows =
      "1,10,20,30,1,0,0,0\n1.5, 11 ,20,30,0.7071067811865476,0,0,+0.7071067811865476\n";
  for (const std::string header :
       {"time,x,y,z,qw,qx,qy,qz\n", "# made by hand\nTime, x, y, z, qw, qx, qy, qz\r\n",
        "#timestamp,tx,ty,tz,qw,qx,qy,qz\n"}) {
    const Trajectory trajectory = read_trajectory(folder.write("poses.csv", header + rows));
    ASSERT_EQ(trajectory.size(), 2U);
    EXPECT_EQ(trajectory[1].time_s, 1.5);
    EXPECT_LT(pose_distance(trajectory[1].world_from_sensor, yawed(kPi / 2, {11, 20, 30})), 1e-15);
  }
}

// Oracle: the same quarter turn to the left; TUM has qw last, where ours has it first.
TEST(ReadTrajectory, NamesTellTheOrder) {
  const TemporaryFolder folder;
  const std::string c = "0.7071067811865476";
  for (const std::string& text : std::vector<std::string>{
           "# ground truth\n# timestamp tx ty tz qx qy qz qw\n1.5 11 20 30 0 0 " + c + " " + c +
               "\n",
           "timestamp\ttx\tty\ttz\tqx\tqy\tqz\tqw\n1.5\t11\t20\t30\t0\t0\t" + c + "\t" + c + "\n",
           "time,x,y,z,qx,qy,qz,qw,speed\n1.5,11,20,30,0,0," + c + "," + c + ",x\n"}) {
    const Trajectory trajectory = read_trajectory(folder.write("poses.txt", text));
    ASSERT_EQ(trajectory.size(), 1U) << text;
    EXPECT_EQ(trajectory[0].time_s, 1.5);
    EXPECT_LT(pose_distance(trajectory[0].world_from_sensor, yawed(kPi / 2, {11, 20, 30})), 1e-15);
  }
}

TEST(ReadTrajectory, SlightlyLongQuaternionsAreNormalised) {
  const TemporaryFolder folder;
  const Trajectory trajectory =
      read_trajectory(folder.write("poses.csv", kHeader + "0,0,0,0,1.0005,0,0,0\n"));
  EXPECT_LT(orthonormality_error(trajectory[0].world_from_sensor.rotation), 1e-15);
}

struct BadFile {
  const char* name;
  const char* text;
  int line;
  const char* part;
};

class ReadTrajectoryBad : public testing::TestWithParam<BadFile> {};

TEST_P(ReadTrajectoryBad, IsADataErrorWithTheLine) {
  const TemporaryFolder folder;
  const auto file = folder.write(GetParam().name, GetParam().text);
  expect_error(ErrorKind::data,
               {file.string() + ":" + std::to_string(GetParam().line) + ":", GetParam().part},
               [&] { read_trajectory(file); });
}

INSTANTIATE_TEST_SUITE_P(
    All, ReadTrajectoryBad,
    testing::Values(
        BadFile{"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n\n1 0 0 0 0 1 0 0 0 0 1\n", 3, "11 values"},
        BadFile{"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0\n", 1, "13 values"},
        BadFile{"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 x\n", 1, "'x'"},
        BadFile{"poses.txt", "1 0 0 nan 0 1 0 0 0 0 1 0\n", 1, "'nan'"},
        BadFile{"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 inf\n", 1, "'inf'"},
        BadFile{"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 1e999\n", 1, "1e999"},
        BadFile{"poses.txt", "1 0 0 0 0 1 0 0 0 0 1.001 0\n", 1, "orthonormal"},
        BadFile{"poses.txt", "1 0 0 0 0 1 0 0 0 0 -1 0\n", 1, "mirrors"},
        BadFile{"poses.txt", "0 0 0 0 0 0 0 0 0 0 0 0\n", 1, "orthonormal"},
        BadFile{"poses.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,1,0,0\n", 3,
                "7 values"},
        BadFile{"poses.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,\n", 2, "''"},
        BadFile{"poses.csv", "0,0,0,0,1,0,0,0\n", 1, "time,x,y,z,qw,qx,qy,qz"},
        BadFile{"poses.txt", "0 0 0 0 0 0 0 1\n", 1, "# timestamp tx ty tz"},
        BadFile{"poses.csv", "time,x,y,z,qx,qy,qz\n0,0,0,0,1,0,0\n", 1, "names"},
        BadFile{"poses.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,0.99,0,0,0\n", 3,
                "0.99"},
        BadFile{"poses.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,0,0,0,0\n", 2, "norm"},
        BadFile{"poses.csv", "time,x,y,z,qw,qx,qy,qz\n2,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n", 3,
                "time 1 does not come after the one before, 2"},
        BadFile{"poses.csv", "time,x,y,z,qw,qx,qy,qz\n2,0,0,0,1,0,0,0\n2,0,0,0,1,0,0,0\n", 3,
                "time 2 does not come after the one before, 2"},
        BadFile{"poses.csv",
                "time,x,y,z,qw,qx,qy,qz\n2.15205860,0,0,0,1,0,0,0\n2.115218878,0,0,0,1,0,0,0\n", 3,
                "9 and 8 digits: were zeros after the point lost?"}));

TEST(ReadTrajectory, TimesThatDoNotFit) {
  const TemporaryFolder folder;
  const auto file = folder.write("poses.txt", std::string(kIdentityLine) + kIdentityLine);
  folder.write("times.txt", "1\n");
  expect_error(ErrorKind::data, {"times.txt", "1 times", "2 poses"},
               [&] { read_trajectory(file); });
  folder.write("times.txt", "1\n0.5\n");
  expect_error(ErrorKind::data, {"times.txt:2:"}, [&] { read_trajectory(file); });
  folder.write("times.txt", "0\n1\n");
  folder.write("calib.txt", "P0: 0\nTr: 1 0 0 0 0 1 0 0 0 0 2 0\n");
  expect_error(ErrorKind::data, {"calib.txt:2:", "orthonormal"}, [&] { read_trajectory(file); });
}

TEST(ReadTrajectory, NothingToRead) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::no_input, {"absent.txt"},
               [&] { read_trajectory(folder.path() / "absent.txt"); });
  expect_error(ErrorKind::data, {"empty.txt"},
               [&] { read_trajectory(folder.write("empty.txt", "")); });
  expect_error(ErrorKind::data, {"blank.txt", "no poses"},
               [&] { read_trajectory(folder.write("blank.txt", "\n \n")); });
  expect_error(ErrorKind::data, {"header.csv", "no poses"},
               [&] { read_trajectory(folder.write("header.csv", "time,x,y,z,qw,qx,qy,qz\n")); });
}

TEST(WriteTrajectory, RoundTrip) {
  const TemporaryFolder folder;
  Trajectory written;
  for (std::uint64_t i = 0; i < 50; ++i) {
    Random random(1, 2, i);
    written.push_back(
        {0.1 * static_cast<double>(i),
         {rotation_from_yaw_pitch_roll(random.uniform(-kPi, kPi), random.uniform(-kPi / 2, kPi / 2),
                                       random.uniform(-kPi, kPi)),
          {448262.0 + random.uniform(), 5411932.0, random.uniform()}}});
  }
  const auto file = folder.path() / "trajectory.csv";
  write_trajectory_csv(file, written);
  const Trajectory read = read_trajectory(file);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR(read[i].time_s, written[i].time_s, 1e-9);
    EXPECT_LT(pose_distance(read[i].world_from_sensor, written[i].world_from_sensor), 5e-9);
  }
}

// Oracle: analytic, a steady turn and drive.
TEST(Interpolate, BetweenAndOutside) {
  const Trajectory trajectory = {{1, yawed(0.2, {0, 0, 0})}, {3, yawed(1.0, {4, -2, 8})}};
  EXPECT_LT(pose_distance(interpolate(trajectory, 1.5), yawed(0.4, {1, -0.5, 2})), 1e-14);
  EXPECT_LT(pose_distance(interpolate(trajectory, 1), yawed(0.2, {0, 0, 0})), 1e-15);
  EXPECT_LT(pose_distance(interpolate(trajectory, 3), yawed(1.0, {4, -2, 8})), 1e-15);
  EXPECT_LT(pose_distance(interpolate(trajectory, -9), yawed(0.2, {0, 0, 0})), 1e-15);
  EXPECT_LT(pose_distance(interpolate(trajectory, 99), yawed(1.0, {4, -2, 8})), 1e-15);
  EXPECT_THROW(interpolate({}, 0), std::logic_error);
}

TEST(Interpolate, TakesTheShortWayRound) {
  const Trajectory trajectory = {{0, yawed(3.0, {})}, {1, yawed(-3.0, {})}};
  EXPECT_LT(rotation_distance(interpolate(trajectory, 0.5).rotation,
                              rotation_from_yaw_pitch_roll(kPi, 0, 0)),
            1e-14);
}

TEST(Interpolate, EqualRotations) {
  const Trajectory trajectory = {{0, yawed(0.5, {})}, {1, yawed(0.5, {})}};
  EXPECT_LT(pose_distance(interpolate(trajectory, 0.3), yawed(0.5, {})), 1e-15);
}

TEST(Shifted, MovesEveryPose) {
  const Trajectory moved = shifted({{0, yawed(0.5, {1, 2, 3})}}, {10, 0, -1});
  EXPECT_TRUE((moved[0].world_from_sensor.translation == Vec3d{11, 2, 2}));
  EXPECT_TRUE(shifted({}, {1, 1, 1}).empty());
}

// Oracle: the composition of transforms.
TEST(Mounted, PosesAreThoseOfTheSensor) {
  const RigidTransform mount = yawed(kPi / 2, {1, 0, 1.5});
  const Trajectory moved = mounted({{0, yawed(kPi / 2, {10, 0, 0})}}, mount);
  EXPECT_LT(pose_distance(moved[0].world_from_sensor, yawed(kPi, {10, 1, 1.5})), 1e-14);
  EXPECT_TRUE(mounted({}, mount).empty());
}

TEST(Resampled, ByTimeFromTheFirstToTheLastPose) {
  const Trajectory drive = {{5, yawed(0, {0, 0, 0})}, {6, yawed(0.2, {4, 0, 0})}};
  const Trajectory poses = resampled_by_time(drive, 4);
  ASSERT_EQ(poses.size(), 5U) << "both ends";
  EXPECT_EQ(poses.front().time_s, 5);
  EXPECT_EQ(poses.back().time_s, 6);
  EXPECT_LT(pose_distance(poses[1].world_from_sensor, yawed(0.05, {1, 0, 0})), 1e-14);
  EXPECT_EQ(resampled_by_time(drive, 0.3).size(), 1U);
  EXPECT_TRUE(resampled_by_time({}, 1).empty());
  for (const double rate : {0.0, -1.0, std::nan(""), 1e12})
    EXPECT_THROW(resampled_by_time(drive, rate), Error) << rate;
}

// A sensor that stands for a while and then drives on: the way counts, not the time.
TEST(Resampled, ByDistanceAlongTheWay) {
  const Trajectory drive = {{0, yawed(0, {0, 0, 0})},
                            {1, yawed(0, {2, 0, 0})},
                            {9, yawed(0, {2, 0, 0})},
                            {10, yawed(0, {2, 3, 0})}};
  const Trajectory poses = resampled_by_distance(drive, 0.5);
  ASSERT_EQ(poses.size(), 11U);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_GT(poses[i].time_s, poses[i - 1].time_s);
    EXPECT_NEAR(
        length(poses[i].world_from_sensor.translation - poses[i - 1].world_from_sensor.translation),
        0.5, 1e-12);
  }
  EXPECT_EQ(resampled_by_distance({{3, yawed(0, {1, 1, 1})}}, 1).size(), 1U);
  EXPECT_TRUE(resampled_by_distance({}, 1).empty());
  for (const double spacing : {0.0, -1.0, std::nan(""), 1e-9})
    EXPECT_THROW(resampled_by_distance(drive, spacing), Error) << spacing;
}

// Oracle: rotation_from_quaternion, over rotations where each component is the largest.
TEST(Rotation, QuaternionRoundTrip) {
  for (const double yaw : {0.0, 0.1, kPi / 2, kPi, -3.0})
    for (const double pitch : {0.0, 1.0, -kPi / 2})
      for (const double roll : {0.0, kPi, 2.0, -2.5}) {
        const Mat3d m = rotation_from_yaw_pitch_roll(yaw, pitch, roll);
        const Quaternion q = quaternion_from_rotation(m);
        EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-15);
        EXPECT_GE(q.w, 0);
        EXPECT_LT(rotation_distance(rotation_from_quaternion(q.w, q.x, q.y, q.z), m), 1e-14);
      }
}

// Oracle: round trip.
TEST(WriteKittiPoses, AreReadBackInTheirFolder) {
  const TemporaryFolder folder;
  folder.write("calib.txt", std::string("Tr: 0 -1 0 0.1 0 0 -1 -0.08 1 0 0 -0.27\n"));
  const Trajectory poses = {{0, yawed(0.3, {1, 2, 3})},
                            {0.1, yawed(-2, {456789.123456789, 5e6 + 0.7, 80})}};
  write_kitti_poses(folder.path() / "poses.txt", poses, folder.path());
  const Trajectory read = read_trajectory(folder.path() / "poses.txt");
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_LT(pose_distance(read[k].world_from_sensor, poses[k].world_from_sensor), 1e-8);
  const TemporaryFolder other;
  expect_error(ErrorKind::data, {"calib.txt"},
               [&] { write_kitti_poses(other.path() / "poses.txt", poses, other.path()); });
}

}  // namespace

namespace {

// Oracle: an even motion along a circle, in closed form.
TEST(ContinuedMotion, GoesOnAlongACircle) {
  const auto pose_at = [](double s) {
    return RigidTransform{rotation_from_yaw_pitch_roll(s, 0, 0), {std::sin(s), -std::cos(s), 0}};
  };
  const Trajectory longer =
      with_extrapolated_ends({{0, pose_at(0)}, {0.1, pose_at(0.1)}, {0.2, pose_at(0.2)}}, 0.1);
  ASSERT_EQ(longer.size(), 5U);
  for (const TimedPose& pose : longer) {
    const RigidTransform expected = pose_at(pose.time_s);
    EXPECT_LT(length(pose.world_from_sensor.translation - expected.translation), 1e-9);
    EXPECT_LT(angle_between(pose.world_from_sensor.rotation, expected.rotation), 1e-7);
  }
  EXPECT_NEAR(longer.front().time_s, -0.1, 1e-12);
  EXPECT_NEAR(longer.back().time_s, 0.3, 1e-12);
}

TEST(ContinuedMotion, ASinglePoseStays) {
  EXPECT_EQ(with_extrapolated_ends({{7, {}}}, 0.1).size(), 1U);
  EXPECT_TRUE(with_extrapolated_ends({}, 0.1).empty());
}

}  // namespace

}  // namespace adasplats
