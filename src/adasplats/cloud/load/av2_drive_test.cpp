// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/av2_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "adasplats/cloud/load/court_test.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/cloud/sequence/sensor_cones.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/arrow/arrow_writer_test.h"

namespace adasplats {
namespace {

using arrow_test::arrow_file;
using arrow_test::numbers;
using arrow_test::texts;

/// Elevation by laser_number, as points of a public log lie (log 7fab2350, seen from up_lidar).
constexpr double kElevations_deg[] = {
    7,      -1.667, 1.667,  -0.667, 15,     -0.333, 3.333,   0.667,  1.333,  0,  1,
    2.333,  0.333,  -1,     4.667,  10.333, -6.148, -15.639, -3,     -2,     -4, -8.843,
    -4.667, -3.333, -2.667, -5.333, -1.333, -7.254, -3.667,  -11.31, -2.333, -25};
const RigidTransform kUp = {rotation_from_yaw_pitch_roll(-0.01, 0, 0), {1.35, 0, 1.64}};
const RigidTransform kDown = {rotation_from_yaw_pitch_roll(0.2, 0, 3.14), {1.347, 0.005, 1.525}};
constexpr std::int64_t kFirst_ns = 315'966'265'259'836'000;
constexpr std::int64_t kSweep_ns = 100'000'000;

struct PoseTable {
  std::vector<double> qw, qx, qy, qz, x, y, z;

  void add(const RigidTransform& pose) {
    const Quaternion q = quaternion_from_rotation(pose.rotation);
    qw.push_back(q.w), qx.push_back(q.x), qy.push_back(q.y), qz.push_back(q.z);
    x.push_back(pose.translation.x), y.push_back(pose.translation.y);
    z.push_back(pose.translation.z);
  }
  std::vector<arrow_test::ArrowColumn> after(arrow_test::ArrowColumn first) const {
    return {std::move(first),  numbers("qw", qw),  numbers("qx", qx),  numbers("qy", qy),
            numbers("qz", qz), numbers("tx_m", x), numbers("ty_m", y), numbers("tz_m", z)};
  }
};

/// A log of a car in the court. Its points have the coordinates of the moment of the sweep.
class Av2Court {
 public:
  explicit Av2Court(int sweeps = 3) {
    for (const SensorCones& cones : library_cones())
      if (cones.sensor == "velodyne-vlp-32c") cones_ = cones;
    write_poses(sweeps);
    write_mounts("up_lidar", "down_lidar");
    for (int k = 0; k < sweeps; ++k) {
      write_sweep(k);
      sweep_ends.push_back(world.size());
    }
  }

  static RigidTransform vehicle_at(std::int64_t stamp_ns) {
    RigidTransform pose = sensor_at(1e-9 * static_cast<double>(stamp_ns - kFirst_ns));
    pose.translation.z = 0;
    return pose;
  }

  void write_poses(int sweeps) const {
    std::vector<std::int64_t> stamps;
    PoseTable poses;
    for (std::int64_t at = kFirst_ns; at <= kFirst_ns + sweeps * kSweep_ns; at += 5'000'000) {
      for (const std::int64_t stamp : {at, at + 5}) {  // real logs have poses 5 ns apart
        stamps.push_back(stamp);
        poses.add(vehicle_at(stamp));
      }
    }
    folder.write("city_SE3_egovehicle.feather",
                 arrow_file({poses.after(numbers("timestamp_ns", stamps))}));
  }
  void write_mounts(const std::string& first, const std::string& second) const {
    PoseTable mounts;
    for (const RigidTransform& mount : {RigidTransform{}, kUp, kDown}) mounts.add(mount);
    folder.write("calibration/egovehicle_SE3_sensor.feather",
                 arrow_file({mounts.after(texts("sensor_name", {"camera", first, second}))}));
  }

  std::pair<PointCloud, LoadReport> load(LoadOptions options = {}) const {
    options.own_body_m = 0;
    options.driven_path_m = 0;
    ProgressSink quiet;
    return load_cloud(std::span(&folder.path(), 1), options, Executor(2), quiet);
  }

  TemporaryFolder folder;
  std::vector<Vec3d> world, origins;  ///< of the points
  std::vector<int> lasers;
  std::vector<std::size_t> sweep_ends;  ///< in `world`

 private:
  struct Sweep {
    std::vector<float> x, y, z;
    std::vector<std::uint8_t> intensity, laser;
    std::vector<std::int32_t> offset_ns;
  };

