// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/open_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

/// How far a ray goes in a hall of 30 x 20 x 6 m around the origin, its floor at z = 0.
double range_in_hall(Vec3d origin, Vec3d direction) {
  const Vec3d low = {-15, -10, 0}, high = {15, 10, 6};
  double range_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double wall = direction[axis] > 0 ? high[axis] : low[axis];
    range_m = std::min(range_m, (wall - origin[axis]) / direction[axis]);
  }
  return range_m;
}

RigidTransform vehicle_at(double time_s) {
  return {rotation_from_yaw_pitch_roll(0.5 * time_s, 0, 0), {-4 + 4 * time_s, time_s, 1.9}};
}

// The trajectory is the sensor's own; mounts that differ are recognize_sensor_test's.
const RigidTransform kMount = {{}, {0, 0, 0}};

/// Frames of a Pandar64 that drives through the hall, 10 a second, and the vehicle's poses.
class HallDrive {
 public:
  /// `crs_of_last`: what the last file says, the others say EPSG:32632; empty: none says any.
  explicit HallDrive(const std::string& crs_of_last = "") {
    const LidarModel sensor = load_lidar_model("hesai-pandar64");
    for (int scan = 0; scan < kScans; ++scan) {
      const bool is_last = scan + 1 == kScans;
      write_scan(sensor, scan, is_last || crs_of_last.empty() ? crs_of_last : "EPSG:32632");
    }
    std::string poses = "time,x,y,z,qw,qx,qy,qz\n";
    for (int k = 0; k <= 10; ++k) {
      const double time_s = 0.1 * k;
      const RigidTransform pose = vehicle_at(time_s);
      std::array<char, 160> line{};
      std::snprintf(line.data(), line.size(), "%.6f,%.9f,%.9f,%.9f,%.12f,0,0,%.12f\n", time_s,
                    pose.translation.x, pose.translation.y, pose.translation.z,
                    std::cos(0.25 * time_s), std::sin(0.25 * time_s));
      poses += line.data();
    }
    folder_.write("poses.csv", poses);
  }

  std::filesystem::path frames() const { return folder_.path() / "frames"; }
  std::filesystem::path poses() const { return folder_.path() / "poses.csv"; }
  const TemporaryFolder& folder() const { return folder_; }

  static constexpr int kScans = 6;

 private:
  void write_scan(const LidarModel& sensor, int scan, const std::string& crs) {
    const std::vector<Firing> firings = firings_of(sensor);
    std::vector<double> x, y, z, time;
    for (std::size_t i = 0; i < firings.size(); i += 7) {
      const double time_s = 0.1 * scan + 0.1 * static_cast<double>(firings[i].column) /
                                             static_cast<double>(sensor.columns);
      const RigidTransform pose = vehicle_at(time_s) * kMount;
      const Vec3d direction = pose.rotation * vec_cast<double>(firings[i].direction);
      const Vec3d p = pose.translation + range_in_hall(pose.translation, direction) * direction;
      x.push_back(p.x);
      y.push_back(p.y);
      z.push_back(p.z);
      time.push_back(time_s);
    }
    std::filesystem::create_directories(frames());
    const auto view = [](const char* name, const std::vector<double>& values) {
      return ColumnView{name, ColumnType::f64, values.data(), sizeof(double)};
    };
    const std::vector<ColumnView> columns = {view("x", x), view("y", y), view("z", z),
                                             view("time", time)};
    write_ply(frames() / (std::to_string(scan) + ".ply"), x.size(), columns,
              crs_comments(crs_of_wkt(crs)));
  }

  TemporaryFolder folder_;
};

class WarningText : public ProgressSink {
 public:
  void warn(std::string_view message) override { text += message; }
  std::string text;
};

