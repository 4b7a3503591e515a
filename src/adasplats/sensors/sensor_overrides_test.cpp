// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/sensor_overrides.h"

#include <gtest/gtest.h>

#include <string>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

// The firing times of the user manuals: 57.6 us (HDL-64E S3), 55.296 us (VLP-16), 50 us (XT32).
TEST(SensorOverrides, SpinningSensorsKeepTheirFiringTimes) {
  for (const char* name : {"velodyne-hdl-64e-s3", "velodyne-vlp-16", "hesai-pandarxt-32"}) {
    const LidarModel at_10 = load_lidar_model(name);
    for (const double rate_hz : {5.0, 20.0}) {
      LidarModel other = at_10;
      SensorOverrides overrides;
      overrides.rotation_hz = rate_hz;
      overrides.apply(other);
      EXPECT_EQ(other.rotation_hz, rate_hz);
      EXPECT_NEAR(other.columns * rate_hz / (at_10.columns * at_10.rotation_hz), 1, 1e-3) << name;
      EXPECT_EQ(other.firing_times_s, at_10.firing_times_s);
    }
    LidarModel same = at_10;
    SensorOverrides{{}, {}, {}, at_10.rotation_hz}.apply(same);
    EXPECT_EQ(same.columns, at_10.columns);
  }
}

TEST(SensorOverrides, RejectsRatesThatSensorsCannotHave) {
  LidarModel sensor = load_lidar_model("velodyne-vlp-16");
  for (const double rate_hz : {0.001, 1e4}) {
    SensorOverrides overrides;
    overrides.rotation_hz = rate_hz;
    EXPECT_THROW(overrides.apply(sensor), Error) << rate_hz;
  }
  LidarModel listed = load_lidar_model("hesai-ot128");
  ASSERT_FALSE(listed.free_pattern.empty());
  EXPECT_THROW((SensorOverrides{{}, {}, {}, 20}.apply(listed)), Error);
}

TEST(SensorOverrides, OustersHaveTheColumnsOfTheirMode) {
  LidarModel sensor = load_lidar_model("ouster-os1-128");
  const auto columns = sensor.columns;
  SensorOverrides{{}, {}, {}, 20}.apply(sensor);
  EXPECT_EQ(sensor.columns, columns);
  EXPECT_EQ(sensor.rotation_hz, 20);
}

}  // namespace
}  // namespace adasplats
