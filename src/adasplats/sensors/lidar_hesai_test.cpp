// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

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

const char* const kThree = "Channel,Elevation,Azimuth\r\n1,5,-1.5\r\n2,-3,0\r\n3,0,2\r\n";

// Oracle: a channel looks at the block's azimuth plus its own, clockwise.
TEST_F(HesaiCsv, AzimuthsRunClockwise) {
  const LidarModel model = load(kThree);
  EXPECT_EQ(model.rings(), 3U);
  EXPECT_TRUE(model.clockwise);
  EXPECT_DOUBLE_EQ(model.elevations_rad[1], 0);  // sorted
  EXPECT_DOUBLE_EQ(model.azimuth_offsets_rad[1], -2 * kDegree);
  const Firing first = firings_of(model)[0];
  EXPECT_NEAR(std::atan2(first.direction.y, first.direction.x) / kDegree, 1.5, 1e-5);
}

// Oracle: times by hand; the earliest becomes 0 and the head is where it was then.
TEST_F(HesaiCsv, FiringTimesLieBesideTheAngles) {
  folder_.write("my_firetime.csv", "Channel,fire time(us)\n3,-1\n1,-50\n2,-10.5\n");
  const LidarModel model = load(kThree);
  ASSERT_EQ(model.firing_times_s.size(), 3U);
  EXPECT_NEAR(model.firing_times_s[0], 0, 1e-12);        // channel 1
  EXPECT_NEAR(model.firing_times_s[1], 49e-6, 1e-12);    // channel 3
  EXPECT_NEAR(model.firing_times_s[2], 39.5e-6, 1e-12);  // channel 2
  // 50 us before its block began the head, which turns clockwise, was 0.18 degrees to the left.
  EXPECT_NEAR(model.first_azimuth_rad / kDegree, 0.18, 1e-9);
}

// Oracle: what each channel's states say; channel 3 fires in every one.
TEST_F(HesaiCsv, StatesOfTheAzimuthAreColumns) {
  folder_.write("my_firetime.csv",
                "Operational State,0,0,0,0,2,2\nAzimuth State,0,1,2,3,0,1\n"
                "1,-,18,-,18,46,46\n2,6,-,6,-,6,6\n3,20,20,22,20,20,22\n");
  const LidarModel model = load(kThree);
  std::vector<std::size_t> rays(3, 0);
  for (const Firing& firing : firings_of(model)) {
    ++rays[firing.ring];
    if (firing.ring == 0) {
      ASSERT_EQ(firing.column % 2, 1U);
    }
    if (firing.ring == 2) {
      ASSERT_EQ(firing.column % 2, 0U);
    }
  }
  EXPECT_EQ(rays, (std::vector<std::size_t>{900, 1800, 900}));
  EXPECT_EQ(model.rays_per_scan(), 3600U);
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
  EXPECT_EQ(load(std::string(kThree) + std::string(64, 'a') + "\r\n").rings(), 3U);
  expect_data_error(std::string(kThree) + std::string(63, 'a') + "\n", "my_Angle.csv:5: 1 values");
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
    expect_error(ErrorKind::data, {"my_firetime.csv", says}, [&] { load(kThree); });
  };
  reject("", "expected the columns");
  reject("Channel,fire time(us)\n1,0\n2,0\n", "no channel 3");
  reject("Channel,fire time(us)\n1,-1e300\n2,-1e300\n3,-1e300\n", "more than a revolution");
  reject("Channel,fire time(us)\n1,nan\n", "my_firetime.csv:2: fire time is 'nan'");
  reject("Operational State,0,0\nAzimuth State,0,1\n1,-,-\n", "never fires");
  reject("Operational State,0,0,0\nAzimuth State,0,1,2\n1,-,1,1\n", "uneven");
  reject("Operational State,0,0,0,0\nAzimuth State,0,1,2,3\n1,1,1,-,-\n", "uneven");
  reject("Operational State\n", "no operational states");
  reject("Channel,fire time(us)\n1,0\n2,0\n3,60\n", "us a column");
}

}  // namespace
}  // namespace adasplats
