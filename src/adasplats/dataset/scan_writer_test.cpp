// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_writer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"

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
  EXPECT_EQ(written_names(ScanFormat::npy), (Names{"000000.npy", "000000_label.npy", "000001.npy",
                                                   "000001_label.npy", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::range_image),
            (Names{"000000_label.npy", "000000_label.png", "000000_range.npy", "000000_range.png",
                   "000001_range.npy", "000001_range.png", "poses.csv"}));
  EXPECT_EQ(written_names(ScanFormat::mcap), (Names{"poses.csv", "scans.mcap"}));
  EXPECT_EQ(written_names(ScanFormat::semantickitti), Names{"sequences"});
}

TEST(ScanWriter, SequenceIsReadBack) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::semantickitti);
  writer->write(0, scan_number(0, 3));
  writer->finish();
  const KittiSequence sequence = open_kitti_sequence(folder.path() / "sequences/00");
  EXPECT_EQ(read_kitti_scan(sequence, 0).positions.size(), 3U);
}

TEST(ScanWriter, FolderThatIsNotThere) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path() / "missing", ScanFormat::pcd);
  expect_error(ErrorKind::cannot_create, {"000000.pcd"},
               [&] { writer->write(0, scan_number(0, 1)); });
}

}  // namespace
}  // namespace adasplats
