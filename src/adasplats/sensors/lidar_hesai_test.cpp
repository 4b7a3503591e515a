// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

class HesaiCsv : public testing::Test {
 protected:
  LidarModel load(const std::string& angles) const {
    return load_lidar_model(folder_.write("my_Angle.csv", angles).string());
  }
  void expect_data_error(const std::string& angles, const std::string& says) const {
    expect_error(ErrorKind::data, {"my_Angle.csv", says}, [&] { load(angles); });
  }
  TemporaryFolder folder_;
};

constexpr int kChannels = 20;  // of no supported model

/// `begin`, and lines of the channels 4 to 20, each with `middle` and its negative number, and
/// `end`.
std::string completed(std::string begin, const std::string& middle, const std::string& end) {
  for (int k = 4; k <= kChannels; ++k)
    begin += std::to_string(k) + middle + std::to_string(-k) + end;
  return begin;
}
std::string angles() {
  return completed("Channel,Elevation,Azimuth\r\n1,5,-1.5\r\n2,-3,0\r\n3,0,2\r\n", ",", ",0\r\n");
}

// Oracle: a channel looks at the block's azimuth plus its own, clockwise.
TEST_F(HesaiCsv, AzimuthsRunClockwise) {
  const LidarModel model = load(angles());
  EXPECT_EQ(model.rings(), 20U);
  EXPECT_TRUE(model.clockwise);
  EXPECT_DOUBLE_EQ(model.elevations_rad[1], 0);  // sorted
  EXPECT_DOUBLE_EQ(model.azimuth_offsets_rad[1], -2 * kDegree);
  const Firing first = firings_of(model)[0];
  EXPECT_NEAR(std::atan2(first.direction.y, first.direction.x) / kDegree, 1.5, 1e-5);
}

// Oracle: times by hand; the earliest becomes 0 and the head is where it was then.
TEST_F(HesaiCsv, FiringTimesLieBesideTheAngles) {
  folder_.write("my_firetime.csv",
                completed("Channel,fire time(us)\n3,-1\n1,-50\n2,-10.5\n", ",", "\n"));
  const LidarModel model = load(angles());
  ASSERT_EQ(model.firing_times_s.size(), 20U);
  EXPECT_NEAR(model.firing_times_s[0], 0, 1e-12);        // channel 1
  EXPECT_NEAR(model.firing_times_s[1], 49e-6, 1e-12);    // channel 3
  EXPECT_NEAR(model.firing_times_s[2], 39.5e-6, 1e-12);  // channel 2
  // 50 us before its block began the head, which turns clockwise, was 0.18 degrees to the left.
  EXPECT_NEAR(model.first_azimuth_rad / kDegree, 0.18, 1e-9);
}

// Oracle: what each channel's states say; channel 3 fires in every one.
TEST_F(HesaiCsv, StatesOfTheAzimuthAreColumns) {
  folder_.write("my_firetime.csv",
                completed("Operational State,0,0,0,0,2,2\nAzimuth State,0,1,2,3,0,1\n"
                          "1,-,18,-,18,46,46\n2,6,-,6,-,6,6\n3,20,20,22,20,20,22\n",
                          ",1,1,1,1,1,", "\n"));
  const LidarModel model = load(angles());
  std::vector<std::size_t> rays(20, 0);
  for (const Firing& firing : firings_of(model)) {
    ++rays[firing.ring];
    if (firing.ring == 0) {
      ASSERT_EQ(firing.column % 2, 1U);
    }
    if (firing.ring == 2) {
      ASSERT_EQ(firing.column % 2, 0U);
    }
  }
  EXPECT_EQ((std::vector<std::size_t>{rays[0], rays[1], rays[2]}),
            (std::vector<std::size_t>{900, 1800, 900}));
  EXPECT_EQ(model.rays_per_scan(), 3600U + 17 * 1800);
  EXPECT_EQ(model.columns, 1800U);
}

TEST_F(HesaiCsv, WrongFilesAreRefusedWithTheLine) {
  const std::string header = "Channel,Elevation,Azimuth\n";
  expect_data_error(header, "no channels");
  expect_data_error("Channel,Elevation\n1,2\n", "expected the columns Channel, Elevation, Azimuth");
  expect_data_error("Channel,fire time(us)\n1,2\n", "a table of firing times");
  expect_data_error("Operational State,0\n", "a table of firing times");
  expect_data_error(header + "1,2\n", "my_Angle.csv:2: 2 values");
  expect_data_error(header + "1,2,3\n1,2,3\n", "my_Angle.csv:3: channel 1 occurs twice");
  expect_data_error(header + "0,2,3\n", "channel is '0'");
  expect_data_error(header + "1,nan,3\n", "elevation is 'nan'");
  expect_data_error(header + "1,91,3\n", "elevation is '91'");
  expect_data_error(header + "1,2,1e300\n", "azimuth is '1e300'");
}

