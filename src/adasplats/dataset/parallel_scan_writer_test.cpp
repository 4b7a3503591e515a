// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/parallel_scan_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <map>
#include <thread>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDriveScans = 23;

std::size_t points_of(std::size_t index) { return index % 5 == 3 ? 0 : 64 + 7 * index; }

ScanWriterOptions writing_options() {
  static const LidarModel sensor = load_lidar_model("velodyne-hdl-64e-s3");  // of 64 rings
  ScanWriterOptions options;
  options.packets.sensor = &sensor;
  options.image_size = {64, 8};
  options.labels = &semantickitti_labels();
  options.drive = {kDriveScans, [](std::size_t i) { return scan_number(i, 0).time_s; }};
  return options;
}

std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).generic_string()] = read_file(entry.path());
  return files;
}

std::map<std::string, std::string> written_by(ScanFormat format, int threads) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), format, writing_options());
  ParallelWriteOptions options;
  options.threads = threads;
  options.writes = FileWrites::in_place;
  ParallelScanWriter parallel(*writer, options);
  for (std::size_t i = 0; i < kDriveScans; ++i)
    parallel.write(i, held_scan(scan_number(i, points_of(i))));
  parallel.finish();
  return files_in(folder.path());
}

// Oracle: scan after scan on one thread, every file atomic.
TEST(ParallelScanWriter, SameBytesForAnyNumberOfThreads) {
  for (const auto& [word, format] : kScanFormats) {
    const TemporaryFolder folder;
    const auto writer = make_scan_writer(folder.path(), format, writing_options());
    for (std::size_t i = 0; i < kDriveScans; ++i) writer->write(i, scan_number(i, points_of(i)));
    writer->finish();
    const auto expected = files_in(folder.path());
    for (const int threads : {1, 2, 7}) EXPECT_EQ(written_by(format, threads), expected) << word;
  }
}

// Reports are in order, name existing files, and have the main file last.
TEST(ParallelScanWriter, ReportsCompleteScansInOrder) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::npy);
  std::vector<std::size_t> reported;
  ParallelWriteOptions options;
  options.threads = 4;
  options.hashed = true;
  options.more_files = [](std::size_t index, const ScanView& scan) {
    // The later ones are ready first.
    std::this_thread::sleep_for(std::chrono::microseconds(100 * (kDriveScans - index)));
    return std::vector<EncodedFile>{
        {"more/" + std::to_string(index) + ".txt", std::to_string(scan.size())}};
  };
  options.written = [&](std::size_t index, std::size_t points, std::span<const FileDigest> files) {
    reported.push_back(index);
    EXPECT_EQ(points, points_of(index));
    ASSERT_EQ(files.size(), 3U);
    EXPECT_EQ(files[0].name, "more/" + std::to_string(index) + ".txt");
    EXPECT_EQ(files.back().name, writer->main_file(index));
    for (const FileDigest& file : files)
      EXPECT_EQ(file.sha256, sha256_of_file(folder.path() / file.name));
  };
  ParallelScanWriter parallel(*writer, options);
  for (std::size_t i = 0; i < kDriveScans; ++i)
    parallel.write(i, held_scan(scan_number(i, points_of(i))));
  parallel.finish();
  ASSERT_EQ(reported.size(), kDriveScans);
  for (std::size_t i = 0; i < kDriveScans; ++i) EXPECT_EQ(reported[i], i);
}

TEST(ParallelScanWriter, FewScansArePending) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::pcd);
  std::atomic<std::size_t> begun = 0;
  std::atomic<bool> go = false;
  ParallelWriteOptions options;
  options.threads = 2;
  options.more_files = [&](std::size_t, const ScanView&) {
    while (!go) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return std::vector<EncodedFile>{};
  };
  ParallelScanWriter parallel(*writer, options);
  std::thread caller([&] {
    for (std::size_t i = 0; i < kDriveScans; ++i) {
      parallel.write(i, held_scan(scan_number(i, 1)));
      ++begun;
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_LE(begun, 6U);
  go = true;
  caller.join();
  parallel.finish();
  EXPECT_EQ(files_in(folder.path()).size(), kDriveScans + 1);
}

TEST(ParallelScanWriter, FailuresReachTheCaller) {
  for (const int threads : {1, 3}) {
    const TemporaryFolder folder;
    const auto writer = make_scan_writer(folder.path(), ScanFormat::ply);
    fs::create_directory(folder.path() / "000004.ply");
    ParallelWriteOptions options;
    options.threads = threads;
    options.writes = FileWrites::in_place;
    ParallelScanWriter parallel(*writer, options);
    expect_error(ErrorKind::cannot_create, {"000004.ply"}, [&] {
      for (std::size_t i = 0; i < 100; ++i) parallel.write(i, held_scan(scan_number(i, 3)));
      parallel.finish();
    });
    EXPECT_FALSE(fs::exists(folder.path() / "poses.csv"));
  }
  // Of the part that goes in order, too: ROS has no times before 1970.
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::mcap);
  ParallelScanWriter parallel(*writer, {});
  Scan early = scan_number(0, 1);
  early.time_s = -1;
  parallel.write(0, held_scan(std::move(early)));
  expect_error(ErrorKind::data, {"-1"}, [&] { parallel.finish(); });
}

TEST(ParallelScanWriter, PendingScansAreDiscardedWithoutFinish) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::semantickitti);
  {
    ParallelScanWriter parallel(*writer, {});
    for (std::size_t i = 0; i < 3; ++i) parallel.write(i, held_scan(scan_number(i, 3)));
  }
  EXPECT_FALSE(fs::exists(folder.path() / "sequences/00/poses.txt"));
}

}  // namespace
}  // namespace adasplats
