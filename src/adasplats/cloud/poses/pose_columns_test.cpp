// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/pose_columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

/// Round a bend, looking ahead.
TimedPose pose_on_bend(int k) {
  const double turn = 0.05 * k;
  return {100 + 0.1 * k,
          {rotation_from_yaw_pitch_roll(turn, 0.01, 0.02),
           {20 * std::sin(turn), 20 * (1 - std::cos(turn)), 1.5}}};
}

/// A letter a value: t s n (seconds and nanoseconds apart) T (in ns) x y z, q's a b c d (w x y z),
/// or
/// '-', something else. `lines` are those of the bend with such rows.
std::string rows_of(const std::string& letters, char separator, int count = 40) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    const TimedPose pose = pose_on_bend(k);
    const Quaternion q = quaternion_from_rotation(pose.world_from_sensor.rotation);
    const Vec3d p = pose.world_from_sensor.translation;
    const double whole = std::floor(pose.time_s + 1e-9);
    for (std::size_t i = 0; i < letters.size(); ++i) {
      const char letter = letters[i];
      const double value = letter == 't'   ? pose.time_s
                           : letter == 's' ? whole
                           : letter == 'n' ? std::round(1e9 * (pose.time_s - whole))
                           : letter == 'T' ? std::round(1e9 * pose.time_s)
                           : letter == 'x' ? p.x
                           : letter == 'y' ? p.y
                           : letter == 'z' ? p.z
                           : letter == 'a' ? q.w
                           : letter == 'b' ? q.x
                           : letter == 'c' ? q.y
                           : letter == 'd' ? q.z
                                           : -7;
      char number[64];
      std::snprintf(number, sizeof(number), "%.17g", value);
      text += (i == 0 ? std::string() : std::string(1, separator)) + number;
    }
    text += '\n';
  }
  return text;
}

void expect_bend(const Trajectory& poses, const std::string& what) {
  ASSERT_EQ(poses.size(), 40U) << what;
  for (int k = 0; k < 40; ++k) {
    const TimedPose expected = pose_on_bend(k), &found = poses[static_cast<std::size_t>(k)];
    EXPECT_NEAR(found.time_s, expected.time_s, 1e-8) << what;
    EXPECT_LT(length(found.world_from_sensor.translation - expected.world_from_sensor.translation),
              1e-9)
        << what;
    EXPECT_LT(angle_between(found.world_from_sensor.rotation, expected.world_from_sensor.rotation),
              1e-6)
        << what;
  }
}

// Oracle: the same poses in every dress.
TEST(PoseColumns, NamesOfManyProgramsGiveTheSamePoses) {
  struct Dress {
    const char *heading, *letters;
    char separator;
  };
  const Dress dresses[] = {
      {"time,x,y,z,qw,qx,qy,qz", "txyzabcd", ','},
      {"# timestamp tx ty tz qx qy qz qw", "txyzbcda", ' '},
      {"Timestamp;Pos_X;Pos_Y;Pos_Z;Quat_W;Quat_X;Quat_Y;Quat_Z;Speed", "txyzabcd-", ';'},
      {"qz\tqy\tqx\tqw\tz\ty\tx\tt", "dcbazyxt", '\t'},
      // EuRoC
      {"#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y "
       "[], "
       "q_RS_z [], v_RS_R_x [m s^-1], b_w_RS_S_x [rad s^-1]",
       "Txyzabcd--", ','},
      // Messages of ROS as tables
      {"header.seq,header.stamp.secs,header.stamp.nsecs,pose.pose.position.x,pose.pose.position.y,"
       "pose.pose.position.z,pose.pose.orientation.x,pose.pose.orientation.y,"
       "pose.pose.orientation.z,pose.pose.orientation.w,twist.twist.linear.x,twist.twist.angular.z",
       "-snxyzbcda--", ','},
      {"time,header.stamp.sec,header.stamp.nanosec,position.x,position.y,position.z,orientation.x,"
       "orientation.y,orientation.z,orientation.w",
       "-snxyzbcda", ','},
      {"timestamp_ns,x_m,y_m,z_m,rotation_w,rotation_x,rotation_y,rotation_z", "Txyzabcd", ','},
      {"velocity_x,time (s),translation_x,translation_y,translation_z,q_w,q_x,q_y,q_z", "-txyzabcd",
       ','}};
  const TemporaryFolder folder;
  for (const Dress& dress : dresses) {
    const std::string text =
        std::string(dress.heading) + "\n" + rows_of(dress.letters, dress.separator);
    expect_bend(read_trajectory(folder.write("poses.csv", text)), dress.heading);
    EXPECT_TRUE(has_times(folder.path() / "poses.csv"));
  }
  // TUM's format has one order, and needs no names.
  expect_bend(read_trajectory(folder.write("poses.tum", rows_of("txyzbcda", ' '))), "tum");
  EXPECT_TRUE(has_times(folder.path() / "poses.tum"));
}

TEST(PoseColumns, OtherNamesOfTimes) {
  for (const char* name : {"GpsTime", "gps_time", "GPS Time", "TimeStamp", "time_stamp", "ts"}) {
    const PoseHeading heading = pose_heading_of(std::string("x,y,z,qw,qx,qy,qz,") + name);
    ASSERT_TRUE(heading.columns) << name;
    EXPECT_EQ(heading.columns->of[0], 7U);
  }
  const PoseHeading both = pose_heading_of("GpsTime,time,x,y,z,qw,qx,qy,qz");
  ASSERT_TRUE(both.columns);
  EXPECT_EQ(both.columns->of[0], 1U);
}

