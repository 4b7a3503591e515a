// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/semantickitti_writer.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

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

TEST(SemanticKittiWriter, NonAscendingTimesAreOmitted) {
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

// Oracle: the same scans written without a break.
TEST(SemanticKittiWriter, KeptScansGiveTheSameFiles) {
  const TemporaryFolder folder;
  const Scan scans[] = {scan_number(0, 10), scan_number(1, 0), scan_number(2, 7)};
  SemanticKittiWriter whole(folder.path() / "whole");
  for (std::size_t i = 0; i < 3; ++i) whole.write_scan(i, scans[i]);
  whole.finish();
  {
    SemanticKittiWriter interrupted(folder.path() / "s");
    for (std::size_t i = 0; i < 2; ++i) interrupted.write_scan(i, scans[i]);
  }
  SemanticKittiWriter resumed(folder.path() / "s");
  for (std::size_t i = 0; i < 2; ++i)
    resumed.keep_scan(i, {scans[i].time_s, scans[i].world_from_sensor});
  resumed.write_scan(2, scans[2]);
  resumed.finish();
  for (const char* name : {"poses.txt", "calib.txt", "times.txt", "labels/000001.label",
                           "labels/000000.label", "velodyne/000000.bin", "velodyne/000002.bin"})
    EXPECT_EQ(read_file(folder.path() / "s" / name), read_file(folder.path() / "whole" / name))
        << name;
}

TEST(SemanticKittiWriter, KeptScansMustExist) {
  const TemporaryFolder folder;
  SemanticKittiWriter writer(folder.path() / "s");
  expect_error(ErrorKind::io, {"000004.bin"}, [&] { writer.keep_scan(4, {}); });
  writer.write_scan(0, scan_number(0, 3));
  folder.write("s/labels/000000.label", "1234");
  expect_error(ErrorKind::io, {"000000.label"}, [&] { writer.keep_scan(0, {}); });
}

}  // namespace
}  // namespace adasplats
