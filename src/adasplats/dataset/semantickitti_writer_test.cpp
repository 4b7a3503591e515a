// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/semantickitti_writer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "adasplats/cloud/kitti_sequence.h"
#include "adasplats/cloud/temporary_folder_test.h"
#include "adasplats/core/random.h"
#include "adasplats/io/atomic_file.h"
#include "adasplats/io/ply.h"

namespace adasplats {
namespace {

/// A scan with all attributes, different for each number.
Scan scan_number(std::uint64_t number, std::size_t points) {
  Random random(11, 0, number);
  Scan scan;
  scan.time_s = 0.1 * static_cast<double>(number) + 1.0 / 3;
  scan.world_from_sensor = {
      rotation_from_yaw_pitch_roll(random.uniform(-3, 3), random.uniform(-1, 1),
                                   random.uniform(-3, 3)),
      {448262 + random.uniform(), 5411932 + random.uniform(), random.uniform(-50, 50)}};
  scan.rays = 2 * points;
  for (std::size_t i = 0; i < points; ++i) {
    const Vec3d p{random.uniform(-90, 90), random.uniform(-90, 90), random.uniform(-3, 9)};
    scan.positions.push_back(vec_cast<float>(p));
    scan.ranges_m.push_back(length(scan.positions.back()));
    scan.intensities.push_back(static_cast<float>(random.uniform()));
    scan.classes.push_back(static_cast<std::uint16_t>(random.next_bits()));
    scan.instances.push_back(static_cast<std::uint16_t>(random.next_bits()));
    scan.rings.push_back(static_cast<std::uint16_t>(i % 64));
    scan.times_s.push_back(0.001F * static_cast<float>(i));
  }
  return scan;
}

void expect_same_points(const KittiScan& read, const Scan& written) {
  ASSERT_EQ(read.positions.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i)
    EXPECT_TRUE(read.positions[i] == written.positions[i]);
  EXPECT_EQ(read.intensities, written.intensities);
  EXPECT_EQ(read.classes, written.classes);
  EXPECT_EQ(read.instances, written.instances);
}

// Oracle: round trip through the reader.
TEST(SemanticKittiWriter, RoundTrip) {
  const TemporaryFolder folder;
  const std::filesystem::path sequence_folder = folder.path() / "sequences" / "07 é";
  const Scan scans[] = {scan_number(0, 100), scan_number(1, 0), scan_number(2, 1)};
  SemanticKittiWriter writer(sequence_folder);
  for (const std::size_t i : {2, 0, 1}) writer.write_scan(i, scans[i]);
  EXPECT_FALSE(std::filesystem::exists(sequence_folder / "poses.txt"));
  writer.finish();

  const KittiSequence sequence = open_kitti_sequence(sequence_folder);
  ASSERT_EQ(sequence.scans.size(), 3U);
  ASSERT_EQ(sequence.labels.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_same_points(read_kitti_scan(sequence, i), scans[i]);
    const TimedPose& pose = sequence.trajectory[i];
    EXPECT_EQ(pose.time_s, scans[i].time_s);
    const RigidTransform& expected = scans[i].world_from_sensor;
    EXPECT_TRUE(pose.world_from_sensor.translation == expected.translation);
    for (int r = 0; r < 3; ++r)
      EXPECT_LT(length(pose.world_from_sensor.rotation.rows[r] - expected.rotation.rows[r]), 1e-14);
  }
}

// Oracle: the axes of KITTI's cameras: a drive 5 m forward is 5 m along the camera's z.
TEST(SemanticKittiWriter, PosesAreInTheCameraFrame) {
  const TemporaryFolder folder;
  Scan scan = scan_number(0, 1);
  scan.world_from_sensor = {{}, {5, 1, 0.5}};
  SemanticKittiWriter writer(folder.path() / "s");
  writer.write_scan(0, scan);
  writer.finish();
  EXPECT_EQ(read_file(folder.path() / "s/poses.txt"), "1 0 0 -1 0 1 0 -0.5 0 0 1 5\n");
  EXPECT_EQ(read_file(folder.path() / "s/calib.txt"), "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
}

TEST(SemanticKittiWriter, ScansWithoutClassesHaveNoLabels) {
  const TemporaryFolder folder;
  Scan bare = scan_number(0, 3);
  bare.classes.clear();
  bare.instances.clear();
  bare.intensities.clear();
  SemanticKittiWriter writer(folder.path() / "s");
  writer.write_scan(0, bare);
  EXPECT_THROW(writer.write_scan(1, scan_number(1, 3)), std::logic_error);
  writer.finish();
  const KittiSequence sequence = open_kitti_sequence(folder.path() / "s");
  EXPECT_TRUE(sequence.labels.empty());
  EXPECT_EQ(read_kitti_scan(sequence, 0).intensities, std::vector<float>(3, 0.0F));
}

TEST(SemanticKittiWriter, TimesThatDoNotAscendAreLeftOut) {
  const TemporaryFolder folder;
  SemanticKittiWriter writer(folder.path() / "s");
  writer.write_scan(0, scan_number(5, 1));
  writer.write_scan(1, scan_number(5, 1));
  writer.finish();
  EXPECT_EQ(open_kitti_sequence(folder.path() / "s").trajectory[1].time_s, 0.1);
}

TEST(SemanticKittiWriter, MissingScansAndForeignFolders) {
  const TemporaryFolder folder;
  {
    SemanticKittiWriter interrupted(folder.path() / "s");
    interrupted.write_scan(1, scan_number(1, 2));
    EXPECT_THROW(interrupted.finish(), std::logic_error);
  }
  {
    SemanticKittiWriter shorter(folder.path() / "s");
    shorter.write_scan(0, scan_number(0, 2));
    expect_error(ErrorKind::cannot_create, {"000001.bin"}, [&] { shorter.finish(); });
  }
  SemanticKittiWriter resumed(folder.path() / "s");
  for (const std::size_t i : {0, 1}) resumed.write_scan(i, scan_number(i, 2));
  resumed.finish();
  EXPECT_EQ(open_kitti_sequence(folder.path() / "s").scans.size(), 2U);
  expect_error(ErrorKind::cannot_create, {"poses.txt"},
               [&] { SemanticKittiWriter second(folder.path() / "s"); });
  folder.write("file", "");
  expect_error(ErrorKind::cannot_create, {"file"},
               [&] { SemanticKittiWriter below(folder.path() / "file"); });
}

std::vector<double> column(const Table& table, std::string_view name) {
  std::vector<double> values;
  const Column* found = table.find(name);
  if (found == nullptr) return values;
  for (std::size_t i = 0; i < table.rows; ++i) values.push_back(found->as_double(i));
  return values;
}

// Oracle: round trip through read_ply.
TEST(WriteScanPly, RoundTrip) {
  const TemporaryFolder folder;
  const Scan scan = scan_number(3, 20);
  write_scan_ply(folder.path() / "scan.ply", scan);
  const Table table = read_ply(folder.path() / "scan.ply");
  ASSERT_EQ(table.rows, scan.size());
  EXPECT_EQ(table.columns.size(), 9U);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    EXPECT_EQ(column(table, "y")[i], static_cast<double>(scan.positions[i].y));
    EXPECT_EQ(column(table, "intensity")[i], static_cast<double>(scan.intensities[i]));
    EXPECT_EQ(column(table, "label")[i], scan.classes[i]);
    EXPECT_EQ(column(table, "instance")[i], scan.instances[i]);
    EXPECT_EQ(column(table, "ring")[i], scan.rings[i]);
    EXPECT_EQ(column(table, "time")[i], static_cast<double>(scan.times_s[i]));
    EXPECT_EQ(column(table, "range")[i], static_cast<double>(scan.ranges_m[i]));
  }
}

TEST(WriteScanPly, EmptyScan) {
  const TemporaryFolder folder;
  write_scan_ply(folder.path() / "scan.ply", {});
  EXPECT_EQ(read_ply(folder.path() / "scan.ply").columns.size(), 6U);
}

// Oracle: the .npy format, version 1.0: magic, header length at byte 8, then the values.
template <class T>
std::vector<T> npy_values(const std::filesystem::path& path, const std::string& shape) {
  const std::string bytes = read_file(path);
  std::uint16_t header_length = 0;
  std::memcpy(&header_length, bytes.data() + 8, sizeof(header_length));
  EXPECT_NE(bytes.substr(10, header_length).find(shape), std::string::npos);
  const std::size_t begin = 10U + header_length;
  std::vector<T> values((bytes.size() - begin) / sizeof(T));
  std::memcpy(values.data(), bytes.data() + begin, values.size() * sizeof(T));
  return values;
}

TEST(WriteScanNpy, PointsAndLabels) {
  const TemporaryFolder folder;
  const Scan scan = scan_number(4, 5);
  write_scan_npy(folder.path() / "scan.npy", scan);
  const auto points = npy_values<float>(folder.path() / "scan.npy", "(5, 4)");
  const auto labels = npy_values<std::uint32_t>(folder.path() / "scan_label.npy", "(5,)");
  ASSERT_EQ(points.size(), 20U);
  ASSERT_EQ(labels.size(), 5U);
  EXPECT_EQ(points[4 * 3 + 2], scan.positions[3].z);
  EXPECT_EQ(points[4 * 3 + 3], scan.intensities[3]);
  EXPECT_EQ(labels[2], scan.instances[2] * 65536U + scan.classes[2]);
}

}  // namespace
}  // namespace adasplats