// Oracle: where the sensor was when each point was made.
TEST(DriveInput, BeamsBeginWhereTheSensorWasAtTheirTime) {
  const HallDrive drive;
  WarningText listener;
  LoadOptions options;
  options.trajectory = drive.poses();
  options.own_body_m = 0;
  const std::filesystem::path frames = drive.frames();
  const auto [cloud, report] = load_cloud(std::span(&frames, 1), options, Executor(2), listener);
  EXPECT_NE(listener.text.find(": points in the world, beams from hesai-pandar64 at "),
            std::string::npos)
      << listener.text;
  EXPECT_EQ(listener.text.find("cones"), std::string::npos) << listener.text;  // evidence: info
  ASSERT_EQ(cloud.scan_poses.size(), 6U);
  ASSERT_EQ(cloud.sensor_positions.size(), cloud.size());
  ASSERT_EQ(cloud.lasers.size(), cloud.size());
  EXPECT_EQ(cloud.origin_kind(5), OriginKind::measured);
  EXPECT_NE(report.beams.front().find("hesai-pandar64"), std::string::npos);
  const RigidTransform expected = vehicle_at(0.05) * kMount;
  EXPECT_LT(length(cloud.scan_poses[0].world_from_sensor.translation - expected.translation), 0.03);
  const std::vector<Firing> firings = firings_of(load_lidar_model("hesai-pandar64"));
  std::size_t of_laser = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    const Firing& firing = firings[7 * i];
    const RigidTransform pose = vehicle_at(0.1 * firing.column / 1800.0) * kMount;
    EXPECT_LT(length(cloud.origin + vec_cast<double>(cloud.sensor_positions[i]) - pose.translation),
              0.03);
    of_laser += cloud.lasers[i] == firing.ring;
  }
  EXPECT_GT(of_laser, 480U);
}

TEST(DriveInput, TheCoordinateSystemIsThatOfItsFiles) {
  ProgressSink quiet;
  const auto load = [&quiet](const HallDrive& drive) {
    LoadOptions options;
    options.trajectory = drive.poses();
    const std::filesystem::path frames = drive.frames();
    return load_cloud(std::span(&frames, 1), options, Executor(2), quiet).first;
  };
  EXPECT_EQ(load(HallDrive("EPSG:32632")).crs.name(), "EPSG:32632");
  expect_error(ErrorKind::data, {"5.ply", "EPSG:32633", "0.ply", "EPSG:32632"},
               [&] { load(HallDrive("EPSG:32633")); });
}

TEST(DriveInput, AnotherClockIsAnError) {
  const HallDrive drive;
  ProgressSink quiet;
  const auto late = drive.folder().write(
      "late.csv",
      std::string("time,x,y,z,qw,qx,qy,qz\n1e9,0,0,0,1,0,0,0\n1000000001,1,0,0,1,0,0,0\n"));
  expect_error(ErrorKind::data, {"0.ply", "the clocks differ", "late.csv"}, [&] {
    DriveSettings settings;
    settings.trajectory = late;
    open_drive(drive_of(drive.frames(), settings), Executor(1), quiet);
  });
}

TEST(DriveInput, AnotherClockCanBeStated) {
  const HallDrive drive;
  ProgressSink quiet;
  Trajectory late = read_trajectory(drive.poses());
  for (TimedPose& pose : late) pose.time_s += 1000;
  LoadOptions options;
  options.trajectory = drive.folder().path() / "late.csv";
  write_trajectory_csv(options.trajectory, late);
  options.time_offset_s = 1000;
  const std::filesystem::path frames = drive.frames();
  const auto report = load_cloud(std::span(&frames, 1), options, Executor(2), quiet).second;
  ASSERT_EQ(report.beams.size(), 1U);
  EXPECT_NE(report.beams.front().find("hesai-pandar64"), std::string::npos);
  EXPECT_FALSE(report.timed.has_value());
}

