// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/sensor_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "adasplats/cloud/beams/empty_beams.h"
#include "adasplats/cloud/load/court_test.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

struct Box {
  Vec3d low, high;
};
constexpr Box kTruck = {{2, 6, 0}, {10, 8, 6}};  // which stands out over the wall

/// Where a ray from outside enters a box.
std::optional<double> range_to(const Box& box, Vec3d origin, Vec3d way) {
  double enters_m = 0, leaves_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.low[axis] - origin[axis]) / way[axis];
    const double b = (box.high[axis] - origin[axis]) / way[axis];
    enters_m = std::max(enters_m, std::min(a, b));
    leaves_m = std::min(leaves_m, std::max(a, b));
  }
  if (enters_m > leaves_m) return std::nullopt;
  return enters_m;
}

/// Between poses the path is taken for straight: at 8 m/s^2 with a pose each 12.5 ms it is off by
/// 8 * 0.0125^2 / 8 = 0.156 mm; what floats leave comes on top.
constexpr double kStraight_m = 0.0002;
/// Frames of the middles of sweeps are taken for those of the middles of the points' times. These
/// begin with the first column and end with the last that is written, five before the next sweep,
/// so their middle is 2.5 columns or 139 us early; the place that a frame has a point at moves by
/// up to 25.4 m/s (11.6 m/s, and a turn by 0.6 rad/s seen at 31 m): 3.53 mm. Every column would
/// leave 0.7.
constexpr double kHalfStep_m = 0.0036;

/// How the same measurements are put down.
enum class PointFrame { world, measured, compensated };
struct Words {
  PointFrame dress = PointFrame::measured;
  bool has_times = true, offsets = false, stamped_names = false, has_truck = false;
  double unit_s = 1;
  double clock_s = 0;  ///< at the begin of the drive
};

constexpr int kScans = 7;
constexpr double kSweep_s = 0.1;

/// Scans of a Pandar64 in the court, and what they are.
class Court {
 public:
  explicit Court(const Words& words, std::size_t every = 5) : words_(words) {
    const LidarModel sensor = load_lidar_model("hesai-pandar64");
    const std::vector<Firing> firings = firings_of(sensor);
    for (int scan = 0; scan < kScans; ++scan) write_scan(sensor, firings, scan, every);
    Trajectory poses;
    for (int k = -16; k <= 8 * kScans + 16; ++k) {
      const double time_s = kSweep_s / 8 * k;
      poses.push_back({words.clock_s + time_s, sensor_at(time_s)});
    }
    write_trajectory_csv(folder_.path() / "poses.csv", poses);
  }

  const TemporaryFolder& folder() const { return folder_; }
  std::filesystem::path scans() const { return folder_.path() / "scans"; }

  std::pair<PointCloud, LoadReport> load(LoadOptions options = {}) const {
    options.trajectory = folder_.path() / "poses.csv";
    options.own_body_m = 0;
    options.driven_path_m = 0;
    const std::filesystem::path inputs = scans();
    ProgressSink quiet;
    return load_cloud(std::span(&inputs, 1), options, Executor(2), quiet);
  }

  std::vector<Vec3d> world, origins;  ///< of the points, in their order
  std::size_t steep_on_truck = 0;     ///< beams that would count as empty, were they

