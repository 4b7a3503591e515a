// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/mcap_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/dataset/ros_messages.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/mcap/mcap_records_test.h"

namespace adasplats {
namespace {

/// CDR by the letter: every number at a multiple of its size behind the encapsulation.
class CdrReader {
 public:
  explicit CdrReader(std::string_view message) : reader_(message) {
    EXPECT_EQ(reader_.take(4), std::string_view("\0\1\0\0", 4));
  }
  template <class T>
  T number() {
    while ((reader_.place() - 4) % sizeof(T) != 0) EXPECT_EQ(reader_.number<char>(), 0);
    return reader_.number<T>();
  }
  std::string text() {
    std::string text(reader_.take(number<std::uint32_t>()));
    EXPECT_EQ(text.back(), '\0');
    text.pop_back();
    return text;
  }
  std::string_view bytes() { return reader_.take(number<std::uint32_t>()); }
  std::uint64_t time_ns() {
    const auto seconds = number<std::int32_t>();
    const auto nanoseconds = number<std::uint32_t>();
    return static_cast<std::uint64_t>(seconds) * 1'000'000'000 + nanoseconds;
  }
  bool at_end() const { return reader_.at_end(); }

 private:
  mcap_test::FieldReader reader_;
};

struct Field {
  std::uint32_t offset;
  std::uint8_t type;
};

struct Cloud {
  std::uint64_t time_ns;
  std::uint32_t points, step;
  std::map<std::string, Field> fields;
  std::string data;

  template <class T>
  T at(std::size_t point, const std::string& name) const {
    T value;
    std::memcpy(&value, data.data() + point * step + fields.at(name).offset, sizeof(T));
    return value;
  }
};

Cloud cloud_of(std::string_view message) {
  CdrReader reader(message);
  Cloud cloud{};
  cloud.time_ns = reader.time_ns();
  EXPECT_EQ(reader.text(), "lidar");
  EXPECT_EQ(reader.number<std::uint32_t>(), 1U) << "height";
  cloud.points = reader.number<std::uint32_t>();
  const auto fields = reader.number<std::uint32_t>();
  for (std::uint32_t k = 0; k < fields; ++k) {
    const std::string name = reader.text();
    const auto offset = reader.number<std::uint32_t>();
    cloud.fields[name] = {offset, reader.number<std::uint8_t>()};
    EXPECT_EQ(reader.number<std::uint32_t>(), 1U) << "count";
  }
  EXPECT_EQ(reader.number<std::uint8_t>(), 0) << "is_bigendian";
  cloud.step = reader.number<std::uint32_t>();
  EXPECT_EQ(reader.number<std::uint32_t>(), cloud.step * cloud.points) << "row_step";
  cloud.data = reader.bytes();
  EXPECT_EQ(cloud.data.size(), std::size_t{cloud.step} * cloud.points);
  EXPECT_EQ(reader.number<std::uint8_t>(), 1) << "is_dense";
  EXPECT_TRUE(reader.at_end());
  return cloud;
}

struct Transform {
  std::uint64_t time_ns;
  RigidTransform map_from_lidar;
};

std::vector<Transform> transforms_of(std::string_view message) {
  CdrReader reader(message);
  std::vector<Transform> transforms(reader.number<std::uint32_t>());
  for (Transform& transform : transforms) {
    transform.time_ns = reader.time_ns();
    EXPECT_EQ(reader.text(), "map");
    EXPECT_EQ(reader.text(), "lidar");
    double v[7];
    for (double& value : v) value = reader.number<double>();
    EXPECT_NEAR(std::hypot(v[3], v[4], std::hypot(v[5], v[6])), 1, 1e-12);
    transform.map_from_lidar = {rotation_from_quaternion(v[6], v[3], v[4], v[5]),
                                {v[0], v[1], v[2]}};
  }
  EXPECT_TRUE(reader.at_end());
  return transforms;
}

mcap_test::File written(const std::vector<Scan>& scans) {
  const TemporaryFolder folder;
  McapWriter writer(folder.path() / "scans.mcap");
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
  EXPECT_EQ(transform.map_from_lidar.translation, pose.translation);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(transform.map_from_lidar.rotation.rows[r][c], pose.rotation.rows[r][c], 1e-14);
}

/// Of scans whose three knots last a tenth of a second around their pose.
void expect_same(const std::vector<Transform>& transforms, const Scan& scan) {
  ASSERT_EQ(transforms.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
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
  constexpr std::uint8_t kU8 = 2, kU16 = 4, kF32 = 7;  // sensor_msgs/PointField
  const std::map<std::uint8_t, std::uint32_t> bytes = {{kU8, 1}, {kU16, 2}, {kF32, 4}};
  EXPECT_EQ(cloud.fields.at("x").offset, 0U);
  EXPECT_EQ(cloud.fields.at("z").offset, 8U);
  EXPECT_EQ(cloud.fields.at("time").type, kF32);
  EXPECT_EQ(cloud.fields.at("ring").type, kU16);
  EXPECT_EQ(cloud.fields.at("return_index").type, kU8);
  EXPECT_EQ(cloud.step % 4, 0U);
  for (const auto& [name, field] : cloud.fields) EXPECT_EQ(field.offset % bytes.at(field.type), 0U);
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
