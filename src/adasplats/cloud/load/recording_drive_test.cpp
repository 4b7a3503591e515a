// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/recording_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "adasplats/cloud/load/court_test.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/bags/recording_files_test.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

using bags_test::bytes_of;
using bags_test::CloudWords;
using bags_test::PoseNumbers;
using bags_test::Said;

constexpr int kRecordedScans = 7;
constexpr double kRecordedSweep_s = 0.1, kPoseStep_s = 0.0125;
constexpr std::int64_t kEpoch_ns = 1'700'000'000'000'000'000;

const char* const kCloudType = "sensor_msgs/msg/PointCloud2";
const char* const kTransformsType = "tf2_msgs/msg/TFMessage";

/// How times of points are put down.
enum class PointClock { none, float_offsets, nanoseconds, absolute, milliseconds_of_another_epoch };

/// Who says where the sensor was.
enum class PoseWay { tf, odometry, pose, nobody };

struct RecordingWords {
  PointClock clock = PointClock::nanoseconds;
  PoseWay poses = PoseWay::tf;
  bool has_static = true;  ///< where the sensor is on the vehicle
  double first_pose_s = -0.2, last_pose_s = 0.9;
  std::string second_topic = {};  ///< of the same points
};

const RigidTransform kVehicleFromLidar = {rotation_from_yaw_pitch_roll(0.4, 0.02, 0),
                                          {0.5, 0.1, 1.2}};

PoseNumbers numbers_of(const RigidTransform& pose) {
  const Quaternion q = quaternion_from_rotation(pose.rotation);
  const Vec3d t = pose.translation;
  return {t.x, t.y, t.z, q.x, q.y, q.z, q.w};
}

std::int64_t stamp_of(double time_s) { return kEpoch_ns + std::llround(1e9 * time_s); }

/// Scans of a Pandar64 in the court as a recording, and what they are.
class RecordedCourt {
 public:
  explicit RecordedCourt(const RecordingWords& words) : words_(words) {
    const LidarModel sensor = load_lidar_model("hesai-pandar64");
    const std::vector<Firing> firings = firings_of(sensor);
    add_poses();
    for (int scan = 0; scan < kRecordedScans; ++scan) add_scan(sensor, firings, scan);
    path_ = folder_.write("drive.mcap", bags_test::mcap_of(declared_));
  }

  const TemporaryFolder& folder() const { return folder_; }
  const std::filesystem::path& path() const { return path_; }

  std::pair<PointCloud, LoadReport> load(LoadOptions options = {}) const {
    options.own_body_m = 0;
    options.driven_path_m = 0;
    ProgressSink quiet;
    return load_cloud(std::span(&path_, 1), options, Executor(2), quiet);
  }

  std::vector<Vec3d> world, origins;

 private:
  void add_poses() {
    if (words_.has_static)
      declared_.push_back(
          {"/tf_static", kTransformsType, 0,
           bags_test::transforms_message(0, "car", "lidar", numbers_of(kVehicleFromLidar))});
    for (double s = words_.first_pose_s; s <= words_.last_pose_s; s += kPoseStep_s) {
      const PoseNumbers car = numbers_of(sensor_at(s) * kVehicleFromLidar.inverse());
      const std::int64_t stamp = stamp_of(s);
      if (words_.poses == PoseWay::tf)
        declared_.push_back(
            {"/tf", kTransformsType, 0, bags_test::transforms_message(stamp, "map", "car", car)});
      if (words_.poses == PoseWay::odometry)
        declared_.push_back({"/odom", "nav_msgs/msg/Odometry", 0,
                             bags_test::odometry_message(stamp, "map", "car", car)});
      if (words_.poses == PoseWay::pose)
        declared_.push_back({"/pose", "geometry_msgs/msg/PoseStamped", 0,
                             bags_test::pose_message(stamp, "map", car)});
    }
  }

  std::string time_bytes(int scan, double after_s) const {
    const double time_s = kRecordedSweep_s * scan + after_s;
    switch (words_.clock) {
      case PointClock::none: return {};
      case PointClock::float_offsets: return bytes_of(static_cast<float>(after_s));
      case PointClock::nanoseconds:
        return bytes_of(static_cast<std::uint32_t>(std::llround(1e9 * after_s)));
      case PointClock::absolute: return bytes_of(1e-9 * static_cast<double>(kEpoch_ns) + time_s);
      default: return bytes_of(1e3 * (time_s + 5000));
    }
  }