 private:
  void write_scan(const LidarModel& sensor, const std::vector<Firing>& firings, int scan,
                  std::size_t every) {
    std::vector<double> x, y, z, times;
    const RigidTransform frame = sensor_at(kSweep_s * (scan + 0.5));
    for (std::size_t i = 0; i < firings.size(); i += every) {
      const double after_s =
          kSweep_s * static_cast<double>(firings[i].column) / static_cast<double>(sensor.columns);
      const RigidTransform pose = sensor_at(kSweep_s * scan + after_s);
      const Vec3d way = pose.rotation * vec_cast<double>(firings[i].direction);
      auto range_m = range_in_court(pose.translation, way);
      const auto truck_m = range_to(kTruck, pose.translation, way);
      if (words_.has_truck && truck_m) {
        range_m = std::min(*truck_m, range_m.value_or(*truck_m));
        if (way.z > EmptyBeamOptions{}.min_up) ++steep_on_truck;
      }
      if (!range_m) continue;
      world.push_back(pose.translation + *range_m * way);
      origins.push_back(pose.translation);
      const Vec3d given = words_.dress == PointFrame::world      ? world.back()
                          : words_.dress == PointFrame::measured ? pose.inverse() * world.back()
                                                                 : frame.inverse() * world.back();
      x.push_back(given.x);
      y.push_back(given.y);
      z.push_back(given.z);
      times.push_back(words_.offsets
                          ? (after_s - 0.5 * kSweep_s) / words_.unit_s
                          : (words_.clock_s + kSweep_s * scan + after_s) / words_.unit_s);
    }
    const auto view = [](const char* name, const std::vector<double>& values) {
      return ColumnView{name, ColumnType::f64, values.data(), sizeof(double)};
    };
    std::vector<ColumnView> columns = {view("x", x), view("y", y), view("z", z)};
    if (words_.has_times) columns.push_back(view("timestamp", times));
    std::array<char, 64> name{};
    if (words_.stamped_names)
      std::snprintf(name.data(), name.size(), "%.6f.ply", words_.clock_s + kSweep_s * (scan + 0.5));
    else
      std::snprintf(name.data(), name.size(), "scan-%c.ply", 'a' + scan);
    std::filesystem::create_directories(scans());
    write_ply(scans() / name.data(), x.size(), columns);
  }

  Words words_;
  TemporaryFolder folder_;
};

/// Oracle: what the beams were cast from, and where they ended.
void expect_as_cast(const Court& court, const PointCloud& cloud, double max_m) {
  ASSERT_EQ(cloud.size(), court.world.size());
  ASSERT_EQ(cloud.sensor_positions.size(), cloud.size());
  double point_m = 0, origin_m = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    point_m = std::max(point_m, length(cloud.world(i) - court.world[i]));
    const Vec3d origin = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
    origin_m = std::max(origin_m, length(origin - court.origins[i]));
  }
  EXPECT_LT(point_m, max_m);
  EXPECT_LT(origin_m, 0.002);  // the recognised mount, or half a step at 11.6 m/s
}

const DriveFacts& facts_of(const LoadReport& report) { return report.drives.at(0).facts; }

TEST(SensorFrames, PointsAsMeasuredAreBroughtToTheirScan) {
  const Court court({.dress = PointFrame::measured});
  const auto [cloud, report] = court.load();
  EXPECT_NE(facts_of(report).points_in.find("sensor's frame"), std::string::npos);
  EXPECT_NE(facts_of(report).motion.find("as measured"), std::string::npos)
      << facts_of(report).motion;
  EXPECT_EQ(report.drives.at(0).sensor, "hesai-pandar64");
  expect_as_cast(court, cloud, kStraight_m);
}

TEST(SensorFrames, CompensatedPointsKeepTheirPlacesAndGetTheOriginsOfTheirTimes) {
  const Court court({.dress = PointFrame::compensated});
  const auto [cloud, report] = court.load();
  EXPECT_NE(facts_of(report).motion.find("already compensated"), std::string::npos)
      << facts_of(report).motion;
  expect_as_cast(court, cloud, kHalfStep_m);
}

TEST(SensorFrames, PointsInTheWorldAreToldFromThem) {
  const Court court({.dress = PointFrame::world});
  const auto [cloud, report] = court.load();
  EXPECT_NE(facts_of(report).points_in.find("world"), std::string::npos);
  EXPECT_NE(facts_of(report).clock.find("share a clock"), std::string::npos)
      << facts_of(report).clock;
  expect_as_cast(court, cloud, kStraight_m);
}

// Units are those of Ouster (ns), Livox (us) and others; names are stamps of the middles.
TEST(SensorFrames, OffsetsFromTheStampsInTheNamesAreUnderstoodInTheirUnits) {
  for (const double unit_s : {1.0, 1e-6, 1e-9}) {
    const Court court({.offsets = true, .stamped_names = true, .unit_s = unit_s, .clock_s = 1.5e9});
    const auto [cloud, report] = court.load();
    EXPECT_NE(facts_of(report).poses.find("time stamps"), std::string::npos);
    expect_as_cast(court, cloud, kStraight_m);
  }
}