TEST(DriveInput, AStatedMountTakesThePlaceOfRecognition) {
  const HallDrive drive;
  ProgressSink quiet;
  LoadOptions options;
  options.trajectory = drive.poses();
  options.mount = kMount.translation;
  options.own_body_m = 0;
  const std::filesystem::path frames = drive.frames();
  const auto [cloud, report] = load_cloud(std::span(&frames, 1), options, Executor(2), quiet);
  ASSERT_TRUE(report.timed.has_value());
  EXPECT_EQ(report.timed->scans, 6U);
  EXPECT_TRUE(cloud.lasers.empty());
  const RigidTransform first = vehicle_at(0) * kMount;
  EXPECT_LT(length(cloud.origin + vec_cast<double>(cloud.sensor_positions[0]) - first.translation),
            0.001);
}

/// Points of no sensor, with times.
std::filesystem::path frames_of_nothing(const TemporaryFolder& folder) {
  for (const char* name : {"frames/a.xyz", "frames/b.xyz"}) {
    std::string text = "x y z time\n";
    for (int i = 0; i < 700; ++i) {
      std::array<char, 64> line{};
      std::snprintf(line.data(), line.size(), "%d %d %d 0.5\n", i % 20 - 10, i % 17 - 8, i % 5);
      text += line.data();
    }
    folder.write(name, text);
  }
  folder.write("poses.csv",
               std::string("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,1,0,0,1,0,0,0\n"));
  return folder.path() / "frames";
}

TEST(DriveInput, WithoutARecognisedSensorNothingIsMeasuredAndThatIsSaid) {
  const TemporaryFolder folder;
  const std::filesystem::path frames = frames_of_nothing(folder);
  WarningText listener;
  LoadOptions options;
  options.trajectory = folder.path() / "poses.csv";
  // The frame is undetermined, and it is not guessed.
  ProgressSink silent;
  expect_error(ErrorKind::data, {"cannot determine", "points_in"},
               [&] { load_cloud(std::span(&frames, 1), options, Executor(2), silent); });
  options.points_in = PointsIn::world;
  const PointCloud cloud = load_cloud(std::span(&frames, 1), options, Executor(2), listener).first;
  EXPECT_EQ(cloud.size(), 1400U);
  EXPECT_EQ(cloud.origin_kind(0), OriginKind::guessed);
  EXPECT_TRUE(cloud.scan_poses.empty());
  EXPECT_NE(listener.text.find("its sensor is not recognised"), std::string::npos);
  // What is for scans alone must not be dropped in silence.
  ProgressSink quiet;
  options.scan_stride = 2;
  expect_error(ErrorKind::usage, {"a choice of scans"},
               [&] { load_cloud(std::span(&frames, 1), options, Executor(2), quiet); });
  options.scan_stride = 0;
  expect_error(ErrorKind::usage, {"stride is 0"},
               [&] { load_cloud(std::span(&frames, 1), options, Executor(2), quiet); });
}

TEST(DriveInput, BoxesOfAnotherClockAreAnError) {
  const HallDrive drive;
  ProgressSink quiet;
  const auto boxes = drive.folder().write(
      "boxes.csv", std::string("time,id,stationary,x,y,z,size_x,size_y,size_z,yaw\n"
                               "1e9,1,0,0,0,0,1,1,1,0\n"));
  expect_error(ErrorKind::data, {"boxes.csv", "the clocks differ"}, [&] {
    DriveSettings settings;
    settings.trajectory = drive.poses();
    settings.boxes = boxes;
    open_drive(drive_of(drive.frames(), settings), Executor(1), quiet);
  });
}

TEST(DriveInput, FilesWithoutTimesAreNone) {
  const TemporaryFolder folder;
  folder.write("a.xyz", std::string("x y z\n1 2 3\n"));
  folder.write("b.xyz", std::string("x y z\n1 2 3\n"));
  EXPECT_FALSE(has_timed_frames(folder.path()));
  EXPECT_FALSE(has_timed_frames(folder.path() / "a.xyz"));
}

/// Twelve points around (x_m, 0, 0).
std::string points_around(double x_m) {
  std::string text = "x y z\n";
  for (int k = 0; k < 12; ++k)
    text += std::to_string(x_m + 9 * std::cos(0.5 * k)) + " " +
            std::to_string(9 * std::sin(0.5 * k)) + " 1\n";
  return text;
}