  void add_scan(const LidarModel& sensor, const std::vector<Firing>& firings, int scan) {
    CloudWords cloud;
    cloud.stamp_ns = stamp_of(kRecordedSweep_s * scan);
    cloud.fields = {{"x", 0, 8}, {"y", 8, 8}, {"z", 16, 8}, {"intensity", 24, 7}};
    const bool is_double = words_.clock == PointClock::absolute ||
                           words_.clock == PointClock::milliseconds_of_another_epoch;
    const std::uint8_t type = is_double ? 8 : words_.clock == PointClock::float_offsets ? 7 : 6;
    if (words_.clock != PointClock::none)
      cloud.fields.push_back({is_double ? "timestamp" : type == 7 ? "time" : "t", 28, type});
    for (std::size_t i = 0; i < firings.size(); i += 5) {
      const double after_s = kRecordedSweep_s * static_cast<double>(firings[i].column) /
                             static_cast<double>(sensor.columns);
      const RigidTransform pose = sensor_at(kRecordedSweep_s * scan + after_s);
      const Vec3d way = pose.rotation * vec_cast<double>(firings[i].direction);
      const auto range_m = range_in_court(pose.translation, way);
      if (!range_m) continue;
      world.push_back(pose.translation + *range_m * way);
      origins.push_back(pose.translation);
      const Vec3d given = pose.inverse() * world.back();
      cloud.points += bytes_of(given.x) + bytes_of(given.y) + bytes_of(given.z) + bytes_of(7.0F) +
                      time_bytes(scan, after_s);
      ++cloud.width;
    }
    cloud.step = static_cast<std::uint32_t>(cloud.points.size() / cloud.width);
    cloud.row_step = cloud.step * cloud.width;
    declared_.push_back({"/points", kCloudType, 0, bags_test::cloud_message(cloud)});
    if (!words_.second_topic.empty())
      declared_.push_back({words_.second_topic, kCloudType, 0, declared_.back().bytes});
  }

  RecordingWords words_;
  TemporaryFolder folder_;
  std::filesystem::path path_;
  std::vector<Said> declared_;
};

/// Oracle: what the beams were cast from, and where they ended. Between poses the path is taken for
/// straight: off by 8 m/s^2 * (12.5 ms)^2 / 8 = 0.16 mm.
void expect_recorded_as_cast(const RecordedCourt& court, const PointCloud& cloud) {
  ASSERT_EQ(cloud.size(), court.world.size());
  ASSERT_EQ(cloud.sensor_positions.size(), cloud.size());
  double point_m = 0, origin_m = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    point_m = std::max(point_m, length(cloud.world(i) - court.world[i]));
    const Vec3d origin = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
    origin_m = std::max(origin_m, length(origin - court.origins[i]));
  }
  EXPECT_LT(point_m, 0.0002);
  EXPECT_LT(origin_m, 0.002);
  EXPECT_EQ(cloud.intensities, std::vector<float>(cloud.size(), 7.0F));
}

TEST(RecordingDrive, TransformsAndTimesOfPointsBringThemToTheirPlaces) {
  for (const PointClock clock :
       {PointClock::nanoseconds, PointClock::float_offsets, PointClock::absolute}) {
    const RecordedCourt court({.clock = clock});
    const auto [cloud, report] = court.load();
    const DriveFacts& facts = report.drives.at(0).facts;
    EXPECT_NE(facts.points_in.find("'lidar', which moves in 'map'"), std::string::npos)
        << facts.points_in;
    EXPECT_NE(facts.poses.find("by tf"), std::string::npos) << facts.poses;
    EXPECT_NE(facts.motion.find("as measured"), std::string::npos) << facts.motion;
    EXPECT_EQ(report.drives.at(0).sensor, "hesai-pandar64");
    expect_recorded_as_cast(court, cloud);
  }
}

TEST(RecordingDrive, OdometryAndPosesOfTheVehicleAreBroughtToTheSensor) {
  const RecordedCourt odometry({.poses = PoseWay::odometry});
  expect_recorded_as_cast(odometry, odometry.load().first);
  LoadOptions mounted;
  mounted.mount = kVehicleFromLidar.translation;
  mounted.mount_rotation_deg = {0.4 / kDegree, 0.02 / kDegree, 0};
  const RecordedCourt loose({.poses = PoseWay::odometry, .has_static = false});
  expect_recorded_as_cast(loose, loose.load(mounted).first);
  const RecordedCourt pose({.poses = PoseWay::pose, .has_static = false});
  mounted.points_in = PointsIn::sensor;
  expect_recorded_as_cast(pose, pose.load(mounted).first);
}

