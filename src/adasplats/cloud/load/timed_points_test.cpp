// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/timed_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/las/las_writer.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

constexpr double kGpsDrive_s = 1311000000;  // 2021-07-22
constexpr double kUtcDrive_s = kGpsDrive_s + 315964800 - 18;
constexpr double kWeekDrive_s = kGpsDrive_s - 2167 * 604800.0;
constexpr double kDrive_s = 4;
const Vec3d kArm = {0.8, -0.3, 1.9};

RigidTransform vehicle_on_street(double t) {
  return {rotation_from_yaw_pitch_roll(0.1 * std::sin(0.7 * t), 0.01 * std::sin(t), 0),
          {8 * t, 0.5 * std::sin(0.5 * t), 0.02 * std::sin(t)}};
}

Vec3d sensor_on_street(double t) { return vehicle_on_street(t) * kArm; }

/// Range to a street: ground, two walls and pillars at distances that do not repeat; 0: sky.
double range_in_street(Vec3d from, Vec3d along) {
  double range_m = 60;
  const auto take = [&](double r) {
    if (r > 0 && r < range_m) range_m = r;
  };
  take(-from.z / along.z);
  take((8 - from.y) / along.y);
  take((-7 - from.y) / along.y);
  for (int k = 0; k < 16; ++k) {
    const double x = -40 + 9 * k + 3 * std::sin(2.3 * k), y = k % 2 == 0 ? 4.5 : -4.0, radius = 0.4;
    const double a = along.x * along.x + along.y * along.y;
    const double b = (from.x - x) * along.x + (from.y - y) * along.y;
    const double c = std::pow(from.x - x, 2) + std::pow(from.y - y, 2) - radius * radius;
    if (b * b > a * c) take((-b - std::sqrt(b * b - a * c)) / a);
  }
  return range_m < 60 ? range_m : 0;
}

/// What a spinning sensor of 24 beams saw, with the seconds of its drive.
struct Recording {
  std::vector<double> x, y, z, time_s;

  explicit Recording(std::size_t every = 1) {
    constexpr int kColumns = 240, kBeams = 24;
    for (int k = 0; k < static_cast<int>(10 * kDrive_s) * kColumns; ++k)
      for (int beam = 0; beam < kBeams; ++beam) {
        if (static_cast<std::size_t>(k * kBeams + beam) % every != 0) continue;
        const double t = 0.1 * k / kColumns;
        const double azimuth = 2 * std::numbers::pi * k / kColumns;
        const double elevation = (-18 + beam) * std::numbers::pi / 180;
        const Vec3d along = vehicle_on_street(t).rotation *
                            Vec3d{std::cos(azimuth) * std::cos(elevation),
                                  std::sin(azimuth) * std::cos(elevation), std::sin(elevation)};
        const Vec3d from = sensor_on_street(t);
        const double range_m = range_in_street(from, along);
        if (range_m == 0) continue;
        const Vec3d p = from + range_m * along;
        x.push_back(p.x);
        y.push_back(p.y);
        z.push_back(p.z);
        time_s.push_back(t);
      }
  }

  std::vector<ColumnView> columns(const char* time_name, const std::vector<double>& times) const {
    const auto view = [](const char* name, const std::vector<double>& values) {
      return ColumnView{name, ColumnType::f64, values.data(), sizeof(double)};
    };
    return {view("x", x), view("y", y), view("z", z), view(time_name, times)};
  }
  std::vector<double> times(double begin_s, double unit_s) const {
    std::vector<double> values;
    for (const double t : time_s) values.push_back((begin_s + t) / unit_s);
    return values;
  }
};

