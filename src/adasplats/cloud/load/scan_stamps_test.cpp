// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/scan_stamps.h"

#include <gtest/gtest.h>

#include <string>

#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

using Paths = std::vector<std::filesystem::path>;

// Oracle: the times that data sets mean by such names.
TEST(ScanStamps, NamesOfDataSets) {
  const std::vector<double> expected = {1547131046.5, 1547131046.75};
  for (const Paths& names :
       {Paths{"1547131046.5.pcd", "1547131046.75.pcd"},
        Paths{"1547131046500000000.bin", "1547131046750000000.bin"},
        Paths{"n015-2018__LIDAR_TOP__1547131046500000.pcd.bin",
              "n015-2018__LIDAR_TOP__1547131046750000.pcd.bin"},
        Paths{"cloud_1547131046_500000000.pcd", "cloud_1547131046_750000000.pcd"}}) {
    const std::vector<double> stamps = stamps_in_names(names);
    ASSERT_EQ(stamps.size(), 2U) << names.front();
    EXPECT_NEAR(stamps[0], expected[0], 1e-6) << names.front();
    EXPECT_NEAR(stamps[1], expected[1], 1e-6) << names.front();
  }
}

TEST(ScanStamps, NumbersOfScansAreNoTimes) {
  EXPECT_TRUE(stamps_in_names({"000000.bin", "000001.bin"}).empty());
  EXPECT_TRUE(stamps_in_names({"a.bin", "b.bin"}).empty());
  EXPECT_TRUE(stamps_in_names({"1547131046.bin", "1547131046.bin"}).empty());
  EXPECT_TRUE(stamps_in_names({}).empty());
}

TEST(ScanStamps, ScansAreInTheOrderOfTheirNumbers) {
  const TemporaryFolder folder;
  for (const char* name : {"10.xyz", "9.xyz", "11.xyz"}) folder.write(name, std::string("1 2 3\n"));
  folder.write("readme.txt", std::string("Points of a drive.\n"));
  const Paths files = scan_files(folder.path());
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0].filename(), "9.xyz");
  EXPECT_EQ(files[2].filename(), "11.xyz");
}

const char* const kTum =
    "# timestamp tx ty tz qx qy qz qw\n"
    "1600000000.0 0 0 0 0 0 0 1\n1600000000.1 1 0 0 0 0 0 1\n1600000000.2 2 0 0 0 0 0 1\n"
    "1600000005.0 9 0 0 0 0 0 1\n1600000005.1 10 0 0 0 0 0 1\n";

TEST(ScanStamps, PosesAreThoseOfTheStamps) {
  const TemporaryFolder folder;
  const auto poses = folder.write("poses.tum", std::string(kTum));
  const auto found =
      poses_of_files({"1600000000.05.pcd", "1600000000.15.pcd"}, poses, {}, std::nullopt);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->has_times);
  EXPECT_NEAR(found->of_scans[0].world_from_sensor.translation.x, 0.5, 1e-4);
  EXPECT_NEAR(found->of_scans[1].world_from_sensor.translation.x, 1.5, 1e-4);
  expect_error(ErrorKind::data, {"has a gap around"}, [&] {
    poses_of_files({"1600000000.05.pcd", "1600000003.00.pcd"}, poses, {}, std::nullopt);
  });
  expect_error(ErrorKind::data, {"its poses cover"}, [&] {
    poses_of_files({"1600000004.95.pcd", "1600000006.00.pcd"}, poses, {}, std::nullopt);
  });
}

TEST(ScanStamps, OnePoseAScanOrItsNumber) {
  const TemporaryFolder folder;
  const auto poses = folder.write("poses.txt", std::string("1 0 0 0 0 1 0 0 0 0 1 0\n"
                                                           "1 0 0 5 0 1 0 0 0 0 1 0\n"));
  const auto in_order = poses_of_files({"a.pcd", "b.pcd"}, poses, {}, std::nullopt);
  ASSERT_TRUE(in_order);
  EXPECT_FALSE(in_order->has_times);
  EXPECT_EQ(in_order->of_scans[1].world_from_sensor.translation.x, 5);
  const auto by_number = poses_of_files({"0001.pcd"}, poses, {}, std::nullopt);
  ASSERT_TRUE(by_number);
  EXPECT_EQ(by_number->of_scans[0].world_from_sensor.translation.x, 5);
  EXPECT_FALSE(poses_of_files({"a.pcd", "b.pcd", "c.pcd"}, poses, {}, std::nullopt));
}

TEST(ScanStamps, StatedTimesAreThoseOfScansInSeconds) {
  const TemporaryFolder folder;
  const auto sound = folder.write("times.txt", std::string("0\n0.1\n0.2\n"));
  EXPECT_EQ(read_scan_times(sound, 3).size(), 3U);
  expect_error(ErrorKind::data, {"3 times for 4 scans"}, [&] { read_scan_times(sound, 4); });
  const auto milli = folder.write("ms.txt", std::string("0\n100\n200\n"));
  expect_error(ErrorKind::data, {"seconds", "100"}, [&] { read_scan_times(milli, 3); });
  const auto back = folder.write("back.txt", std::string("0\n0.2\n0.1\n"));
  expect_error(ErrorKind::data, {"ascend"}, [&] { read_scan_times(back, 3); });
}

TEST(ScanStamps, MeaningOfTimes) {
  using Kind = PointTimes::Kind;
  const TimeSpan track = {1.6e9, 1.6e9 + 10};
  EXPECT_EQ(meaning_of_times({0, 0}, {0, 0}, &track, 0).kind, Kind::none);
  const PointTimes nano = meaning_of_times({0, 9.9e7}, {0, 1e8}, &track, 0);
  EXPECT_EQ(nano.kind, Kind::offsets);
  EXPECT_NEAR(nano.time_s(5e7, 7), 7.05, 1e-12);
  const PointTimes micro =
      meaning_of_times({1.6e15, 1.6e15 + 1e5}, {1.6e15 + 9e6, 1.6e15 + 9.1e6}, &track, 0);
  EXPECT_EQ(micro.kind, Kind::absolute);
  EXPECT_TRUE(micro.fits);
  EXPECT_EQ(micro.unit_s, 1e-6);
  EXPECT_FALSE(meaning_of_times({5, 5.1}, {6, 6.1}, &track, 0).fits);
  EXPECT_FALSE(meaning_of_times({0, 3}, {0, 3}, &track, 0).fits);  // no sweep in any unit
}

}  // namespace
}  // namespace adasplats
