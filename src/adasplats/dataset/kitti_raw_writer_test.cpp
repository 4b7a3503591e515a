// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/kitti_raw_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/dataset/oxts_records.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

constexpr const char* kDrive = "2011_09_26/2011_09_26_drive_0001_sync";

/// A scan of a drive on a circle of 50 m, 10 m/s, far from the world's origin.
Scan scan_on_circle(std::size_t index) {
  Scan scan = scan_number(index, 40);
  const double angle = 0.02 * static_cast<double>(index);
  scan.time_s = 1317042145.9643 + 0.1 * static_cast<double>(index);
  scan.world_from_sensor = {
      rotation_from_yaw_pitch_roll(angle + std::numbers::pi / 2, 0.1 * std::sin(angle), -0.05),
      {448262 + 50 * std::cos(angle), 5411932 + 50 * std::sin(angle), 116 + angle}};
  return scan;
}

void write_circle(const std::filesystem::path& folder, std::size_t scans) {
  ScanWriterOptions options;
  options.drive = {scans, [](std::size_t i) { return scan_on_circle(i).time_s; }};
  const auto writer = make_scan_writer(folder, ScanFormat::kitti_raw, options);
  for (std::size_t i = 0; i < scans; ++i) writer->write(i, scan_on_circle(i));
  writer->finish();
}

std::vector<double> numbers_in(const std::filesystem::path& file) {
  std::istringstream text(read_file(file));
  std::vector<double> values;
  for (double value = 0; text >> value;) values.push_back(value);
  return values;
}

// Oracle: the poses and points that were written, by the reader of such drives.
TEST(KittiRawWriter, DriveIsReadBack) {
  const TemporaryFolder folder;
  write_circle(folder.path(), 12);
  const KittiSequence drive = open_kitti_raw_drive(folder.path() / kDrive);
  ASSERT_EQ(drive.scans.size(), 12U);
  const Vec3d first = scan_on_circle(0).world_from_sensor.translation;
  for (std::size_t i = 0; i < 12; ++i) {
    const Scan scan = scan_on_circle(i);
    const RigidTransform read = drive.trajectory[i].world_from_sensor;
    EXPECT_NEAR(drive.trajectory[i].time_s, scan.time_s, 1e-6);
    EXPECT_LT(length(read.translation - (scan.world_from_sensor.translation - first)), 1e-6) << i;
    EXPECT_LT(angle_between(read.rotation, scan.world_from_sensor.rotation), 1e-9) << i;
    const Scan expected = reordered(scan, kitti_order(scan));
    const KittiScan points = read_kitti_scan(drive, i);
    EXPECT_EQ(points.positions, expected.positions);
    EXPECT_EQ(points.intensities, expected.intensities);
  }
  const Trajectory poses = read_trajectory(folder.path() / "poses.csv");
  EXPECT_LT(length(poses[3].world_from_sensor.translation -
                   scan_on_circle(3).world_from_sensor.translation),
            1e-6);
}

// Oracle: the motion on a circle: 10 m/s, inwards 2 m/s^2, 0.2 rad/s; differences over 0.2 s lose
// less than a hundredth of it.
TEST(KittiRawWriter, RecordsDescribeTheMotion) {
  const TemporaryFolder folder;
  write_circle(folder.path(), 9);
  const auto record = numbers_in(folder.path() / kDrive / "oxts/data/0000000004.txt");
  ASSERT_EQ(record.size(), 30U);
  EXPECT_NEAR(record[0], 49, 1e-3);
  EXPECT_NEAR(record[1], 8.4, 1e-3);
  const double angle = 0.08;
  const double imu_speed = std::hypot(record[6], record[7]);
  EXPECT_NEAR(imu_speed, 10, 0.15);  // the unit sits 0.8 m from the LiDAR
  EXPECT_NEAR(std::atan2(record[6], record[7]), angle + std::numbers::pi / 2, 0.02);
  EXPECT_NEAR(record[8], imu_speed, 0.02);
  EXPECT_NEAR(record[15], 2, 0.06);
  EXPECT_NEAR(record[16], 9.81, 0.02);
  EXPECT_NEAR(record[22], 0.2, 1e-3);
}

// Oracle: dates of `date -u`.
TEST(KittiRawWriter, DatesAndTimes) {
  EXPECT_EQ(date_and_time(1317042145.25, ""), "2011-09-26 13:02:25.250000000");
  EXPECT_EQ(date_and_time(0, ""), "1970-01-01 00:00:00.000000000");
  EXPECT_EQ(date_and_time(-0.5, ""), "1969-12-31 23:59:59.500000000");
  EXPECT_EQ(date_and_time(951782399.9999999999, ""), "2000-02-29 00:00:00.000000000");
  for (const double time_s : {1317042145964389445.0, -1e12, std::nan("")})
    expect_error(ErrorKind::data, {"x: the time", "expected seconds since 1970"},
                 [&] { date_and_time(time_s, "x"); });
}

// Oracle: what the devkit's readme lists.
TEST(KittiRawWriter, HasTheFilesThatLoadersNeed) {
  const TemporaryFolder folder;
  write_circle(folder.path(), 1);
  for (const char* name : {"velodyne_points/timestamps.txt", "oxts/timestamps.txt",
                           "oxts/dataformat.txt", "../calib_velo_to_cam.txt"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / kDrive / name)) << name;
  const std::string format = read_file(folder.path() / kDrive / "oxts/dataformat.txt");
  EXPECT_EQ(std::count(format.begin(), format.end(), '\n'), 30);
  const std::string cameras = read_file(folder.path() / "2011_09_26/calib_cam_to_cam.txt");
  for (const char* key : {"P_rect_00: ", "P_rect_03: ", "R_rect_00: ", "S_rect_02: "})
    EXPECT_NE(cameras.find(key), std::string::npos) << key;
}

}  // namespace
}  // namespace adasplats