/// Files of the recording in a folder.
class TimedPoints : public testing::Test {
 protected:
  std::filesystem::path ply(double begin_s, double unit_s = 1, const char* column = "timestamp") {
    const std::filesystem::path path = folder_.path() / "points.ply";
    const auto times = recording_.times(begin_s, unit_s);
    write_ply(path, times.size(), recording_.columns(column, times));
    return path;
  }
  std::filesystem::path las(double begin_s, bool says_adjusted) {
    const std::filesystem::path path = folder_.path() / "points.las";
    const auto times = recording_.times(begin_s, 1);
    write_las(path, times.size(), recording_.columns("gps_time", times), {.scale_m = 1e-4});
    if (says_adjusted) {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(6);
      file.put(17);
    }
    return path;
  }
  /// Poses of the vehicle from `first` to `last` s of the drive, 50 a second, none in the gap.
  std::filesystem::path poses(double begin_s, double first, double last, Vec3d shift = {},
                              TimeSpan gap = {}) {
    Trajectory trajectory;
    for (int k = static_cast<int>(50 * first); k <= static_cast<int>(50 * last); ++k) {
      const double t = 0.02 * k;
      if (t > gap.first && t < gap.last) continue;
      trajectory.push_back({begin_s + t, vehicle_on_street(t)});
    }
    const std::filesystem::path path = folder_.path() / "poses.csv";
    write_trajectory_csv(path, shifted(trajectory, shift));
    return path;
  }
  LoadOptions with(const std::filesystem::path& trajectory) const {
    LoadOptions options;
    options.trajectory = trajectory;
    options.mount = kArm;
    options.own_body_m = 0;
    return options;
  }
  std::pair<PointCloud, LoadReport> load(const std::filesystem::path& file,
                                         const LoadOptions& options) {
    class Listener : public ProgressSink {
     public:
      explicit Listener(std::string& text) : text_(text) {}
      void warn(std::string_view message) override { text_ += message; }

     private:
      std::string& text_;
    } listener(declared_);
    return load_cloud(std::span(&file, 1), options, Executor(2), listener);
  }
  /// Oracle: where the sensor was when each point was made.
  void expect_true_origins(const PointCloud& cloud) {
    ASSERT_EQ(cloud.size(), recording_.time_s.size());
    ASSERT_EQ(cloud.sensor_positions.size(), cloud.size());
    EXPECT_TRUE(cloud.origin_kinds.empty());  // all are measured
    double worst_m = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3d found = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
      worst_m = std::max(worst_m, length(found - sensor_on_street(recording_.time_s[i])));
    }
    EXPECT_LT(worst_m, 1e-3);
  }

  TemporaryFolder folder_;
  Recording recording_;
  std::string declared_;
};

TEST_F(TimedPoints, LasOfAdjustedTimeAndPosesOfTheWeek) {
  const auto [cloud, report] = load(las(kGpsDrive_s - 1e9, true), with(poses(kWeekDrive_s, -1, 5)));
  expect_true_origins(cloud);
  ASSERT_TRUE(report.timed.has_value());
  EXPECT_NE(report.timed->clock.find("adjusted GPS time; trajectory: GPS seconds of the week"),
            std::string::npos);
  EXPECT_NE(declared_.find("the sensor at (0.800, -0.300, 1.900) m"), std::string::npos)
      << declared_;
  EXPECT_EQ(report.timed->scans, 40U);
  ASSERT_EQ(cloud.scan_poses.size(), 40U);
  ASSERT_EQ(cloud.scan_indices.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); i += 97)
    EXPECT_NEAR(cloud.scan_poses[cloud.scan_indices[i]].time_s - kWeekDrive_s, recording_.time_s[i],
                0.051);
  EXPECT_LT(length(cloud.scan_poses[7].world_from_sensor.translation - sensor_on_street(0.75)),
            1e-3);
}

TEST_F(TimedPoints, PlyOfUtcAndPosesOfGps) {
  const auto [cloud, report] = load(ply(kUtcDrive_s), with(poses(kGpsDrive_s, 0, 4)));
  expect_true_origins(cloud);
  EXPECT_NEAR(report.timed->offset_s, kGpsDrive_s - kUtcDrive_s, 1e-6);
  EXPECT_NE(report.timed->clock.find("UTC since 1970"), std::string::npos);
}

