// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/kitti_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

/// Poses of the LiDAR whose x is their number.
void write_poses(const TemporaryFolder& folder, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0\n";
  folder.write("poses.txt", text);
  folder.write("calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
}

void write_scan(const TemporaryFolder& folder, const std::string& name, std::size_t points) {
  std::vector<float> values;
  std::vector<std::uint32_t> labels;
  for (std::size_t i = 0; i < points; ++i) {
    const auto v = static_cast<float>(i);
    values.insert(values.end(), {v, v + 0.25F, -v, 0.5F});
    labels.push_back(static_cast<std::uint32_t>((i + 1) << 16 | (i + 40)));
  }
  folder.write("velodyne/" + name + ".bin", values);
  folder.write("labels/" + name + ".label", labels);
}

TEST(KittiSequence, ReadsScansLabelsAndPosesInOrder) {
  const TemporaryFolder folder;
  write_scan(folder, "000001", 1);
  write_scan(folder, "000000", 3);
  folder.write("velodyne/.adasplats-1-0.tmp", "");
  write_poses(folder, 2);
  EXPECT_TRUE(is_kitti_sequence(folder.path()));
  const KittiSequence sequence = open_kitti_sequence(folder.path());
  ASSERT_EQ(sequence.scans.size(), 2U);
  EXPECT_EQ(sequence.scans[0].filename(), "000000.bin");
  EXPECT_EQ(sequence.trajectory[1].world_from_sensor.translation.x, 1.0);
  const KittiScan scan = read_kitti_scan(sequence, 0);
  ASSERT_EQ(scan.positions.size(), 3U);
  EXPECT_TRUE((scan.positions[2] == Vec3f{2, 2.25F, -2}));
  EXPECT_EQ(scan.intensities[2], 0.5F);
  EXPECT_EQ(scan.classes[2], 42);
  EXPECT_EQ(scan.instances[2], 3);
}

TEST(KittiSequence, WithoutLabelsAndEmptyScans) {
  const TemporaryFolder folder;
  folder.write("velodyne/000000.bin", "");
  write_poses(folder, 1);
  const KittiSequence sequence = open_kitti_sequence(folder.path());
  EXPECT_TRUE(sequence.labels.empty());
  const KittiScan scan = read_kitti_scan(sequence, 0);
  EXPECT_TRUE(scan.positions.empty());
  EXPECT_TRUE(scan.classes.empty());
}

TEST(KittiSequence, PointsThatAreNotFiniteAreKept) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  folder.write("velodyne/000000.bin", std::vector<float>{nan, 0, 0, 1, 1, 2, 3, 4});
  write_poses(folder, 1);
  const KittiScan scan = read_kitti_scan(open_kitti_sequence(folder.path()), 0);
  ASSERT_EQ(scan.positions.size(), 2U);
  EXPECT_TRUE(std::isnan(scan.positions[0].x));
}

TEST(KittiSequence, PosesBeyondTheScansAreMatchedByNumber) {
  const TemporaryFolder folder;
  write_scan(folder, "000003", 1);
  write_scan(folder, "000005", 1);
  write_poses(folder, 9);
  const KittiSequence sequence = open_kitti_sequence(folder.path());
  EXPECT_EQ(sequence.trajectory[0].world_from_sensor.translation.x, 3.0);
  EXPECT_EQ(sequence.trajectory[1].world_from_sensor.translation.x, 5.0);
}

TEST(KittiSequence, OtherNamesAreMatchedOneByOne) {
  const TemporaryFolder folder;
  write_scan(folder, "a", 1);
  write_scan(folder, "b", 1);
  write_poses(folder, 2);
  EXPECT_EQ(open_kitti_sequence(folder.path()).trajectory[1].world_from_sensor.translation.x, 1.0);
  write_poses(folder, 3);
  expect_error(ErrorKind::data, {"poses.txt", "3 poses", "2 scans"},
               [&] { open_kitti_sequence(folder.path()); });
}

TEST(KittiSequence, CountsThatDoNotFit) {
  const TemporaryFolder folder;
  write_scan(folder, "000000", 2);
  write_scan(folder, "000001", 2);
  write_poses(folder, 1);
  expect_error(ErrorKind::data, {"poses.txt", "1 poses", "2 scans"},
               [&] { open_kitti_sequence(folder.path()); });
  write_poses(folder, 2);
  folder.write("labels/000001.label", std::vector<std::uint32_t>{1, 2, 3});
  const KittiSequence sequence = open_kitti_sequence(folder.path());
  expect_error(ErrorKind::data, {"000001.label", "3 labels", "2 points"},
               [&] { read_kitti_scan(sequence, 1); });
  folder.write("labels/000001.label", "abc");
  expect_error(ErrorKind::data, {"000001.label", "3 bytes"}, [&] { read_kitti_scan(sequence, 1); });
  expect_error(ErrorKind::data, {"000001.label", "3 bytes"},
               [&] { read_kitti_labels(sequence.labels.at(1)); });
  EXPECT_TRUE(read_kitti_labels(folder.write("none.label", "")).empty());
  folder.write("velodyne/000001.bin", std::string(17, 'x'));
  expect_error(ErrorKind::data, {"000001.bin"}, [&] { read_kitti_scan(sequence, 1); });
  std::filesystem::rename(folder.path() / "labels/000001.label",
                          folder.path() / "labels/000002.label");
  expect_error(ErrorKind::data, {"000002.label", "000001.label"},
               [&] { open_kitti_sequence(folder.path()); });
  std::filesystem::remove(folder.path() / "labels/000002.label");
  expect_error(ErrorKind::data, {"1 label files", "2 scans"},
               [&] { open_kitti_sequence(folder.path()); });
}

// Without Tr the camera's poses would be taken for the LiDAR's: a smeared map.
TEST(KittiSequence, MustSayWhichFrameItsPosesAreIn) {
  const TemporaryFolder folder;
  write_scan(folder, "000000", 1);
  write_poses(folder, 1);
  std::filesystem::remove(folder.path() / "calib.txt");
  expect_error(ErrorKind::data, {"calib.txt", "missing", "'Tr: 1 0 0 0 0 1 0 0 0 0 1 0'"},
               [&] { open_kitti_sequence(folder.path()); });
  folder.write("calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr_velo_to_cam: 1 2 3\n");
  expect_error(ErrorKind::data, {"calib.txt", "'Tr:'", "'P0:', 'Tr_velo_to_cam:'"},
               [&] { open_kitti_sequence(folder.path()); });
}

TEST(KittiSequence, MissingThings) {
  const TemporaryFolder folder;
  EXPECT_FALSE(is_kitti_sequence(folder.path()));
  EXPECT_FALSE(is_kitti_sequence(folder.path() / "absent"));
  expect_error(ErrorKind::no_input, {"velodyne"}, [&] { open_kitti_sequence(folder.path()); });
  std::filesystem::create_directories(folder.path() / "velodyne");
  expect_error(ErrorKind::no_input, {"velodyne", ".bin"},
               [&] { open_kitti_sequence(folder.path()); });
  write_scan(folder, "000000", 1);
  expect_error(ErrorKind::no_input, {"poses.txt"}, [&] { open_kitti_sequence(folder.path()); });
}

}  // namespace
}  // namespace adasplats