TEST_F(HesaiCsv, ADigestMayFollowTheAngles) {
  EXPECT_EQ(load(angles() + std::string(64, 'a') + "\r\n").rings(), 20U);
  expect_data_error(angles() + std::string(63, 'a') + "\n", "my_Angle.csv:22: 1 values");
}

TEST_F(HesaiCsv, AnglesThatAreNotThoseOfBeamsAreErrors) {
  const auto table = [](int channels, const auto& elevation_of) {
    std::string text = "Channel,Elevation,Azimuth\n";
    for (int k = 0; k < channels; ++k)
      text += std::to_string(k + 1) + "," + std::to_string(elevation_of(k)) + ",0\n";
    return text;
  };
  expect_data_error(table(16, [](int) { return 0.0; }), "all 16 beams have the elevation 0");
  expect_data_error(table(16, [](int k) { return k / 2 + 1.0; }), "beams 0 and 1 (from 0)");
  expect_data_error(table(16, [](int k) { return 0.26 - 0.035 * k; }), "are they in radians?");
  expect_data_error("Channel,Elevation,Azimuth\n1,5,0\n3,4,0\n",
                    "has 2 channels, but their numbers go up to 3");
}

TEST_F(HesaiCsv, WrongFiringTimesAreRefusedWithTheLine) {
  const auto reject = [&](const std::string& times, const std::string& says) {
    folder_.write("my_firetime.csv", times);
    expect_error(ErrorKind::data, {"my_firetime.csv", says}, [&] { load(angles()); });
  };
  reject("", "expected the columns");
  reject("Channel,fire time(us)\n1,0\n2,0\n", "no channel 3");
  reject("Channel,fire time(us)\n1,-1e300\n2,-1e300\n3,-1e300\n", "more than a revolution");
  reject("Channel,fire time(us)\n1,nan\n", "my_firetime.csv:2: fire time is 'nan'");
  reject("Operational State,0,0\nAzimuth State,0,1\n1,-,-\n", "never fires");
  reject("Operational State,0,0,0\nAzimuth State,0,1,2\n1,-,1,1\n", "uneven");
  reject("Operational State,0,0,0,0\nAzimuth State,0,1,2,3\n1,1,1,-,-\n", "uneven");
  reject("Operational State\n", "no operational states");
  reject(completed("Channel,fire time(us)\n1,0\n2,0\n3,60\n", ",", "\n"), "us a column");
}

/// The first `count` channels of a sensor with `all`, from `first_deg` to `last_deg`.
std::string begin_of_table(int count, int all, double first_deg, double last_deg) {
  std::string text = "Channel,Elevation,Azimuth\n";
  for (int k = 0; k < count; ++k)
    text += std::to_string(k + 1) + "," +
            std::to_string(first_deg + (last_deg - first_deg) * k / (all - 1)) + ",0\n";
  return text;
}

// First and last elevations are those of Hesai's SDK (XT16, XT32, 40P, 64, 128, QT64, QT128, JT16).
TEST_F(HesaiCsv, TablesCutOffAtTheEndAreErrors) {
  struct Table {
    int channels;
    double first_deg, last_deg;
  };
  for (const Table& table : {Table{16, 15, -15},
                             {32, 15, -16},
                             {40, 15.2, -24.6},
                             {64, 14.7, -25},
                             {128, 15, -24.8},
                             {64, -52.1, 52.1},
                             {128, -52.6, 52.6},
                             {16, 0.6, 40.7}}) {
    const auto begin = [&](int count) {
      return begin_of_table(count, table.channels, table.first_deg, table.last_deg);
    };
    EXPECT_EQ(load(begin(table.channels)).rings(), static_cast<std::size_t>(table.channels));
    for (const int count : {3, 15, 16, 40, 64, table.channels / 2, table.channels - 1})
      if (count < table.channels)
        expect_data_error(begin(count), "is the file cut off at the end?");
  }
  expect_data_error(begin_of_table(63, 64, 15, -25), "channel 63 at elevation");
  expect_data_error(begin_of_table(40, 64, 15, -25), "expected the last one below -12");
}

}  // namespace
}  // namespace adasplats