TEST_F(TimedPoints, OfSeveralClocksThePointsTellWhich) {
  // UTC in nanoseconds; whether the poses are of UTC, GPS time or TAI, their drive covers it.
  const auto [cloud, report] =
      load(ply(kUtcDrive_s, 1e-9), with(poses(kGpsDrive_s + 315964800, -60, 60)));
  EXPECT_NEAR(report.timed->offset_s, 18, 1e-6);
  ASSERT_EQ(cloud.sensor_positions.size(), cloud.size());
  EXPECT_LT(length(vec_cast<double>(cloud.sensor_positions[99]) -
                   sensor_on_street(recording_.time_s[99])),
            1e-3);
}

TEST_F(TimedPoints, WithFewPointsSeveralClocksAreAnErrorAndCanBeStated) {
  recording_ = Recording(300);
  const auto points = ply(kUtcDrive_s, 1, "gps_time");
  LoadOptions options = with(poses(kGpsDrive_s, -60, 60));
  expect_error(ErrorKind::data,
               {"several clocks", "too few points", "`time_offset`", "UTC since 1970", "TAI (PTP)"},
               [&] { load(points, options); });
  options.time_offset_s = kGpsDrive_s - kUtcDrive_s;
  expect_true_origins(load(points, options).first);
}

TEST_F(TimedPoints, TimesThatAreNotCoveredAreAnErrorWithFigures) {
  const auto points = ply(kGpsDrive_s);
  expect_error(ErrorKind::data, {"does not cover", " of ", "2.540 s after", "poses.csv"},
               [&] { load(points, with(poses(kGpsDrive_s, 0, 1.4759))); });
  expect_error(ErrorKind::data, {"by any known clock", "`time_offset`"},
               [&] { load(points, with(poses(5000, 0, 4))); });
  LoadOptions options = with(poses(kGpsDrive_s, 0, 4));
  options.time_offset_s = 100;
  expect_error(ErrorKind::data, {"by the stated `time_offset`"}, [&] { load(points, options); });
}

TEST_F(TimedPoints, PointsInAGapAreAnError) {
  expect_error(ErrorKind::data, {"in a gap of the trajectory", "no poses from"}, [&] {
    load(ply(0), with(poses(0, 0, 4, {}, {1.5, 3})));
  });
}

TEST_F(TimedPoints, PosesThatJumpAreAnError) {
  const auto file = poses(kUtcDrive_s, -1, 5);
  Trajectory jumping = read_trajectory(file);
  for (TimedPose& pose : jumping)
    if (pose.time_s > kUtcDrive_s + 0.1) pose.world_from_sensor.translation.x += 60;
  write_trajectory_csv(file, jumping);
  LoadOptions options = with(file);
  options.trust_origins = true;  // the hidden points are reported first
  expect_error(ErrorKind::data, {"poses.csv: between ", "the poses jump by ", "m/s"},
               [&] { load(ply(kUtcDrive_s), options); });
}

TEST_F(TimedPoints, AnotherClockOrPlaceIsAnError) {
  const auto points = ply(0, 1, "time");
  // One second late: the drive covers it, the points do not fit.
  expect_error(ErrorKind::data, {"does not fit", "+1.0 s added", "`time_offset`"},
               [&] { load(points, with(poses(1, -4, 9))); });
  expect_error(ErrorKind::data, {"does not fit", "median range", "another scene"}, [&] {
    load(points, with(poses(0, 0, 4, {400, 500, 0})));
  });
  expect_error(ErrorKind::data, {"does not fit", "in y from the sensor", "another scene"}, [&] {
    load(points, with(poses(0, 0, 4, {10, -100, 0})));
  });
  expect_error(ErrorKind::data, {"does not fit", "is hidden behind other points", "`mount`"}, [&] {
    LoadOptions options = with(poses(0, 0, 4));
    options.mount = Vec3d{0, 0, 0.05};  // on the ground
    load(points, options);
  });
  LoadOptions options = with(poses(1, -4, 9));
  options.trust_origins = true;
  EXPECT_TRUE(load(points, options).second.timed.has_value());
}

