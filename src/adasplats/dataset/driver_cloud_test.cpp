// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/driver_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/ros_cloud_test.h"

namespace adasplats {
namespace {

using ros_test::Cloud;
using ros_test::kF32;
using ros_test::kF64;
using ros_test::kU16;
using ros_test::kU32;
using ros_test::kU8;

/// Two beams, four columns clockwise from the front; the upper beam points a column later.
LidarModel small_sensor() {
  LidarModel sensor;
  sensor.name = "small";
  sensor.elevations_rad = {0.2, -0.2};
  sensor.azimuth_offsets_rad = {-0.5 * std::numbers::pi, 0};
  sensor.beam_origins_m = {{0.25, 0, 0.5}, {0.25, 0, 0.5}};
  sensor.firing_times_s = {1.0 / 128, 0};
  sensor.columns = 4;
  sensor.rotation_hz = 2;
  sensor.clockwise = true;
  return sensor;
}

/// The upper beam in column 1, the lower in columns 0 and 3; 0.5 s from 19.75 s on; all times are
/// exact.
Scan small_scan() {
  Scan scan;
  scan.time_s = 20;
  scan.duration_s = 0.5;
  scan.knots = {RigidTransform{}, RigidTransform{}};
  scan.rings = {0, 1, 1};
  scan.columns = {1, 0, 3};
  scan.positions = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  scan.ranges_m = {3.75F, 8, 13};
  scan.intensities = {0.5F, 2, std::numeric_limits<float>::quiet_NaN()};
  scan.times_s = {0.1328125F, 0, 0.375F};
  return scan;
}

PacketOptions options_of(const LidarModel& sensor) {
  PacketOptions options;
  options.sensor = &sensor;
  return options;
}

Cloud cloud_of(CloudDriver driver, const Scan& scan, PacketOptions options = {}) {
  const LidarModel sensor = small_sensor();
  options.sensor = &sensor;
  return ros_test::cloud_of(DriverClouds(driver, options).message(scan, "top", 0.5));
}

void expect_fields(const Cloud& cloud,
                   const std::map<std::string, std::pair<std::uint32_t, std::uint8_t>>& fields) {
  EXPECT_EQ(cloud.fields.size(), fields.size());
  for (const auto& [name, place] : fields) {
    ASSERT_TRUE(cloud.fields.contains(name)) << name;
    EXPECT_EQ(cloud.fields.at(name).offset, place.first) << name;
    EXPECT_EQ(cloud.fields.at(name).type, place.second) << name;
  }
}

Vec3f position_of(const Cloud& cloud, std::size_t i) {
  return {cloud.at<float>(i, "x"), cloud.at<float>(i, "y"), cloud.at<float>(i, "z")};
}

// Oracles of all layouts: by hand from the sources of the drivers (docs/exports.md).
TEST(DriverCloud, Velodyne) {
  const Cloud cloud = cloud_of(CloudDriver::velodyne, small_scan());
  EXPECT_EQ(cloud.frame, "top");
  EXPECT_EQ(cloud.time_ns, 20'250'000'000U);
  EXPECT_EQ(cloud.step, 22U);
  EXPECT_EQ(cloud.height, 4U) << "columns";
  EXPECT_EQ(cloud.width, 2U) << "rings";
  EXPECT_FALSE(cloud.is_dense);
  expect_fields(cloud, {{"x", {0, kF32}},
                        {"y", {4, kF32}},
                        {"z", {8, kF32}},
                        {"intensity", {12, kF32}},
                        {"ring", {16, kU16}},
                        {"time", {18, kF32}}});
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(cloud.at<std::uint16_t>(i, "ring"), i % 2) << "from the lowest";
    EXPECT_FLOAT_EQ(cloud.at<float>(i, "time"),
                    0.125F * static_cast<float>(i / 2) + (i % 2 == 1 ? 0.0078125F : 0.0F));
    const bool is_return = i == 0 || i == 3 || i == 6;
    EXPECT_EQ(std::isnan(cloud.at<float>(i, "x")), !is_return) << i;
    EXPECT_EQ(std::isnan(cloud.at<float>(i, "intensity")), !is_return) << i;
  }
  EXPECT_EQ(position_of(cloud, 0), (Vec3f{4, 5, 6}));
  EXPECT_EQ(position_of(cloud, 3), (Vec3f{1, 2, 3}));
  EXPECT_EQ(position_of(cloud, 6), (Vec3f{7, 8, 9}));
  EXPECT_EQ(cloud.at<float>(0, "intensity"), 255) << "at most";
  EXPECT_EQ(cloud.at<float>(3, "intensity"), 128);
  EXPECT_EQ(cloud.at<float>(6, "intensity"), 0) << "unknown";
}

TEST(DriverCloud, Ouster) {
  const Cloud cloud = cloud_of(CloudDriver::ouster, small_scan());
  EXPECT_EQ(cloud.step, 48U);
  EXPECT_EQ(cloud.height, 2U) << "rings";
  EXPECT_EQ(cloud.width, 4U) << "columns";
  EXPECT_FALSE(cloud.is_dense);
  expect_fields(cloud, {{"x", {0, kF32}},
                        {"y", {4, kF32}},
                        {"z", {8, kF32}},
                        {"intensity", {16, kF32}},
                        {"t", {20, kU32}},
                        {"reflectivity", {24, kU16}},
                        {"ring", {26, kU16}},
                        {"ambient", {28, kU16}},
                        {"range", {32, kU32}}});
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(cloud.at<std::uint16_t>(i, "ring"), i / 4) << "from the topmost";
    EXPECT_EQ(std::isnan(cloud.at<float>(i, "x")), i != 2 && i != 4 && i != 7) << i;
  }
  // The upper beam of column 1 points where the lower one of column 2 does.
  EXPECT_EQ(position_of(cloud, 2), (Vec3f{-1, -2, 2.5F}))
      << "x to the back, from the beams' height";
  EXPECT_EQ(cloud.at<std::uint32_t>(2, "t"), 132'812'500U);
  EXPECT_EQ(cloud.at<std::uint32_t>(2, "range"), 4000U) << "from the axis";
  EXPECT_EQ(cloud.at<float>(2, "intensity"), 128);
  EXPECT_EQ(cloud.at<std::uint16_t>(2, "reflectivity"), 128);
  EXPECT_EQ(position_of(cloud, 4), (Vec3f{-4, -5, 5.5F}));
  EXPECT_EQ(cloud.at<std::uint32_t>(3, "range"), 0U);
  EXPECT_EQ(cloud.at<std::uint32_t>(3, "t"), 257'812'500U) << "without return";
}

TEST(DriverCloud, Hesai) {
  const Cloud cloud = cloud_of(CloudDriver::hesai, small_scan());
  EXPECT_EQ(cloud.step, 26U);
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(cloud.width, 8U);
  EXPECT_FALSE(cloud.is_dense);
  expect_fields(cloud, {{"x", {0, kF32}},
                        {"y", {4, kF32}},
                        {"z", {8, kF32}},
                        {"intensity", {12, kF32}},
                        {"ring", {16, kU16}},
                        {"timestamp", {18, kF64}}});
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(cloud.at<std::uint16_t>(i, "ring"), i % 2);
  EXPECT_EQ(position_of(cloud, 1), (Vec3f{-5, 4, 6})) << "x right, y forward";
  EXPECT_EQ(position_of(cloud, 2), (Vec3f{-2, 1, 3}));
  EXPECT_EQ(position_of(cloud, 3), (Vec3f{0, 0, 0})) << "without return";
  EXPECT_EQ(cloud.at<double>(2, "timestamp"), 20.3828125);
  EXPECT_EQ(cloud.at<double>(3, "timestamp"), 20.375);
}

TEST(DriverCloud, Nebula) {
  PacketOptions options;
  options.mode = ReturnMode::last;
  const Cloud cloud = cloud_of(CloudDriver::nebula, small_scan(), options);
  EXPECT_EQ(cloud.step, 32U);
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(cloud.width, 3U);
  EXPECT_TRUE(cloud.is_dense);
  expect_fields(cloud, {{"x", {0, kF32}},
                        {"y", {4, kF32}},
                        {"z", {8, kF32}},
                        {"intensity", {12, kU8}},
                        {"return_type", {13, kU8}},
                        {"channel", {14, kU16}},
                        {"azimuth", {16, kF32}},
                        {"elevation", {20, kF32}},
                        {"distance", {24, kF32}},
                        {"time_stamp", {28, kU32}}});
  EXPECT_EQ(position_of(cloud, 0), (Vec3f{-5, 4, 6}));
  EXPECT_EQ(position_of(cloud, 1), (Vec3f{-2, 1, 3}));
  EXPECT_EQ(cloud.at<std::uint16_t>(1, "channel"), 0);
  EXPECT_EQ(cloud.at<std::uint8_t>(1, "intensity"), 128);
  EXPECT_EQ(cloud.at<std::uint8_t>(1, "return_type"), 1) << "last";
  EXPECT_FLOAT_EQ(cloud.at<float>(1, "distance"), std::sqrt(14.0F));
  // x = d cos(e) sin(a), y = d cos(e) cos(a), as Nebula computes them.
  const float azimuth = cloud.at<float>(1, "azimuth"), flat = std::sqrt(5.0F);
  EXPECT_NEAR(flat * std::sin(azimuth), -2, 1e-6);
  EXPECT_NEAR(flat * std::cos(azimuth), 1, 1e-6);
  EXPECT_GE(azimuth, 0);
  EXPECT_FLOAT_EQ(std::tan(cloud.at<float>(1, "elevation")), 3 / flat);
  EXPECT_EQ(cloud.at<std::uint32_t>(1, "time_stamp"), 132'812'500U);
}

TEST(DriverCloud, SecondReturnsAreRowsAndBlocks) {
  Scan scan = small_scan();
  scan.rings = {1, 1, 1};
  scan.columns = {0, 0, 3};
  scan.return_indices = {0, 1, 1};  // the first of column 3 was dropped
  PacketOptions options;
  options.returns = 2;
  const Cloud rows = cloud_of(CloudDriver::velodyne, scan, options);
  EXPECT_EQ(rows.height, 8U);
  EXPECT_EQ(position_of(rows, 0), (Vec3f{1, 2, 3}));
  EXPECT_EQ(position_of(rows, 2), (Vec3f{4, 5, 6}));
  EXPECT_EQ(position_of(rows, 14), (Vec3f{7, 8, 9}));
  const Cloud blocks = cloud_of(CloudDriver::hesai, scan, options);
  EXPECT_EQ(blocks.width, 16U);
  EXPECT_EQ(position_of(blocks, 3), (Vec3f{-5, 4, 6}));
  EXPECT_EQ(cloud_of(CloudDriver::nebula, scan, options).at<std::uint8_t>(1, "return_type"), 7);
}

TEST(DriverCloud, ASensorAtRestHasTimesOfZero) {
  Scan scan = small_scan();
  scan.knots.clear();
  scan.duration_s = 0;
  const Cloud velodyne = cloud_of(CloudDriver::velodyne, scan);
  const Cloud hesai = cloud_of(CloudDriver::hesai, scan);
  EXPECT_EQ(velodyne.time_ns, 20'500'000'000U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(velodyne.at<float>(i, "time"), 0);
    EXPECT_EQ(hesai.at<double>(i, "timestamp"), 20.5);
  }
}

TEST(DriverCloud, ColumnsOutsideTheWindowAreNotSent) {
  LidarModel sensor = small_sensor();
  sensor.window_begin = 0.5;
  Scan scan = small_scan();
  scan.rings = {0, 1, 1};
  scan.columns = {2, 2, 3};
  const auto message = [&](CloudDriver driver) {
    return ros_test::cloud_of(DriverClouds(driver, options_of(sensor)).message(scan, "top", 0));
  };
  EXPECT_EQ(message(CloudDriver::velodyne).height, 2U);
  EXPECT_EQ(message(CloudDriver::hesai).width, 4U);
  const Cloud image = message(CloudDriver::ouster);
  EXPECT_EQ(image.width, 4U) << "images are complete";
  EXPECT_EQ(image.at<std::uint32_t>(4, "t"), 0U);
}

TEST(DriverCloud, RejectsWhatItCannotWrite) {
  const auto reject = [](CloudDriver driver, const PacketOptions& options, const char* because) {
    expect_error(ErrorKind::usage, {because, options.sensor->name.c_str()},
                 [&] { require_driver(driver, options); });
  };
  for (const char* const name : {"livox-mid-40"}) {
    const LidarModel rosette = load_lidar_model(name);
    for (const auto& [word, driver] : kCloudDrivers)
      if (driver != CloudDriver::adasplats) reject(driver, options_of(rosette), "column by column");
    require_driver(CloudDriver::adasplats, options_of(rosette));
  }
  LidarModel sensor = small_sensor();
  PacketOptions options = options_of(sensor);
  options.is_raw = false;
  reject(CloudDriver::velodyne, options, "--points raw");
  options.is_raw = true;
  options.returns = 2;
  reject(CloudDriver::ouster, options, "--returns 1");
  require_driver(CloudDriver::hesai, options);
  options.returns = 1;
  sensor.rotation_hz = 0.2;
  reject(CloudDriver::ouster, options, "4.29 s");
  reject(CloudDriver::nebula, options, "4.29 s");
  require_driver(CloudDriver::velodyne, options);
}

}  // namespace
}  // namespace adasplats
