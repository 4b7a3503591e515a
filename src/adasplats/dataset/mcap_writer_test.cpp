// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/mcap_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/dataset/ros_cloud_test.h"
#include "adasplats/dataset/ros_messages.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/mcap/mcap_records_test.h"

namespace adasplats {
namespace {

using ros_test::CdrReader;
using ros_test::Cloud;

/// A cloud of our own layout.
Cloud cloud_of(std::string_view message) {
  Cloud cloud = ros_test::cloud_of(message);
  EXPECT_EQ(cloud.frame, "lidar");
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_TRUE(cloud.is_dense);
  return cloud;
}

struct Transform {
  std::uint64_t time_ns;
  std::string frame, child;
  RigidTransform frame_from_child;
};

std::vector<Transform> transforms_of(std::string_view message) {
  CdrReader reader(message);
  std::vector<Transform> transforms(reader.number<std::uint32_t>());
  for (Transform& transform : transforms) {
    transform.time_ns = reader.time_ns();
    transform.frame = reader.text();
    transform.child = reader.text();
    double v[7];
    for (double& value : v) value = reader.number<double>();
    EXPECT_NEAR(std::hypot(v[3], v[4], std::hypot(v[5], v[6])), 1, 1e-12);
    transform.frame_from_child = {rotation_from_quaternion(v[6], v[3], v[4], v[5]),
                                  {v[0], v[1], v[2]}};
  }
  EXPECT_TRUE(reader.at_end());
  return transforms;
}

mcap_test::File written(const std::vector<Scan>& scans, const McapOptions& options = {}) {
  const TemporaryFolder folder;
  McapWriter writer(folder.path() / "scans.mcap", options);
  for (const Scan& scan : scans) writer.write(scan);
  writer.finish();
  return mcap_test::read(read_file(folder.path() / "scans.mcap"));
}

/// With the 64 bits that x86 has for it.
std::uint64_t exact_ns(double time_s) {
  return static_cast<std::uint64_t>(std::llround(static_cast<long double>(time_s) * 1e9L));
}

void expect_same(const Cloud& cloud, const Scan& scan) {
  EXPECT_EQ(cloud.time_ns, exact_ns(scan.time_s - 0.5 * scan.duration_s));
  ASSERT_EQ(cloud.points, scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec3f p{cloud.at<float>(i, "x"), cloud.at<float>(i, "y"), cloud.at<float>(i, "z")};
    ASSERT_EQ(p, scan.positions[i]);
    ASSERT_EQ(cloud.at<float>(i, "intensity"), scan.intensities[i]);
    ASSERT_EQ(cloud.at<float>(i, "time"), scan.times_s[i]);
    ASSERT_EQ(cloud.at<std::uint16_t>(i, "label"), scan.classes[i]);
    ASSERT_EQ(cloud.at<std::uint16_t>(i, "instance"), scan.instances[i]);
    ASSERT_EQ(cloud.at<std::uint16_t>(i, "ring"), scan.rings[i]);
    ASSERT_EQ(cloud.at<std::uint8_t>(i, "return_index"), scan.return_indices[i]);
  }
}

void expect_pose(const Transform& transform, const RigidTransform& pose) {
  // World coordinates of UTM keep every bit.
  EXPECT_EQ(transform.frame_from_child.translation, pose.translation);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(transform.frame_from_child.rotation.rows[r][c], pose.rotation.rows[r][c], 1e-14);
}

/// Of scans whose three knots last a tenth of a second around their pose.
void expect_same(const std::vector<Transform>& transforms, const Scan& scan) {
  ASSERT_EQ(transforms.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(transforms[k].frame + " " + transforms[k].child, "map lidar");
    EXPECT_NEAR(1e-9 * static_cast<double>(transforms[k].time_ns),
                scan.time_s - 0.05 + 0.05 * static_cast<double>(k), 1e-6);
    expect_pose(transforms[k], scan.knots[k]);
  }
}

// Oracle: the scans, taken out of the file by the specifications of MCAP and CDR.
TEST(McapWriter, RoundTrip) {
  std::vector<Scan> scans;
  for (const std::size_t points : {1000UL, 1UL, 180'000UL, 3UL}) {
    scans.push_back(scan_number(scans.size(), points));
    Scan& scan = scans.back();
    scan.time_s += 1.7e9;
    for (std::size_t i = 0; i < points; ++i)
      scan.return_indices.push_back(static_cast<std::uint8_t>(i % 3));
  }
  const mcap_test::File file = written(scans);
  EXPECT_EQ(file.topics, (std::vector<std::string>{"/tf", "/points"}));
  EXPECT_EQ(file.schema_names.at(1), "sensor_msgs/msg/PointCloud2");
  EXPECT_EQ(file.chunks, 2U);
  ASSERT_EQ(file.messages.size(), 2 * scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(file.messages[2 * i].channel, 0);
    expect_same(transforms_of(file.messages[2 * i].data), scans[i]);
    const Cloud cloud = cloud_of(file.messages[2 * i + 1].data);
    EXPECT_EQ(file.messages[2 * i + 1].time_ns, cloud.time_ns);
    expect_same(cloud, scans[i]);
  }
}

// Oracle: by hand. The frame of the points is that of the pose.
TEST(McapWriter, PointsWithoutMotionHaveTheTimeOfThePose) {
  Scan scan = scan_number(3, 5);
  scan.frame = PointFrame::deskewed;
  scan.knots.erase(scan.knots.begin() + 1);  // none is that of the pose
  const mcap_test::File file = written({scan});
  const Cloud cloud = cloud_of(file.messages.back().data);
  EXPECT_EQ(cloud.time_ns, exact_ns(scan.time_s));
  EXPECT_NEAR(static_cast<double>(cloud.at<float>(2, "time")), 0.002 - 0.05, 1e-8);
  const std::vector<Transform> transforms = transforms_of(file.messages.front().data);
  ASSERT_EQ(transforms.size(), 3U);
  EXPECT_EQ(transforms[1].time_ns, cloud.time_ns);
  expect_pose(transforms[1], scan.world_from_sensor);
}

TEST(McapWriter, ScansOfASensorAtRestHaveNoTimes) {
  Scan scan = scan_number(3, 5);
  scan.knots.clear();
  scan.duration_s = 0;
  const mcap_test::File file = written({scan});
  const Cloud cloud = cloud_of(file.messages.back().data);
  EXPECT_EQ(cloud.time_ns, exact_ns(scan.time_s));
  EXPECT_FALSE(cloud.fields.contains("time"));
  EXPECT_TRUE(cloud.fields.contains("ring"));
  ASSERT_EQ(transforms_of(file.messages.front().data).size(), 1U);
  expect_pose(transforms_of(file.messages.front().data).front(), scan.world_from_sensor);
}

TEST(McapWriter, FieldsAreAlignedAndTyped) {
  Scan scan = scan_number(3, 2);
  scan.return_indices = {0, 1};
  const Cloud cloud = cloud_of(point_cloud2_message(scan, "lidar"));
  using ros_test::kF32, ros_test::kU16, ros_test::kU8;
  const std::map<std::uint8_t, std::uint32_t> bytes = {{kU8, 1}, {kU16, 2}, {kF32, 4}};
  EXPECT_EQ(cloud.fields.at("x").offset, 0U);
  EXPECT_EQ(cloud.fields.at("z").offset, 8U);
  EXPECT_EQ(cloud.fields.at("time").type, kF32);
  EXPECT_EQ(cloud.fields.at("ring").type, kU16);
  EXPECT_EQ(cloud.fields.at("return_index").type, kU8);
  EXPECT_EQ(cloud.step % 4, 0U);
  for (const auto& [name, field] : cloud.fields) EXPECT_EQ(field.offset % bytes.at(field.type), 0U);
}

// Oracle: by hand. A sensor that looks left, 2 m above the vehicle; the axes of Hesai's driver are
// x right, y forward.
TEST(McapWriter, TheFrameOfAMountedSensorIsStaticInTheVehicle) {
  const Scan scan = scan_number(3, 5);
  const Mat3d left = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
  McapOptions options;
  options.mount = {left, {0, 0, 2}};
  const LidarModel sensor = load_lidar_model("hesai-pandar64");
  for (const bool is_hesai : {false, true}) {
    SCOPED_TRACE(is_hesai);
    if (is_hesai) options.driver = CloudDriver::hesai;
    options.sensor.sensor = &sensor;
    const mcap_test::File file = written({scan, scan}, options);
    EXPECT_EQ(file.topics, (std::vector<std::string>{"/tf", is_hesai ? "/lidar_points" : "/points",
                                                     "/tf_static"}));
    ASSERT_EQ(file.messages.size(), 5U) << "one for /tf_static";
    const std::vector<Transform> fixed = transforms_of(file.messages[0].data);
    EXPECT_EQ(fixed.front().frame, "base_link");
    EXPECT_EQ(fixed.front().child, is_hesai ? "hesai_lidar" : "lidar");
    EXPECT_EQ(ros_test::cloud_of(file.messages[2].data).frame, fixed.front().child);
    expect_pose(fixed.front(), {is_hesai ? Mat3d{} : left, {0, 0, 2}});
    const Transform moving = transforms_of(file.messages[1].data)[1];
    EXPECT_EQ(moving.frame + " " + moving.child, "map base_link");
    const RigidTransform again = moving.frame_from_child * options.mount;
    EXPECT_LT(length(again.translation - scan.knots[1].translation), 1e-8);
    EXPECT_LT(angle_between(again.rotation, scan.knots[1].rotation), 1e-7);
  }
}

TEST(McapWriter, EmptyScanAndPositionsAlone) {
  Scan bare;
  bare.positions = {{1, 2, 3}};
  const mcap_test::File file = written({Scan{}, bare});
  ASSERT_EQ(file.messages.size(), 4U);
  EXPECT_EQ(cloud_of(file.messages[1].data).points, 0U);
  const Cloud cloud = cloud_of(file.messages[3].data);
  EXPECT_EQ(cloud.fields.size(), 3U);
  EXPECT_EQ(cloud.at<float>(0, "z"), 3.0F);
  EXPECT_EQ(written({}).messages.size(), 0U);
}

TEST(McapWriter, RejectsTimesOutsideTheRosRange) {
  EXPECT_EQ(ros_time_ns(0), 0U);
  EXPECT_EQ(ros_time_ns(1.9999999999), 2'000'000'000U);
  EXPECT_EQ(ros_time_ns(1'700'000'000.5), 1'700'000'000'500'000'000U);
  EXPECT_EQ(ros_time_ns(2147483647.5), 2'147'483'647'500'000'000U);
  for (const double time_s : {-1e-6, 2147483648.0, std::numeric_limits<double>::quiet_NaN()}) {
    const TemporaryFolder folder;
    McapWriter writer(folder.path() / "scans.mcap");
    Scan scan = scan_number(0, 1);
    scan.time_s = time_s;
    scan.knots.clear();
    scan.duration_s = 0;
    expect_error(ErrorKind::data, {"0 to 2147483647 s"}, [&] { writer.write(scan); });
  }
}

TEST(McapWriter, Definitions) {
  for (const std::string& text : {point_cloud2_definition(), transforms_definition()}) {
    EXPECT_NE(text.find("\n" + std::string(80, '=') + "\nMSG: std_msgs/Header\n"),
              std::string::npos);
    EXPECT_EQ(text.back(), '\n');
  }
}

}  // namespace
}  // namespace adasplats
