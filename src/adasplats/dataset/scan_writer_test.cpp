// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

/// The files that two scans become, the second one empty.
std::vector<std::string> written_names(ScanFormat format) {
  const TemporaryFolder folder;
  ScanWriterOptions options;
  options.image_size = {64, 2};
  options.labels = &semantickitti_labels();
  const auto writer = make_scan_writer(folder.path(), format, options);
  writer->write(0, scan_number(0, 70));
  writer->write(1, scan_number(1, 0));
  writer->finish();
  auto names = names_in(folder.path());
  if (std::ranges::find(names, "poses.csv") != names.end()) {
    EXPECT_EQ(read_trajectory(folder.path() / "poses.csv").size(), 2U);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(ScanWriter, NamesOfEveryFormat) {
  EXPECT_EQ(written_names(ScanFormat::ply), (Names{"000000.ply", "000001.ply", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::npz), (Names{"000000.npz", "000001.npz", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::pcd), (Names{"000000.pcd", "000001.pcd", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::las), (Names{"000000.las", "000001.las", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::laz), (Names{"000000.laz", "000001.laz", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::npy), (Names{"000000.npy", "000000_label.npy", "000001.npy",
                                                   "000001_label.npy", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::range_image),
            (Names{"000000_label.npy", "000000_label.png", "000000_range.npy", "000000_range.png",
                   "000001_range.npy", "000001_range.png", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::mcap), (Names{"poses.csv", "scans.mcap"}));
  EXPECT_EQ(written_names(ScanFormat::semantickitti), (Names{"poses", "sequences"}));
}

TEST(ScanWriter, SequenceIsReadBack) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::semantickitti);
  writer->write(0, scan_number(0, 3));
  writer->finish();
  const KittiSequence sequence = open_kitti_sequence(folder.path() / "sequences/00");
  EXPECT_EQ(read_kitti_scan(sequence, 0).positions.size(), 3U);
}

// Oracle: the files of a scan whose points were put in order before.
TEST(ScanWriter, SequencesHaveKittiOrFiringOrder) {
  const TemporaryFolder folder;
  Scan scan = scan_number(0, 90);
  for (std::size_t i = 0; i < 90; ++i) {  // two rings that turn to the right
    const std::size_t column = i / 2;
    const auto angle = -0.13F * static_cast<float>(column);
    scan.rings[i] = static_cast<std::uint16_t>(i % 2);
    scan.positions[i] = {9 * std::cos(angle), 9 * std::sin(angle), static_cast<float>(i % 2)};
  }
  const auto written = [&](const char* name, PointOrder order) {
    const std::filesystem::path path = folder.path() / name;
    std::filesystem::create_directories(path);
    const auto writer = make_sequence_writer(path, "05", order);
    writer->write(0, scan);
    writer->finish();
    EXPECT_EQ(read_file(path / "poses/05.txt"), read_file(path / "sequences/05/poses.txt"));
    const KittiSequence sequence = open_kitti_sequence(path / "sequences/05");
    EXPECT_EQ(sequence.labels.size(), 1U);
    return read_kitti_scan(sequence, 0);
  };
  const KittiScan fired = written("fired", PointOrder::firing);
  EXPECT_EQ(fired.intensities, scan.intensities);
  EXPECT_EQ(fired.classes, scan.classes);
  const KittiScan kitti = written("kitti", PointOrder::kitti);
  const Scan expected = reordered(scan, kitti_order(scan));
  EXPECT_NE(kitti.intensities, scan.intensities);
  EXPECT_EQ(kitti.intensities, expected.intensities);
  EXPECT_EQ(kitti.classes, expected.classes);
  EXPECT_EQ(kitti.instances, expected.instances);
}

TEST(ScanWriter, MissingFolder) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path() / "missing", ScanFormat::pcd);
  expect_error(ErrorKind::cannot_create, {"000000.pcd"},
               [&] { writer->write(0, scan_number(0, 1)); });
}

}  // namespace
}  // namespace adasplats