// Oracle: the digits of the stamps; doubles cannot distinguish them at these epochs.
TEST(PoseColumns, StampsAFewNanosecondsApartAscend) {
  struct Dress {
    const char *name, *heading, *pose;
    std::vector<std::string> times;
  };
  const Dress dresses[] = {
      {"a.csv",
       "timestamp_ns,x,y,z,qw,qx,qy,qz\n",
       ",0,0,0,1,0,0,0\n",
       {"315966253572412942", "315966253572412947", "315966253572412948", "315966253577482497"}},
      {"b.csv",
       "secs,nsecs,x,y,z,qw,qx,qy,qz\n",
       ",0,0,0,1,0,0,0\n",
       {"1700000000,5", "1700000000,10", "1700000000,11", "1700000001,0"}},
      {"c.tum",
       "",
       " 0 0 0 0 0 0 1\n",
       {"1700000000.000000005", "1700000000.000000010", "1700000000.000000011", "1700000001"}}};
  const TemporaryFolder folder;
  for (const Dress& dress : dresses) {
    const auto text_of = [&](const std::vector<std::size_t>& order) {
      std::string text = dress.heading;
      for (const std::size_t k : order) text += dress.times[k] + dress.pose;
      return text;
    };
    const Trajectory poses = read_trajectory(folder.write(dress.name, text_of({0, 1, 2, 3})));
    ASSERT_EQ(poses.size(), 4U) << dress.name;
    for (std::size_t k = 1; k < 4; ++k) {
      EXPECT_GT(poses[k].time_s, poses[k - 1].time_s) << dress.name;
      EXPECT_LT(poses[k].time_s - poses[k - 1].time_s, k < 3 ? 1e-6 : 1.1) << dress.name;
    }
    for (const auto& order : {std::vector<std::size_t>{0, 2, 1}, {0, 1, 1}})
      expect_error(ErrorKind::data,
                   {dress.name, dress.times[1].substr(0, 10), "does not come after"},
                   [&] { read_trajectory(folder.write(dress.name, text_of(order))); });
  }
  folder.write("times.txt", "1700000000.000000005\n1700000000.000000010\n");
  const Trajectory kitti = read_trajectory(
      folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n"));
  ASSERT_EQ(kitti.size(), 2U);
  EXPECT_GT(kitti[1].time_s, kitti[0].time_s);
}

TEST(PoseColumns, WhatIsNotClearIsAnErrorThatSaysWhatIsExpected) {
  const TemporaryFolder folder;
  const auto reject = [&](const std::string& heading, const std::string& letters,
                          const std::vector<std::string>& parts) {
    const auto path = folder.write("poses.csv", heading + "\n" + rows_of(letters, ','));
    expect_error(ErrorKind::data, parts, [&] { read_trajectory(path); });
  };
  reject("time,x,y,z,q0,q1,q2,q3", "txyzabcd", {":1:", "no qw, qx, qy, qz", "scalar", "quat_w"});
  reject("time,x,y,z,q1,q2,q3,q4", "txyzbcda", {"scalar"});
  reject("x,y,z,qw,qx,qy,qz", "xyzabcd", {"no time", "timestamp_ns"});
  reject("time,x,y,z,roll,pitch,yaw", "txyz---", {"no qw, qx, qy, qz", "from_euler"});
  reject("time,x,y,z,rot_x,rot_y,rot_z", "txyzbcd", {"no qw;"});
  reject("time,stamp,x,y,z,qw,qx,qy,qz", "ttxyzabcd", {"'time' and 'stamp'"});
  reject("time,x,y,z,qw,qx,qy,qz,quat_x", "txyzabcd-", {"'qx' and 'quat_x'"});
  reject("time,x [ft],y [ft],z [ft],qw,qx,qy,qz", "txyzabcd", {"'ft'", "expected m"});
  reject("time [min],x,y,z,qw,qx,qy,qz", "txyzabcd", {"'min'"});
  reject("secs,nsecs,x,y,z,qw,qx,qy,qz", "sTxyzabcd", {":2:", "ns within a second"});
  // A name without a unit is of seconds; nanoseconds since 1970 are none.
  const auto path =
      folder.write("poses.csv", "timestamp,x,y,z,qw,qx,qy,qz\n1700000000123456789,0,0,0,1,0,0,0\n");
  expect_error(ErrorKind::data, {":2:", "timestamp_ns"}, [&] { read_trajectory(path); });
}

// A rotation of the columns leaves norms and angles between poses as they were.
TEST(PoseColumns, OrdersThatAreNamedWrongAreRefusedOnBends) {
  const TemporaryFolder folder;
  const auto last = folder.write("first.tum", rows_of("txyzabcd", ' '));
  expect_error(ErrorKind::data, {"first.tum", "not in the order that is named"},
               [&] { read_trajectory(last); });
  const auto first =
      folder.write("poses.csv", "time,x,y,z,qw,qx,qy,qz\n" + rows_of("txyzbcda", ','));
  expect_error(ErrorKind::data, {"poses.csv", "not in the order that is named"},
               [&] { read_trajectory(first); });
  // A straight drive decides nothing.
  std::string straight;
  for (int k = 0; k < 40; ++k)
    straight += std::to_string(k) + " " + std::to_string(k) + " 0 0 1 0 0 0\n";
  EXPECT_EQ(read_trajectory(folder.write("straight.tum", straight)).size(), 40U);
}

}  // namespace
}  // namespace adasplats
