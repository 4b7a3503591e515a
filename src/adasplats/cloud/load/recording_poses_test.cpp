// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/recording_poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/bags/recording_files_test.h"

namespace adasplats {
namespace {

using bags_test::Said;

constexpr std::int64_t kTenSeconds_ns = 10'000'000'000;

std::int64_t at_step(int step) { return kTenSeconds_ns + step * std::int64_t{10'000'000}; }

/// Poses every 10 ms at 5 m/s along x of `child` in 'map', from 10 to 11 s.
void add_moves(std::vector<Said>& messages, const std::string& topic, const std::string& child) {
  for (int step = 0; step <= 100; ++step) {
    const bags_test::PoseNumbers pose = {0.05 * step, 2, 0, 0, 0, 0, 1};
    if (topic == "/tf")
      messages.push_back({topic, "tf2_msgs/msg/TFMessage", 0,
                          bags_test::transforms_message(at_step(step), "map", child, pose)});
    else
      messages.push_back({topic, "nav_msgs/msg/Odometry", 0,
                          bags_test::odometry_message(at_step(step), "map", child, pose)});
  }
}

/// A cloud of one point every 100 ms from 10.005 s on, which is between two poses.
void add_clouds(std::vector<Said>& messages, int first = 0) {
  for (int k = first; k < 10; ++k) {
    bags_test::CloudWords cloud;
    cloud.stamp_ns = at_step(10 * k) + 5'000'000;
    cloud.fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}};
    cloud.width = 1;
    cloud.step = cloud.row_step = 12;
    cloud.points = std::string(12, '\0');
    messages.push_back(
        {"/points", "sensor_msgs/msg/PointCloud2", 0, bags_test::cloud_message(cloud)});
  }
}

class RecordedWays : public ::testing::Test {
 protected:
  RecordedTrajectory read(const std::string& poses_topic = "", const std::string& topic = "") {
    const auto path = folder_.write("drive.mcap", bags_test::mcap_of(messages));
    ProgressSink quiet;
    return trajectory_of_recording(path, topic, poses_topic, quiet);
  }

  std::vector<Said> messages;

 private:
  TemporaryFolder folder_;
};

// Oracle: by hand.
TEST_F(RecordedWays, PosesAreAtTheTimesOfClouds) {
  messages.push_back({"/tf_static", "tf2_msgs/msg/TFMessage", 0,
                      bags_test::transforms_message(0, "car", "lidar", {0, 0, 1.5, 0, 0, 0, 1})});
  add_moves(messages, "/tf", "car");
  add_clouds(messages, -1);  // the first one is 95 ms before the first pose
  const RecordedTrajectory way = read();
  ASSERT_EQ(way.poses.size(), 10U);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_NEAR(way.poses[k].time_s, 10.005 + 0.1 * static_cast<double>(k), 1e-6);
    const Vec3d at = way.poses[k].world_from_sensor.translation;
    EXPECT_LT(length(at - Vec3d{0.025 + 0.5 * static_cast<double>(k), 2, 1.5}), 1e-5);
  }
  EXPECT_EQ(way.motion.size(), 101U);
  EXPECT_NE(way.by.find("/points"), std::string::npos) << way.by;
  EXPECT_NE(way.by.find("'lidar'"), std::string::npos) << way.by;
  expect_error(ErrorKind::usage, {"/other", "/points"}, [&] { read("", "/other"); });
  expect_error(ErrorKind::usage, {"/other", "/tf"}, [&] { read("/other"); });
}

TEST_F(RecordedWays, AVehicleThatNothingJoinsToTheCloudsKeepsItsPoses) {
  add_moves(messages, "/odom", "car");
  add_clouds(messages);
  const RecordedTrajectory way = read();
  ASSERT_EQ(way.poses.size(), 10U);
  EXPECT_NEAR(way.poses[9].world_from_sensor.translation.x, 4.525, 1e-5);
  EXPECT_NE(way.by.find("no transforms connect"), std::string::npos) << way.by;
}

TEST_F(RecordedWays, WithoutCloudsAllPosesAreTaken) {
  add_moves(messages, "/odom", "car");
  EXPECT_EQ(read().poses.size(), 101U);
  add_moves(messages, "/tf", "other");
  EXPECT_EQ(read("/tf").poses.size(), 101U);
  add_moves(messages, "/tf", "third");
  expect_error(ErrorKind::usage, {"drive.mcap", "'other', 'third'"}, [&] { read("/tf"); });
  EXPECT_EQ(read("/odom").poses.size(), 101U);
  messages.clear();
  messages.push_back({"/words", "std_msgs/msg/String", 0, "hello"});
  expect_error(ErrorKind::data, {"drive.mcap", "no poses"}, [&] { read(); });
}

// Oracle: the stamps; today doubles resolve 0.24 us.
TEST_F(RecordedWays, PosesAFewNanosecondsApartStay) {
  for (const int k : {0, 2, 1, 2, 3})
    messages.push_back({"/odom", "nav_msgs/msg/Odometry", 0,
                        bags_test::odometry_message(1'700'000'000'000'000'000 + 5 * k, "map", "car",
                                                    {1.0 * k, 0, 0, 0, 0, 0, 1})});
  const Trajectory poses = read().poses;
  ASSERT_EQ(poses.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(poses[k].world_from_sensor.translation.x, static_cast<double>(k));
    if (k > 0) {
      EXPECT_GT(poses[k].time_s, poses[k - 1].time_s);
    }
  }
}

TEST_F(RecordedWays, CloudsOfAnotherClockAreRefused) {
  add_moves(messages, "/tf", "lidar");
  for (int k = 0; k < 3; ++k) {
    add_clouds(messages, 9);
    messages.back().bytes[4] = static_cast<char>(70 + k);  // seconds of the header
  }
  expect_error(ErrorKind::data, {"drive.mcap", "clocks"}, [&] { read(); });
}

// Oracle: the times of the log, in steps of 10 ms.
TEST_F(RecordedWays, PosesWithoutTimesInTheirHeadersHaveThoseOfTheLog) {
  const auto add = [&](std::int64_t stamp_ns) {
    messages.clear();
    for (int k = 0; k < 5; ++k)
      messages.push_back({"/pose", "geometry_msgs/msg/PoseStamped",
                          static_cast<std::uint64_t>(at_step(k)),
                          bags_test::pose_message(stamp_ns, "map", {1.0 * k, 0, 0, 0, 0, 0, 1})});
  };
  add(0);
  const RecordedTrajectory way = read();
  ASSERT_EQ(way.poses.size(), 5U);
  EXPECT_NEAR(way.poses[4].time_s - way.poses[0].time_s, 0.04, 1e-6);
  EXPECT_NE(way.by.find("times of the log"), std::string::npos) << way.by;
  add(kTenSeconds_ns);
  expect_error(ErrorKind::data, {"drive.mcap", "4 of 5 poses", "time of another pose"},
               [&] { read(); });
}

}  // namespace
}  // namespace adasplats