TEST(RecordingDrive, AStatedTrajectoryGivesThePoses) {
  const RecordedCourt court({.poses = PoseWay::nobody, .has_static = false});
  Trajectory poses;
  for (double s = -0.2; s < 1; s += kPoseStep_s)
    poses.push_back({1e-9 * static_cast<double>(stamp_of(s)), sensor_at(s)});
  LoadOptions options;
  options.trajectory = court.folder().path() / "poses.csv";
  write_trajectory_csv(options.trajectory, poses);
  expect_recorded_as_cast(court, court.load(options).first);
  // In another clock, with what is stated of that.
  for (TimedPose& pose : poses) pose.time_s -= 1e-9 * static_cast<double>(kEpoch_ns);
  write_trajectory_csv(options.trajectory, poses);
  expect_error(ErrorKind::data, {"clocks differ", "time_offset"}, [&] { court.load(options); });
  options.time_offset_s = -1e-9 * static_cast<double>(kEpoch_ns);
  expect_recorded_as_cast(court, court.load(options).first);
}

TEST(RecordingDrive, ScansWithoutPosesAreLeftOutAndNothingIsExtrapolated) {
  // The first two sweeps (0 to 0.2 s) begin before there are poses, 12.5 ms apart.
  const RecordedCourt court({.first_pose_s = 0.15});
  const auto [cloud, report] = court.load();
  EXPECT_EQ(report.drives.at(0).scans, 5U);
  const RecordedCourt late({.first_pose_s = 0.45});
  expect_error(ErrorKind::data, {"5 of 7", "have no pose"}, [&] { late.load(); });
}

TEST(RecordingDrive, WhatIsNotClearIsAnErrorThatNamesIt) {
  const RecordedCourt two({.second_topic = "/front/points"});
  expect_error(ErrorKind::usage, {"/points (", "/front/points (", "`topic`"}, [&] { two.load(); });
  LoadOptions options;
  options.topic = "/front/points";
  expect_recorded_as_cast(two, two.load(options).first);
  options.topic = "/rear";
  expect_error(ErrorKind::usage, {"/rear", "/points ("}, [&] { two.load(options); });
  options = {};
  options.topic = "/points";
  options.poses_topic = "/nothing";
  expect_error(ErrorKind::usage, {"/nothing", "/tf ("}, [&] { two.load(options); });

  const RecordedCourt nobody({.poses = PoseWay::nobody});
  expect_error(ErrorKind::data, {"'lidar'", "'car'", "`trajectory`"}, [&] { nobody.load(); });
  const RecordedCourt loose({.poses = PoseWay::tf, .has_static = false});
  expect_error(ErrorKind::data, {"'lidar'", "'car', 'map'"}, [&] { loose.load(); });
  const RecordedCourt apart({.poses = PoseWay::odometry, .has_static = false});
  expect_error(ErrorKind::data, {"'lidar'", "'car'", "`mount`"}, [&] { apart.load(); });

  const RecordedCourt clock({.clock = PointClock::milliseconds_of_another_epoch});
  expect_error(ErrorKind::data, {"times of its points", "offsets"}, [&] { clock.load(); });
  options = {};
  options.topic = "/points";
  const std::filesystem::path text = two.folder().write("points.xyz", "1 2 3\n4 5 6\n");
  ProgressSink quiet;
  expect_error(ErrorKind::usage, {"`topic`"},
               [&] { load_cloud(std::span(&text, 1), options, Executor(1), quiet); });
}

/// Clouds of two points at 0.5, 1.5, ... s, and poses each 0.1 s but between 2.05 and 4.05 s.
std::vector<Said> clouds_with_a_gap_of_poses() {
  std::vector<Said> messages;
  for (int k = 0; k <= 60; ++k)
    if (k <= 20 || k >= 41)
      messages.push_back({"/tf", kTransformsType, 0,
                          bags_test::transforms_message(stamp_of(0.1 * k), "map", "lidar",
                                                        {0.1 * k, 0, 0, 0, 0, 0, 1})});
  for (int k = 0; k < 6; ++k) {
    CloudWords cloud{.stamp_ns = stamp_of(k + 0.5)};
    cloud.fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}};
    cloud.width = 2;
    cloud.step = 12;
    cloud.row_step = 24;
    for (const float value : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}) cloud.points += bytes_of(value);
    messages.push_back({"/points", kCloudType, 0, bags_test::cloud_message(cloud)});
  }
  return messages;
}