TEST(DriveInput, AnotherNumberOfPosesThanScansIsAnError) {
  const TemporaryFolder folder;
  ProgressSink quiet;
  for (const char* name : {"f/a.xyz", "f/b.xyz", "f/c.xyz"}) folder.write(name, points_around(0));
  std::string tum, kitti;
  for (int k = 0; k < 4; ++k) {
    tum += std::to_string(100 + k) + " " + std::to_string(k) + " 0 0 0 0 0 1\n";
    kitti += "1 0 0 " + std::to_string(k) + " 0 1 0 0 0 0 1 0\n";
  }
  DriveSettings settings;
  settings.trajectory = folder.write("four.tum", tum);
  const auto open = [&] {
    return open_drive(drive_of(folder.path() / "f", settings), Executor(1), quiet);
  };
  expect_error(ErrorKind::data,
               {"3 point files, 4 poses in", "four.tum", "`scan_times`", "all sides of the origin",
                "`points_in`"},
               open);
  settings.trajectory = folder.write("four.txt", kitti);
  expect_error(ErrorKind::data,
               {"3 point files, 4 poses without times in", "four.txt", "times.txt"}, open);
  settings.points_in = PointsIn::world;
  EXPECT_FALSE(open());
  // Tiles, whose sensor positions are unknown.
  settings.points_in = PointsIn::found;
  folder.write("f/c.xyz", points_around(30));
  EXPECT_FALSE(open());
}

TEST(DriveInput, PointsWithTimesNeedPosesWithTimes) {
  const HallDrive drive;
  ProgressSink quiet;
  std::string rows;
  for (int k = 0; k < HallDrive::kScans; ++k) rows += "1 0 0 5 0 1 0 0 0 0 1 0\n";
  DriveSettings settings;
  settings.trajectory = drive.folder().write("rows.txt", rows);
  settings.points_in = PointsIn::world;
  expect_error(ErrorKind::data, {"rows.txt: its poses have no times", "times.txt"},
               [&] { open_drive(drive_of(drive.frames(), settings), Executor(1), quiet); });
}

TEST(DriveInput, ASequenceWithPosesOfAnotherFileKeepsItsLabels) {
  const TemporaryFolder folder;
  std::vector<float> values;
  std::vector<std::uint32_t> labels;
  for (int k = 0; k < 12; ++k) {
    const float turned = 0.5F * static_cast<float>(k);
    values.insert(values.end(), {9 * std::cos(turned), 9 * std::sin(turned), 1.0F, 0.5F});
    labels.push_back(static_cast<std::uint32_t>((3 << 16) + 40 + k));
  }
  folder.write("00/velodyne/000000.bin", values);
  const auto label_file = folder.write("00/labels/000000.label", labels);
  LoadOptions options;
  options.trajectory = folder.write("one.txt", "1 0 0 5 0 1 0 0 0 0 1 0\n");
  options.own_body_m = options.driven_path_m = 0;
  ProgressSink quiet;
  for (const char* input : {"00", "00/velodyne"}) {
    const std::filesystem::path path = folder.path() / input;
    const PointCloud cloud = load_cloud(std::span(&path, 1), options, Executor(1), quiet).first;
    ASSERT_EQ(cloud.size(), 12U) << input;
    ASSERT_EQ(cloud.classes.size(), 12U) << input;
    EXPECT_EQ(cloud.classes[11], 51) << input;
    EXPECT_EQ(cloud.instances[11], 3) << input;
    EXPECT_NEAR(cloud.sensor_positions[0].x + cloud.origin.x, 5, 1e-5) << input;
  }
  std::filesystem::rename(label_file, folder.path() / "00/labels/000001.label");
  const std::filesystem::path path = folder.path() / "00";
  expect_error(ErrorKind::data, {"000000.label: is missing"},
               [&] { load_cloud(std::span(&path, 1), options, Executor(1), quiet); });
}

}  // namespace
}  // namespace adasplats