TEST_F(TimedPoints, WithoutAMountThePosesAreTheSensorsAndThatIsSaid) {
  const auto points = ply(0, 1, "time");
  LoadOptions options = with(poses(0, 0, 4, {0, 0, 1.9}));
  options.mount.reset();
  EXPECT_EQ(load(points, options).second.origins[3], recording_.time_s.size());
  EXPECT_NE(declared_.find("as the sensor's own since no `mount` is given"), std::string::npos)
      << declared_;
}

TEST_F(TimedPoints, APointWithoutATimeIsAnError) {
  const auto points =
      folder_.write("a.xyz", std::string("x y z time\n1 2 3 0.5\n4 5 6 nan\nnan nan nan nan\n"));
  expect_error(ErrorKind::data, {"a.xyz", "time of point 1"},
               [&] { load(points, with(poses(0, 0, 4))); });
}

TEST_F(TimedPoints, FilesWithSensorPositionsKeepThem) {
  const auto points = folder_.write(
      "a.xyz",
      std::string("x y z time sensor_x sensor_y sensor_z\n1 2 3 0.5 7 7 7\n4 5 6 1 7 7 7"));
  LoadOptions options = with(poses(0, 0, 4));
  options.mount.reset();
  const auto [cloud, report] = load(points, options);
  EXPECT_FALSE(report.timed.has_value());
  EXPECT_EQ(cloud.sensor_positions[1], (Vec3f{7, 7, 7}));
}

TEST_F(TimedPoints, TilesOfOneDriveShareItsScans) {
  recording_ = Recording(20);
  const std::filesystem::path folder = folder_.path() / "tiles";
  std::filesystem::create_directories(folder);
  const auto times = recording_.times(kWeekDrive_s, 1);
  const std::size_t half = times.size() / 2 + 100;  // in the middle of a scan
  std::vector<ColumnView> columns = recording_.columns("gps_time", times);
  write_ply(folder / "a.ply", half, columns);
  for (ColumnView& column : columns) column.data = static_cast<const double*>(column.data) + half;
  write_ply(folder / "b.ply", times.size() - half, columns);
  const auto [cloud, report] = load(folder, with(poses(kWeekDrive_s, 0, 4)));
  expect_true_origins(cloud);
  EXPECT_EQ(cloud.scan_poses.size(), 40U);
  EXPECT_EQ(cloud.scan_indices[half - 1], cloud.scan_indices[half]);
}

TEST_F(TimedPoints, PausesOfTheRecordingEndScans) {
  // Every second revolution, the first one at half of a tenth: pieces by the clock would cut each.
  Recording paused;
  Recording kept(1);
  for (auto* values : {&kept.x, &kept.y, &kept.z, &kept.time_s}) values->clear();
  for (std::size_t i = 0; i < paused.time_s.size(); ++i) {
    const double t = paused.time_s[i];
    if (t < 0.05 || std::fmod(t + 0.05, 0.2) >= 0.1) continue;
    kept.x.push_back(paused.x[i]);
    kept.y.push_back(paused.y[i]);
    kept.z.push_back(paused.z[i]);
    kept.time_s.push_back(t);
  }
  recording_ = kept;
  const auto [cloud, report] = load(ply(kGpsDrive_s), with(poses(kGpsDrive_s, 0, 4)));
  ASSERT_EQ(cloud.scan_poses.size(), 20U);
  for (std::size_t i = 1; i < cloud.size(); ++i)
    EXPECT_EQ(cloud.scan_indices[i] != cloud.scan_indices[i - 1],
              recording_.time_s[i] - recording_.time_s[i - 1] > 0.05);
}

TEST_F(TimedPoints, WhatNothingTakesIsAnError) {
  const auto points = folder_.write("a.xyz", std::string("x y z\n1 2 3\n4 5 6\n"));
  LoadOptions options = with(poses(0, 0, 4));
  expect_error(ErrorKind::usage, {"`mount`", "no input has both"}, [&] { load(points, options); });
  options.mount.reset();
  EXPECT_EQ(load(points, options).first.origin_kind(0), OriginKind::guessed);
  options.time_offset_s = 1;
  expect_error(ErrorKind::usage, {"`time_offset`"}, [&] { load(points, options); });
}

}  // namespace
}  // namespace adasplats