TEST(SensorFrames, WithoutTimesOfThePointsEachScanStandsStill) {
  const Court court({.dress = PointFrame::compensated, .has_times = false, .stamped_names = true});
  const auto [cloud, report] = court.load();
  EXPECT_NE(facts_of(report).motion.find("assumed to be at rest"), std::string::npos);
  ASSERT_EQ(cloud.size(), court.world.size());
  for (std::size_t i = 0; i < cloud.size(); i += 11)
    ASSERT_LT(length(cloud.world(i) - court.world[i]), kStraight_m);
}

TEST(SensorFrames, ShiftedClocksOfPointsInTheWorldAreRefused) {
  const Court court({.dress = PointFrame::world});
  LoadOptions options;
  options.time_offset_s = 0.1;  // what the sensor's poses would be without
  options.points_in = PointsIn::world;
  Trajectory late = read_trajectory(court.folder().path() / "poses.csv");
  for (TimedPose& pose : late) pose.time_s += 0.1;
  write_trajectory_csv(court.folder().path() / "poses.csv", late);
  EXPECT_GT(court.load(options).first.size(), 1000U);
  options.time_offset_s.reset();
  expect_error(ErrorKind::data, {"the clocks of the points and the trajectory differ", "+0.10 s"},
               [&] { court.load(options); });
}

TEST(SensorFrames, PointsInBoxesAreLeftOutAndCounted) {
  const Court court({.dress = PointFrame::world});
  LoadOptions options;
  const PointCloud all = court.load(options).first;
  options.empty_beams = true;
  options.boxes = court.folder().write(
      "boxes.csv", std::string("time,id,stationary,x,y,z,size_x,size_y,size_z,yaw\n"
                               "0,1,0,6,12,1.5,6,2,6,0\n0.7,1,0,6,12,1.5,6,2,6,0\n"));
  const auto [left, report] = court.load(options);
  EXPECT_GT(report.in_boxes, 100U);
  EXPECT_EQ(left.size() + report.in_boxes, all.size());
}

// Points in boxes go, but what their beams saw stays: the sky is not seen through a truck. Oracles:
// the beams as they were cast, and the same drive without boxes.
TEST(SensorFrames, BeamsThatEndedInABoxAreNotEmpty) {
  const Court court({.dress = PointFrame::world, .has_truck = true});
  ASSERT_GT(court.steep_on_truck, 1000U);
  LoadOptions options;
  options.empty_beams = true;
  const PointCloud without = court.load(options).first;
  options.boxes = court.folder().write(
      "boxes.csv", std::string("time,id,stationary,x,y,z,size_x,size_y,size_z,yaw\n"
                               "0,1,0,6,7,3,8,2,6,0\n0.7,1,0,6,7,3,8,2,6,0\n"));
  const auto [with, report] = court.load(options);
  EXPECT_GT(report.in_boxes, court.steep_on_truck);
  EXPECT_EQ(with.size() + report.in_boxes, without.size());
  ASSERT_GT(with.empty_beams.size(), 1000U);
  ASSERT_EQ(with.empty_beams.size(), without.empty_beams.size());
  constexpr double kEdge_m = 0.3;  // half a step between beams, and the recognised mount
  const Vec3d edge = {kEdge_m, kEdge_m, kEdge_m};
  const Box inner = {kTruck.low + edge, kTruck.high - edge};
  std::size_t through = 0;
  for (std::size_t i = 0; i < with.empty_beams.size(); ++i) {
    const EmptyBeam& beam = with.empty_beams[i];
    EXPECT_EQ(beam.origin, without.empty_beams[i].origin);
    EXPECT_EQ(beam.direction, without.empty_beams[i].direction);
    EXPECT_EQ(beam.scan, without.empty_beams[i].scan);
    const Vec3d origin = with.origin + vec_cast<double>(beam.origin);
    through += range_to(inner, origin, vec_cast<double>(beam.direction)) ? 1 : 0;
  }
  EXPECT_EQ(through, 0U);
}

TEST(SensorFrames, WhatIsForScansNeedsScans) {
  const TemporaryFolder folder;
  const auto points = folder.write("a.xyz", std::string("x y z\n1 2 3\n"));
  ProgressSink quiet;
  LoadOptions options;
  options.points_in = PointsIn::sensor;
  expect_error(ErrorKind::usage, {"points_in"},
               [&] { load_cloud(std::span(&points, 1), options, Executor(1), quiet); });
}

}  // namespace
}  // namespace adasplats