  void write_sweep(int k) {
    const std::int64_t stamp_ns = kFirst_ns + k * kSweep_ns;
    Sweep sweep;
    for (int column = 0; column < 180; ++column)
      for (int laser = 0; laser < 64; ++laser) add_point(stamp_ns, column, laser, sweep);
    folder.write(
        "sensors/lidar/" + std::to_string(stamp_ns) + ".feather",
        arrow_file({{numbers("x", sweep.x), numbers("y", sweep.y), numbers("z", sweep.z),
                     numbers("intensity", sweep.intensity), numbers("laser_number", sweep.laser),
                     numbers("offset_ns", sweep.offset_ns)}}));
  }

  void add_point(std::int64_t stamp_ns, int column, int laser, Sweep& sweep) {
    const std::int32_t offset_ns = 2'654'000 + 550'000 * column;
    const double azimuth = -2 * kDegree * column, elevation = kDegree * kElevations_deg[laser % 32];
    const Vec3d way = {std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
    std::uint16_t beam = 0;
    for (const double other_deg : kElevations_deg)
      if (other_deg > kElevations_deg[laser % 32]) ++beam;
    const RigidTransform unit = vehicle_at(stamp_ns + offset_ns) * (laser < 32 ? kUp : kDown);
    const Vec3d origin = unit * cones_.origin_of(beam, 20.0 * way);
    const auto range_m = range_in_court(origin, unit.rotation * way);
    if (!range_m) return;
    world.push_back(origin + *range_m * (unit.rotation * way));
    origins.push_back(origin);
    lasers.push_back(laser < 32 ? beam : 63 - beam);  // topmost first; down_lidar is upside down
    const Vec3f p = vec_cast<float>(vehicle_at(stamp_ns).inverse() * world.back());
    sweep.x.push_back(p.x), sweep.y.push_back(p.y), sweep.z.push_back(p.z);
    sweep.intensity.push_back(static_cast<std::uint8_t>(10 + laser));
    sweep.laser.push_back(static_cast<std::uint8_t>(laser));
    sweep.offset_ns.push_back(offset_ns);
  }

  SensorCones cones_;
};

TEST(Av2Drive, PointsInTheCityAndBeamsOfTwoLidars) {
  const Av2Court court;
  ASSERT_TRUE(is_av2_log(court.folder.path()));
  const auto [cloud, report] = court.load();
  ASSERT_EQ(cloud.size(), court.world.size());
  ASSERT_GT(cloud.size(), 20'000U);
  ASSERT_EQ(cloud.lasers.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT(length(cloud.world(i) - court.world[i]), 1e-4) << i;
    const Vec3d origin = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
    EXPECT_LT(length(origin - court.origins[i]), 2e-3) << i;
    EXPECT_EQ(cloud.lasers[i], court.lasers[i]) << i;
    EXPECT_GE(cloud.intensities[i], 10.0F / 255);
  }
  ASSERT_EQ(cloud.scan_poses.size(), 3U);
  EXPECT_NEAR(cloud.scan_poses[1].time_s, 315'966'265.359836, 1e-6);
  const RigidTransform second = Av2Court::vehicle_at(kFirst_ns + kSweep_ns);
  EXPECT_LT(length(cloud.scan_poses[1].world_from_sensor.translation - second.translation), 1e-6);
  EXPECT_NE(report.drives[0].facts.points_in.find("Argoverse 2"), std::string::npos);
}

// Annotators draw a box around the points of a sweep, whenever they were measured. Oracle: the
// points of each sweep in its own box.
TEST(Av2Drive, BoxesAreThoseOfTheSweepOfAPoint) {
  const Av2Court court;
  const Vec3d half_size = {1.5, 0.5, 1.5}, margin = {0.2, 0.2, 0.2};
  std::vector<std::int64_t> stamps;
  PoseTable boxes;
  std::size_t expected = 0, i = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3d middle = {3.0 * k, 12, 1.5};  // along a wall at 30 m/s
    stamps.push_back(kFirst_ns + k * kSweep_ns);
    boxes.add(Av2Court::vehicle_at(stamps.back()).inverse() * RigidTransform{{}, middle});
    for (const std::size_t end = court.sweep_ends[static_cast<std::size_t>(k)]; i < end; ++i) {
      const Vec3d away = court.world[i] - middle, reach = half_size + margin;
      expected += std::fabs(away.x) <= reach.x && std::fabs(away.y) <= reach.y &&
                  std::fabs(away.z) <= reach.z;
    }
  }
  std::vector<arrow_test::ArrowColumn> columns = boxes.after(numbers("timestamp_ns", stamps));
  const auto sides = [](double side) { return std::vector<double>(3, side); };
  columns.push_back(texts("track_uuid", {"a", "a", "a"}));
  columns.push_back(texts("category", {"BUS", "BUS", "BUS"}));
  columns.push_back(numbers("length_m", sides(2 * half_size.x)));
  columns.push_back(numbers("width_m", sides(2 * half_size.y)));
  columns.push_back(numbers("height_m", sides(2 * half_size.z)));
  court.folder.write("annotations.feather", arrow_file({columns}));
  LoadOptions options;
  options.boxes = court.folder.path();
  const auto [cloud, report] = court.load(options);
  ASSERT_GT(expected, 100U);
  EXPECT_EQ(report.in_boxes, expected);
  EXPECT_EQ(cloud.size() + expected, court.world.size());
}

// Oracle: the beams of one LiDAR among those that were cast, in their order.
TEST(Av2Drive, ATopicIsOneLidar) {
  const Av2Court court(2);
  LoadOptions options;
  options.topic = "down_lidar";
  const auto [cloud, report] = court.load(options);
  std::size_t i = 0;
  for (std::size_t k = 0; k < court.world.size(); ++k) {
    if (court.lasers[k] < 32) continue;
    ASSERT_LT(i, cloud.size());
    EXPECT_LT(length(cloud.world(i) - court.world[k]), 1e-4) << k;
    const Vec3d origin = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
    EXPECT_LT(length(origin - court.origins[k]), 2e-3) << k;
    EXPECT_EQ(cloud.lasers[i++], court.lasers[k] - 32) << k;
  }
  EXPECT_EQ(i, cloud.size());
  const RigidTransform second = Av2Court::vehicle_at(kFirst_ns + kSweep_ns) * kDown;
  EXPECT_LT(length(cloud.scan_poses[1].world_from_sensor.translation - second.translation), 1e-6);
  options.topic = "up_lidar";
  EXPECT_EQ(court.load(options).first.size(), court.world.size() - i);
  options.topic = "top";
  expect_error(ErrorKind::usage, {"no sensor 'top'", "up_lidar or down_lidar"},
               [&] { court.load(options); });
}

TEST(Av2Drive, IncompleteLogs) {
  const auto reject = [](ErrorKind kind, const std::vector<std::string>& parts,
                         const std::function<void(Av2Court&)>& change) {
    Av2Court court(2);
    change(court);
    expect_error(kind, parts, [&] { court.load(); });
  };
  const auto remove = [](const char* name) {
    return [name](Av2Court& court) { std::filesystem::remove_all(court.folder.path() / name); };
  };
  reject(ErrorKind::no_input, {"sensors/lidar", "no .feather sweeps"}, remove("sensors"));
  reject(ErrorKind::no_input, {"egovehicle_SE3_sensor.feather", "is missing"},
         remove("calibration"));
  reject(ErrorKind::no_input, {"city_SE3_egovehicle.feather", "is missing"},
         remove("city_SE3_egovehicle.feather"));
  const std::string second = "sensors/lidar/" + std::to_string(kFirst_ns + kSweep_ns) + ".feather";
  reject(ErrorKind::data, {"315966265359836000.feather", "no pose"},
         [](Av2Court& court) { court.write_poses(0); });
  reject(ErrorKind::data, {second, "no column of numbers 'laser_number'"}, [&](Av2Court& court) {
    const std::vector<float> one = {1};
    court.folder.write(second, arrow_file({{numbers("x", one), numbers("y", one), numbers("z", one),
                                            numbers("intensity", one)}}));
  });
}

TEST(Av2Drive, WrongValues) {
  Av2Court court(2);
  const std::string second = "sensors/lidar/" + std::to_string(kFirst_ns + kSweep_ns) + ".feather";
  const auto write_point = [&](std::uint8_t laser, std::int32_t offset_ns) {
    const std::vector<float> far = {9};
    court.folder.write(second,
                       arrow_file({{numbers("x", far), numbers("y", far), numbers("z", far),
                                    numbers("intensity", far),
                                    numbers("laser_number", std::vector<std::uint8_t>{laser}),
                                    numbers("offset_ns", std::vector<std::int32_t>{offset_ns})}}));
  };
  write_point(64, 0);
  expect_error(ErrorKind::data, {second, "laser_number of point 0", "64", "0 to 63"},
               [&] { court.load(); });
  write_point(1, 2'000'000'000);
  expect_error(ErrorKind::data, {second, "offset_ns of point 0"}, [&] { court.load(); });
  LoadOptions options;
  options.mount = Vec3d{1, 2, 3};
  expect_error(ErrorKind::usage, {"`mount`"}, [&] { court.load(options); });
}

TEST(Av2Drive, MountsOfAnotherLog) {
  const Av2Court court(2);
  court.write_mounts("down_lidar", "up_lidar");
  expect_error(ErrorKind::data, {"deg (median) from the beams", "egovehicle_SE3_sensor.feather"},
               [&] { court.load(); });
  court.write_mounts("up_lidar", "other");
  expect_error(ErrorKind::data, {"'down_lidar'"}, [&] { court.load(); });
}

}  // namespace
}  // namespace adasplats
