// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/scan_folder.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

std::vector<ScanMotion> motions(std::size_t count) {
  std::vector<ScanMotion> scans(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Scan scan = scan_number(i, 0);
    scans[i].reference = {scan.time_s, scan.world_from_sensor};
  }
  return scans;
}

/// Writes scans that have `points[i]` returns, and gives how many a next run would keep.
std::size_t kept_of(const fs::path& output, const std::vector<std::size_t>& points,
                    const std::string& damaged = "") {
  const nlohmann::ordered_json content = {{"a", 1}};
  {
    ResumableFolder folder(output, false, "test", content);
    const auto writer = make_scan_writer(folder.path(), ScanFormat::npy);
    ScanJournal journal(folder);
    ParallelWriteOptions options;
    options.threads = 2;
    options.writes = FileWrites::in_place;
    options.hashed = true;
    options.written = [&](std::size_t, std::size_t count, std::span<const FileDigest> files) {
      journal.note(count, files);
    };
    ParallelScanWriter files(*writer, options);
    for (std::size_t i = 0; i < points.size(); ++i)
      files.write(i, held_scan(scan_number(i, points[i])));
    files.finish();
    if (!damaged.empty()) fs::resize_file(folder.path() / damaged, 40);
  }
  ResumableFolder folder(output, false, "test", content);
  const auto writer = make_scan_writer(folder.path(), ScanFormat::npy);
  return keep_written_scans(*writer, folder, motions(6));
}

TEST(ScanFolder, KeepsScansUpToTheFirstThatIsNotWhole) {
  const TemporaryFolder folder;
  EXPECT_EQ(kept_of(folder.path() / "a", {3, 3, 3, 3}), 4U);
  EXPECT_EQ(kept_of(folder.path() / "b", {3, 0, 3, 3}, "000002.npy"), 2U);
  EXPECT_EQ(kept_of(folder.path() / "c", {3, 0, 3, 3}, "000001_label.npy"), 1U);
  EXPECT_EQ(kept_of(folder.path() / "d", {3, 3, 3, 3, 3, 3, 3, 3}), 6U);
}

TEST(ScanFolder, EmptyScansAreNotedWithTheFirstReturn) {
  const TemporaryFolder folder;
  EXPECT_EQ(kept_of(folder.path() / "a", {0, 0, 0}), 0U);
  EXPECT_EQ(kept_of(folder.path() / "b", {0, 0, 2, 0}), 4U);
}

// Oracle: bytes of the formats by hand, of ten million million rays.
TEST(ScanFolder, RoomForTheLeast) {
  const TemporaryFolder folder;
  constexpr std::size_t kScans = 10'000'000, kRays = 1'000'000;
  expect_error(ErrorKind::io, {"16000.00 GB if 10 %", "400000.00 GB", "are free"}, [&] {
    require_disk_space(folder.path(), ScanFormat::semantickitti, kScans, kRays, 2);
  });
  expect_error(ErrorKind::io, {"40000.00 GB if 10 %", "130000.00 GB"}, [&] {
    require_disk_space(folder.path(), ScanFormat::range_image, kScans, kRays, 2);
  });
  require_disk_space(folder.path(), ScanFormat::las, 1, 10, 1);
  require_disk_space(folder.path(), ScanFormat::las, 0, kRays, 1);
  expect_error(ErrorKind::io, {"missing"},
               [&] { require_disk_space(folder.path() / "missing", ScanFormat::ply, 1, 1, 1); });
}

}  // namespace
}  // namespace adasplats
