// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

constexpr double kNorth_deg = 49, kEast_deg = 8.4;
constexpr double kSpeed_m_s = 8;  // to the east, turning to the left by 0.1 rad/s

std::string numbered(int k, const char* extension) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%010d%s", k, extension);
  return text.data();
}

std::string stamp(double time_s) {
  std::array<char, 60> text{};
  std::snprintf(text.data(), text.size(), "2011-09-26 13:02:%012.9f\n", time_s);
  return text.data();
}

/// The unit at a time: how far east it is, and its yaw.
std::string record(double time_s) {
  const double metre_deg = 1 / (std::cos(kNorth_deg * kDegree) * 6378137 * kDegree);
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "%.12f %.12f 115.5 0 0 %.9f -1 0 0 0\n", kNorth_deg,
                kEast_deg + kSpeed_m_s * time_s * metre_deg, 0.1 * time_s);
  return text.data();
}

/// A drive whose scans are `scan_s` and whose records `record_s` apart, the first record a little
/// after the first scan.
void write_drive(const TemporaryFolder& folder, const std::string& name, double record_s,
                 bool synced, int scans = 6) {
  std::string scan_times, record_times;
  for (int k = 0; k < scans; ++k) {
    scan_times += stamp(20 + 0.1 * k);
    const std::string file = name + "/velodyne_points/data/" + numbered(k, "");
    if (synced) folder.write(file + ".bin", std::vector<float>{5, 1, -1, 0.25F});
    if (!synced) folder.write(file + ".txt", "5 1 -1 0.25\n6.5 0 0 0\n");
  }
  for (int k = 0; 0.013 + record_s * k < 0.1 * scans; ++k) {
    record_times += stamp(20.013 + record_s * k);
    folder.write(name + "/oxts/data/" + numbered(k, ".txt"), record(0.013 + record_s * k));
  }
  folder.write(name + "/velodyne_points/timestamps.txt", scan_times);
  folder.write(name + "/oxts/timestamps.txt", record_times);
  folder.write("calib_imu_to_velo.txt",
               "calib_time: 25-May-2012 16:47:16\nR: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
}

std::string fault_of(const std::filesystem::path& drive) {
  try {
    open_kitti_raw_drive(drive);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(KittiRaw, PosesAreThoseAtTheTimesOfTheScans) {
  for (const bool synced : {true, false}) {
    const TemporaryFolder folder;
    write_drive(folder, "drive", synced ? 0.1 : 0.01, synced);
    const auto drive = folder.path() / "drive";
    EXPECT_TRUE(is_kitti_sequence(drive));
    const KittiSequence sequence = open_kitti_sequence(drive);
    ASSERT_EQ(sequence.scans.size(), 6U);
    EXPECT_NEAR(sequence.trajectory[1].time_s - sequence.trajectory[0].time_s, 0.1, 1e-6);
    // 2011-09-26 13:02:20
    EXPECT_NEAR(sequence.trajectory[0].time_s, 1317042140, 1e-5);
    const auto place = [](double time_s) {
      const double yaw = 0.1 * time_s;
      const Vec3d lever = {0.8, -0.3, 0.8};  // of the LiDAR from the unit
      return Vec3d{kSpeed_m_s * time_s + std::cos(yaw) * lever.x - std::sin(yaw) * lever.y,
                   std::sin(yaw) * lever.x + std::cos(yaw) * lever.y, lever.z};
    };
    for (std::size_t k = 0; k < 6; ++k) {
      const double time_s = 0.1 * static_cast<double>(k);
      const RigidTransform pose = sequence.trajectory[k].world_from_sensor;
      // The first scan is before the first record: what the motion has made of it by then.
      EXPECT_LT(length(pose.translation - (place(time_s) - place(0))), 2e-3) << k;
      EXPECT_NEAR(std::atan2(pose.rotation.rows[1].x, pose.rotation.rows[0].x), 0.1 * time_s, 1e-5);
    }
    const KittiScan scan = read_kitti_scan(sequence, 2);
    ASSERT_EQ(scan.positions.size(), synced ? 1U : 2U);
    EXPECT_TRUE((scan.positions[0] == Vec3f{5, 1, -1}));
    EXPECT_EQ(scan.intensities[0], 0.25F);
  }
}

TEST(KittiRaw, ScansThatAreMissingLeaveTheOthersTheirTimes) {
  const TemporaryFolder folder;
  write_drive(folder, "drive", 0.1, true);
  std::filesystem::remove(folder.path() / "drive/velodyne_points/data/0000000002.bin");
  const KittiSequence sequence = open_kitti_raw_drive(folder.path() / "drive");
  ASSERT_EQ(sequence.trajectory.size(), 5U);
  EXPECT_NEAR(sequence.trajectory[2].time_s - sequence.trajectory[1].time_s, 0.2, 1e-6);
}

TEST(KittiRaw, FaultsNameTheirFile) {
  const auto with = [](const std::string& file, const std::string& text) {
    const TemporaryFolder folder;
    write_drive(folder, "drive", 0.1, true);
    if (text.empty()) std::filesystem::remove(folder.path() / file);
    if (!text.empty()) folder.write(file, text);
    return fault_of(folder.path() / "drive");
  };
  const auto has = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  EXPECT_EQ(with("unused.txt", "x"), "");
  has(with("calib_imu_to_velo.txt", ""), "calib_imu_to_velo.txt is neither in it nor in");
  has(with("calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 2\nT: 0 0 0\n"), "a rotation by rows");
  has(with("calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 x 1\n"), "line 1: 'x', expected 9 numbers");
  has(with("drive/velodyne_points/timestamps.txt", "2011-09-26 13:02:20\n"), "0000000001.bin");
  has(with("drive/velodyne_points/timestamps.txt", "yesterday\n"), "line 1: 'yesterday'");
  for (const char* stamp :
       {"2011-13-26 13:02:20", "2011--2-26 13:02:20", "2011-.9-26 13:02:20", "2011-09-26 -1:02:20",
        "2011-09-26 13:02", "2011-09-26 13:02:-5", "2011-09-26 13:02:nan"})
    has(with("drive/oxts/timestamps.txt", std::string(stamp) + "\n"), "expected a time such as");
  has(with("drive/oxts/data/0000000001.txt", "49 8\n"), "line 1: '', expected 6 numbers");
  has(with("drive/oxts/data/0000000001.txt", "490 8 0 0 0 0\n"), "expected latitude");
  has(with("drive/oxts/data/0000000001.txt", "\n"), "expected a record");
  has(with("drive/oxts/data/0000000001.txt", "49 8 115 0 0 95.5\n"), "expected radians");
}

TEST(KittiRaw, NothingIsGuessedWhereRecordsAreMissing) {
  const TemporaryFolder folder;
  write_drive(folder, "drive", 0.01, false, 20);
  for (int k = 60; k < 100; ++k)
    std::filesystem::remove(folder.path() / "drive/oxts/data" / numbered(k, ".txt"));
  const std::string fault = fault_of(folder.path() / "drive");
  EXPECT_NE(fault.find("0000000007.txt: no record of oxts is near its time"), std::string::npos)
      << fault;
}

}  // namespace
}  // namespace adasplats