std::pair<PointCloud, LoadReport> load_messages(const TemporaryFolder& folder,
                                                const std::vector<Said>& messages) {
  const std::filesystem::path path = folder.write("drive.mcap", bags_test::mcap_of(messages));
  LoadOptions options;
  options.own_body_m = 0;
  options.driven_path_m = 0;
  ProgressSink quiet;
  return load_cloud(std::span(&path, 1), options, Executor(1), quiet);
}

// Oracle: where the poses, which move by 1 m/s along x, have the points.
TEST(RecordingDrive, ScansInGapsOfPosesAreLeftOut) {
  const TemporaryFolder folder;
  const auto [cloud, report] = load_messages(folder, clouds_with_a_gap_of_poses());
  ASSERT_EQ(cloud.size(), 8U);  // not those at 2.5 and 3.5 s
  const double at_s[] = {0.5, 1.5, 4.5, 5.5};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT(length(cloud.world(2 * k) - Vec3d{1 + at_s[k], 2, 3}), 1e-5) << k;
    EXPECT_LT(length(cloud.world(2 * k + 1) - Vec3d{4 + at_s[k], 5, 6}), 1e-5) << k;
  }
}

TEST(RecordingDrive, CloudsOfSeveralFramesOrOneTimeAreErrors) {
  const TemporaryFolder folder;
  const auto reject = [&](const std::vector<std::string>& parts, CloudWords cloud) {
    std::vector<Said> messages = clouds_with_a_gap_of_poses();
    cloud.fields = {{"x", 0, 7}};
    cloud.width = 1;
    cloud.step = cloud.row_step = 4;
    cloud.points = "1234";
    messages.push_back({"/points", kCloudType, 0, bags_test::cloud_message(cloud)});
    expect_error(ErrorKind::data, parts, [&] { load_messages(folder, messages); });
  };
  reject({"message 7", "'rear'", "'lidar'"}, {.stamp_ns = stamp_of(5.6), .frame = "rear"});
  reject({"clouds 5 and 7 (from 1) of /points have the same time", "topic of its own"},
         {.stamp_ns = stamp_of(4.5)});
  reject({"000006", "no columns x, y and z"}, {.stamp_ns = stamp_of(5.8)});
  // A rotation that is none, of a transform that is needed.
  std::vector<Said> messages = clouds_with_a_gap_of_poses();
  messages.push_back(
      {"/tf", kTransformsType, 0,
       bags_test::transforms_message(stamp_of(7), "map", "lidar", {0, 0, 0, 0, 0, 0, 0})});
  expect_error(ErrorKind::data, {"/tf", "norm 0.000000"}, [&] { load_messages(folder, messages); });
}

// Stamps at today's epochs are 238 ns apart as doubles.
TEST(RecordingDrive, CloudsOfNearlyOneTimeStayInOrderAndCopiesAreSkipped) {
  const TemporaryFolder folder;
  std::vector<Said> messages = clouds_with_a_gap_of_poses();
  CloudWords cloud{.stamp_ns = stamp_of(4.5) - 50};
  cloud.fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}};
  cloud.width = 1;
  cloud.step = cloud.row_step = 12;
  for (const float value : {7.0F, 8.0F, 9.0F}) cloud.points += bytes_of(value);
  messages.push_back({"/points", kCloudType, 0, bags_test::cloud_message(cloud)});
  messages.push_back(messages.back());
  const auto [points, report] = load_messages(folder, messages);
  ASSERT_EQ(points.size(), 9U);
  EXPECT_LT(length(points.world(4) - Vec3d{7 + 4.5, 8, 9}), 1e-5);
  EXPECT_LT(length(points.world(5) - Vec3d{1 + 4.5, 2, 3}), 1e-5);
}

TEST(RecordingDrive, CloudsWithoutAFrameAreRejectedInWords) {
  const TemporaryFolder folder;
  std::vector<Said> messages = clouds_with_a_gap_of_poses();
  std::erase_if(messages, [](const Said& message) { return message.topic == "/points"; });
  CloudWords cloud{.stamp_ns = stamp_of(0.5), .frame = ""};
  cloud.fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}};
  cloud.width = 1;
  cloud.step = cloud.row_step = 12;
  cloud.points = "123412341234";
  messages.push_back({"/points", kCloudType, 0, bags_test::cloud_message(cloud)});
  expect_error(
      ErrorKind::data,
      {"drive.mcap: messages of /points name no frame (frame_id in their headers is empty)",
       "`trajectory`", "`mount`"},
      [&] { load_messages(folder, messages); });
}

}  // namespace
}  // namespace adasplats
