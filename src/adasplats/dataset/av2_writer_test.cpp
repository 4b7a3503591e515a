// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/av2_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "adasplats/cloud/load/av2_tables.h"
#include "adasplats/cloud/load/box_files.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/driver_order.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

constexpr const char* kLogFolder = "train/00000000-0000-0000-0000-000000000001";

std::unique_ptr<ScanWriter> av2_writer_of(const std::filesystem::path& folder,
                                          std::vector<double> times_s,
                                          ScanWriterOptions options = {}) {
  options.labels = &semantickitti_labels();
  options.drive.times_s = std::move(times_s);
  return make_scan_writer(folder, ScanFormat::argoverse2, options);
}

template <class T>
const std::vector<T>& values_in(const ArrowTable& table, std::string_view name) {
  const Column* const column = table.numbers.find(name);
  if (column == nullptr) throw std::runtime_error("no column " + std::string(name));
  return std::get<std::vector<T>>(column->values);
}

// Oracle: the scan, with the types and the meaning of the columns in av2-api's Sweep: points in the
// frame of the vehicle at the stamp, whenever they were measured.
TEST(Av2Writer, SweepsAndPoses) {
  const TemporaryFolder folder;
  const Scan scan = scan_number(2, 130);
  const auto writer = av2_writer_of(folder.path(), {scan.time_s, 1'700'000'000.25});
  Scan bright = scan_number(3, 2);
  bright.time_s = 1'700'000'000.25;
  bright.intensities = {std::nanf(""), 3};
  writer->write(0, scan);
  writer->write(1, bright);
  writer->finish();
  const auto log = folder.path() / kLogFolder;
  EXPECT_EQ(writer->main_file(1),
            std::string(kLogFolder) + "/sensors/lidar/1700000000250000000.feather");
  const ArrowTable sweep = read_arrow_file(log / "sensors/lidar/533333333.feather");
  ASSERT_EQ(sweep.numbers.rows, 130U);
  const auto& x = values_in<float>(sweep, "x");
  const auto& y = values_in<float>(sweep, "y");
  const auto& z = values_in<float>(sweep, "z");
  const auto& intensities = values_in<std::uint8_t>(sweep, "intensity");
  const auto& lasers = values_in<std::uint8_t>(sweep, "laser_number");
  const auto& offsets_ns = values_in<std::int32_t>(sweep, "offset_ns");
  const Av2Poses poses = read_av2_poses(log);
  ASSERT_EQ(poses.by_stamp_ns.size(), 2U);
  const auto mounts_file = log / "calibration/egovehicle_SE3_sensor.feather";
  const ArrowTable mounts = read_arrow_file(mounts_file);
  EXPECT_EQ(mounts.texts.at("sensor_name"), (std::vector<std::string>{"up_lidar", "down_lidar"}));
  const RigidTransform mount = av2_poses_of_rows(mounts_file, mounts)[0];
  const RigidTransform vehicle = poses.by_stamp_ns.at(533'333'333);
  const RigidTransform lidar = vehicle * mount;
  EXPECT_LT(length(lidar.translation - scan.world_from_sensor.translation), 1e-8);
  EXPECT_LT(angle_between(lidar.rotation, scan.world_from_sensor.rotation), 1e-7);
  const auto order = driver_order(scan, FirstRing::top);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t i = order[k];
    const Vec3d world = vehicle * Vec3d{x[k], y[k], z[k]};
    EXPECT_LT(length(world - world_point_of(scan, i)), 2e-5);
    EXPECT_EQ(intensities[k], std::lround(255 * scan.intensities[i]));
    EXPECT_EQ(lasers[k], scan.rings[i]);
    EXPECT_NEAR(offsets_ns[k], 1e9 * (double{scan.times_s[i]} - 0.05), 20);
  }
  const ArrowTable second = read_arrow_file(folder.path() / writer->main_file(1));
  EXPECT_EQ(values_in<std::uint8_t>(second, "intensity"), (std::vector<std::uint8_t>{0, 255}));
  EXPECT_FALSE(std::filesystem::exists(log / "annotations.feather"));
}

// Oracle: by hand: a car 10 m ahead of the LiDAR, which looks north, turned left by a quarter.
TEST(Av2Writer, Annotations) {
  const TemporaryFolder folder;
  Scan scan = scan_number(0, 1);
  const Mat3d north = rotation_from_yaw_pitch_roll(std::numbers::pi / 2, 0, 0);
  scan.world_from_sensor = {north, {100, 200, 2}};
  scan.knots.clear();
  scan.positions[0] = {10, 0.5, -1};
  scan.time_s = 3;
  ScanWriterOptions options;
  options.boxes = [](std::size_t, double) {
    const Mat3d west = rotation_from_yaw_pitch_roll(std::numbers::pi, 0, 0);
    return std::vector<ObjectBox>{{10, 7, {west, {100, 210, 1}}, {4, 2, 1.5}},
                                  {30, 8, {west, {0, 0, 0}}, {4, 2, 1.5}}};  // without points
  };
  const auto writer = av2_writer_of(folder.path(), {3}, options);
  writer->write(0, scan);
  writer->finish();
  const auto file = folder.path() / kLogFolder / "annotations.feather";
  const ArrowTable table = read_arrow_file(file);
  ASSERT_EQ(table.numbers.rows, 1U);
  EXPECT_EQ(table.texts.at("category")[0], "REGULAR_VEHICLE");
  EXPECT_EQ(table.texts.at("track_uuid")[0].size(), 36U);
  EXPECT_EQ(values_in<std::int64_t>(table, "timestamp_ns")[0], 3'000'000'000);
  EXPECT_EQ(values_in<std::int64_t>(table, "num_interior_pts")[0], 1);
  EXPECT_EQ(values_in<double>(table, "length_m")[0], 4);
  EXPECT_EQ(values_in<double>(table, "width_m")[0], 2);
  EXPECT_EQ(values_in<double>(table, "height_m")[0], 1.5);
  EXPECT_NEAR(values_in<double>(table, "tx_m")[0], 10 + 1.35, 1e-9);
  EXPECT_NEAR(values_in<double>(table, "ty_m")[0], 0, 1e-9);
  EXPECT_NEAR(values_in<double>(table, "tz_m")[0], 1.64 - 1, 1e-9);
  EXPECT_NEAR(values_in<double>(table, "qz")[0] / values_in<double>(table, "qw")[0], 1, 1e-9);
  // An interrupted run goes on with the files of the scans alone.
  const std::string bytes = read_file(file);
  std::filesystem::remove(file);
  const auto resumed = av2_writer_of(folder.path(), {3}, options);
  resumed->keep(0, {3, scan.world_from_sensor});
  resumed->finish();
  EXPECT_EQ(read_file(file), bytes);
  const BoxContent boxes = read_box_file(file, {});
  ASSERT_EQ(boxes.at_rest.size() + boxes.moving.size(), 1U);
}

// A log needs times that nanoseconds distinguish, and lasers of 8 bits.
TEST(Av2Writer, WhatALogCannotHold) {
  const TemporaryFolder folder;
  const auto reject = [&](ErrorKind kind, const std::vector<std::string>& parts,
                          const std::vector<double>& times_s, ScanWriterOptions options = {}) {
    expect_error(kind, parts, [&] { av2_writer_of(folder.path(), times_s, options); });
  };
  reject(ErrorKind::data, {"scan 1", "-0.1 s", "between 0 and"}, {0, -0.1});
  reject(ErrorKind::data, {"scan 0", "nan"}, {std::nan("")});
  reject(ErrorKind::data, {"scan 0", "1e+10"}, {1e10});
  reject(ErrorKind::data, {"scan 2", "7.5 s", "that of scan 0"}, {7.5, 7.6, 7.5});
  ScanWriterOptions many;
  many.image_size.rings = 257;
  reject(ErrorKind::usage, {"257 rings"}, {0}, many);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  Scan slow = scan_number(0, 1);
  slow.times_s = {0};
  slow.duration_s = 2.5;
  expect_error(ErrorKind::data, {"-1.25 s", "at most 1 s"},
               [&] { av2_writer_of(folder.path(), {slow.time_s})->write(0, slow); });
}

}  // namespace
}  // namespace adasplats
