// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lidar_library.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "adasplats/core/constants.h"
#include "adasplats/core/recordings_test.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

class EveryLidar : public testing::TestWithParam<std::string> {};

// Oracle: what holds for every sensor.
TEST_P(EveryLidar, IsSane) {
  const LidarModel model = load_lidar_model(GetParam());
  EXPECT_EQ(model.name, GetParam());
  EXPECT_FALSE(model.source.empty());
  EXPECT_TRUE(std::ranges::is_sorted(model.elevations_rad, std::greater<>()));
  EXPECT_LT(model.min_range_m, model.max_range_m);
  EXPECT_GE(model.max_returns, 1);
  const auto firings = firings_of(model);
  ASSERT_EQ(firings.size(), model.rays_per_scan());
  ASSERT_GT(firings.size(), 9'000U);
  const std::size_t rings = model.rings();
  for (const Firing& firing : firings) {
    ASSERT_NEAR(length(firing.direction), 1.0F, 2e-7F);
    ASSERT_LT(length(firing.origin), 0.3F);
    ASSERT_GE(firing.time_s, 0.0F);
    ASSERT_LE(static_cast<double>(firing.time_s) * model.rotation_hz, 1.0);
    ASSERT_LT(firing.ring, rings);
  }
}

TEST_P(EveryLidar, NamesWhereItsNumbersAreFrom) {
  const auto library = lidar_library();
  const auto lidar = std::ranges::find(library, GetParam(), &LibraryLidar::name);
  ASSERT_NE(lidar, library.end());
  EXPECT_NE(lidar->toml.find("source = \""), std::string_view::npos);
  EXPECT_TRUE(lidar->toml.starts_with("# SPDX-FileCopyrightText")) << "embedded whole";
  EXPECT_TRUE(lidar->toml.ends_with("\n"));
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Library, EveryLidar, testing::ValuesIn(lidar_model_names()), test_name);

struct Published {
  std::size_t beams;
  std::size_t rays;
  double top_deg;
  double bottom_deg;
};

// Oracle: beams, points and fields of view as the makers' data sheets have them.
TEST(LidarLibrary, HasThePublishedFans) {
  const std::map<std::string, Published> published = {
      {"hdl-64-paper", {64, 144'000, 2, -24.8}},
      {"hdl-32-paper", {32, 57'600, 10.67, -30.67}},
      {"velodyne-vlp-16", {16, 16 * 1808, 15, -15}},
      {"velodyne-vlp-32c", {32, 32 * 1808, 15, -25}},
      {"velodyne-hdl-32e", {32, 32 * 2170, 10.67, -30.67}},
      {"velodyne-vls-128", {128, 128 * 1876, 15, -25}},
      {"velodyne-hdl-64e-kitti", {64, 64 * 2152, 1.9367, -24.9993}},
      {"ouster-os0-128", {128, 131'072, 45.75, -46.26}},
      {"ouster-os1-64", {64, 65'536, 16.729, -16.679}},
      {"ouster-os1-128", {128, 131'072, 20.47, -21.95}},
      {"ouster-os2-128", {128, 131'072, 10.76, -11.09}},
      {"hesai-pandar64", {64, 115'200, 14.708, -25.071}},
      {"hesai-pandarxt-32", {32, 64'000, 15, -16}},
      {"hesai-ot128", {128, 345'600, 14.985, -24.765}}};
  for (const auto& [name, expected] : published) {
    const LidarModel model = load_lidar_model(name);
    EXPECT_EQ(model.elevations_rad.size(), expected.beams) << name;
    EXPECT_EQ(model.rays_per_scan(), expected.rays) << name;
    EXPECT_NEAR(model.elevations_rad.front() / kDegree, expected.top_deg, 1e-4) << name;
    EXPECT_NEAR(model.elevations_rad.back() / kDegree, expected.bottom_deg, 1e-4) << name;
    EXPECT_EQ(model.clockwise, !name.ends_with("-paper")) << name;
  }
}

// Oracle: VLP-16 User Manual 63-9243: laser 1 (+1 degree) is the second to fire, 2.304 us behind
// the first, while the head turns 0.0083 degrees at 10 Hz, clockwise.
TEST(LidarLibrary, Vlp16FiresInTheManualsOrder) {
  const LidarModel model = load_lidar_model("velodyne-vlp-16");
  EXPECT_NEAR(model.elevations_rad[7] / kDegree, 1.0, 1e-9);
  EXPECT_NEAR(model.firing_times_s[7], 2.304e-6, 1e-12);
  EXPECT_NEAR(model.firing_times_s[15], 0, 1e-12);        // laser 0, -15 degrees
  EXPECT_NEAR(model.firing_times_s[0], 34.56e-6, 1e-12);  // laser 15, +15 degrees
  const auto firings = firings_of(model);
  const Firing& laser_1 = firings[7 * 1808];
  EXPECT_NEAR(std::atan2(laser_1.direction.y, laser_1.direction.x) / kDegree, -2.304e-6 * 10 * 360,
              1e-6);
  EXPECT_NEAR(static_cast<double>(laser_1.time_s), 2.304e-6, 1e-12);
}

// Oracle: VLP-32C User Manual 63-9325, table 9-2: laser 0 looks 1.4 degrees ahead (clockwise) of
// the encoder at -25 degrees, laser 1 4.2 degrees behind at -1.
TEST(LidarLibrary, AzimuthOffsetsTurnTheRightWay) {
  const LidarModel model = load_lidar_model("velodyne-vlp-32c");
  EXPECT_NEAR(model.elevations_rad[31] / kDegree, -25, 1e-4);
  EXPECT_NEAR(model.azimuth_offsets_rad[31] / kDegree, -1.4, 1e-4);
  const auto laser_1 = std::ranges::find_if(
      model.elevations_rad, [](double e) { return std::fabs(e / kDegree + 1.0) < 1e-3; });
  ASSERT_NE(laser_1, model.elevations_rad.end());
  const auto index = static_cast<std::size_t>(laser_1 - model.elevations_rad.begin());
  EXPECT_NEAR(model.azimuth_offsets_rad[index] / kDegree, 4.2, 1e-4);
}

// Oracle: the fit's README: 0.20 to 0.21 m above the frame's origin for the rings 0 to 31, 0.12 to
// 0.13 m for 32 to 63; a frame begins at the rear and passes the left first.
TEST(LidarLibrary, KittiHasTwoBlocksAndBeginsAtTheRear) {
  const LidarModel model = load_lidar_model("velodyne-hdl-64e-kitti");
  for (std::size_t ring = 0; ring < 64; ++ring) {
    EXPECT_NEAR(model.beam_origins_m[ring].z, ring < 32 ? 0.2035 : 0.121, 0.006);
    EXPECT_EQ(model.beam_origins_m[ring].x, 0);
  }
  const auto firings = firings_of(model);
  EXPECT_LT(firings[0].direction.x, -0.99F);
  EXPECT_GT(firings[2152 / 4].direction.y, 0.99F);
  EXPECT_GT(firings[2152 / 2].direction.x, 0.99F);
  EXPECT_NEAR(static_cast<double>(firings[2152 / 2].time_s), 0.0516, 1e-4);
}

// Oracle: HDL-64E S2 manual: two blocks, the upper one higher; the beams of each leave 26 mm left
// or right of the axis.
TEST(LidarLibrary, TheUpperBlockOfAnHdl64IsHigher) {
  for (const char* name : {"velodyne-hdl-64e-s2", "velodyne-hdl-64e-s3"}) {
    const LidarModel model = load_lidar_model(name);
    EXPECT_GT(model.beam_origins_m.front().z, model.beam_origins_m.back().z + 0.04) << name;
    for (std::size_t ring = 0; ring < 64; ++ring) {
      const double offset_rad = model.azimuth_offsets_rad[ring];
      const Vec3d origin = model.beam_origins_m[ring];
      const double left_m = std::cos(offset_rad) * origin.y - std::sin(offset_rad) * origin.x;
      EXPECT_NEAR(std::fabs(left_m), 0.026, 2e-5) << name << " " << ring;
    }
  }
}

// Oracle: Ouster Sensor Documentation: the beam leaves n mm from the axis, along the encoder's
// azimuth, which begins at the connector (behind) and runs clockwise; the beam itself looks
// beam_azimuth_angle further clockwise. n = 12.163 mm, 36.18 mm up, first beam 3.073 degrees.
TEST(LidarLibrary, AnOusterBeamLeavesAlongItsEncodersAzimuth) {
  const auto firings = firings_of(load_lidar_model("ouster-os1-64"));
  const Firing& first = firings[0];
  EXPECT_NEAR(static_cast<double>(first.origin.x), -0.012163, 1e-7);
  EXPECT_NEAR(static_cast<double>(first.origin.y), 0, 1e-7);
  EXPECT_NEAR(static_cast<double>(first.origin.z), 0.03618, 1e-7);
  EXPECT_NEAR(std::atan2(first.direction.y, first.direction.x) / kDegree, 180 - 3.073, 1e-4);
  const Firing& quarter = firings[256];  // a quarter clockwise from the rear: the left
  EXPECT_NEAR(static_cast<double>(quarter.origin.y), 0.012163, 1e-7);
  EXPECT_GT(quarter.direction.y, 0.9F);
}

// Oracle: OT128 user manual: in High Resolution mode channels 25 to 88 fire each 0.1 degrees, the
// others each 0.2.
TEST(LidarLibrary, Ot128SkipsColumns) {
  const LidarModel model = load_lidar_model("hesai-ot128");
  std::vector<std::size_t> rays(128, 0);
  std::vector<std::uint32_t> first(128, 99);
  for (const Firing& firing : firings_of(model)) {
    ++rays[firing.ring];
    first[firing.ring] = std::min(first[firing.ring], firing.column);
  }
  for (std::size_t ring = 0; ring < 128; ++ring)
    EXPECT_EQ(rays[ring], ring >= 24 && ring < 88 ? 3600U : 1800U) << ring;
  EXPECT_EQ(first[0], 1U);  // channel 1 fires in the states 1 and 3, channel 3 in 0 and 2
  EXPECT_EQ(first[2], 0U);
}

// Oracle: Livox Mid Series User Manual: a circle of 38.4 degrees, 100,000 points a second.
TEST(LidarLibrary, Mid40FillsACircle) {
  const auto firings = firings_of(load_lidar_model("livox-mid-40"), 123);
  EXPECT_EQ(firings.size(), 10'000U);
  double farthest_deg = 0;
  for (const Firing& firing : firings)
    farthest_deg = std::max(
        farthest_deg, std::acos(std::min(1.0, static_cast<double>(firing.direction.x))) / kDegree);
  EXPECT_NEAR(farthest_deg, 19.2, 1e-2);
}

void expect_same_beams(const LidarModel& found, const LidarModel& expected) {
  ASSERT_EQ(found.elevations_rad.size(), expected.elevations_rad.size());
  EXPECT_EQ(found.columns, expected.columns);
  EXPECT_NEAR(found.first_azimuth_rad, expected.first_azimuth_rad, 1e-6);
  EXPECT_EQ(found.rotation_hz, expected.rotation_hz);
  const auto a = firings_of(found);
  const auto b = firings_of(expected);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_LT(length(vec_cast<double>(a[i].direction - b[i].direction)), 3e-6) << i;
    ASSERT_LT(length(vec_cast<double>(a[i].origin - b[i].origin)), 1e-5) << i;
    ASSERT_NEAR(static_cast<double>(a[i].time_s), static_cast<double>(b[i].time_s), 1e-8) << i;
  }
}

// Oracle: the makers' own files, which give what the library has.
TEST(LidarLibrary, TheMakersFilesGiveTheSame) {
  const auto folder = recording("../sensors");
  if (!folder) GTEST_SKIP() << kNoRecordings;
  const std::map<std::string, std::string> files = {
      {"velodyne_vlp-16.yaml", "velodyne-vlp-16"},
      {"velodyne_hdl-32e.yaml", "velodyne-hdl-32e"},
      {"velodyne_vlp-32c.yaml", "velodyne-vlp-32c"},
      {"velodyne_vls-128.yaml", "velodyne-vls-128"},
      {"velodyne_hdl-64e_s2.1.yaml", "velodyne-hdl-64e-s2"},
      {"velodyne_hdl-64e_s3.yaml", "velodyne-hdl-64e-s3"},
      {"ouster_os1-64.json", "ouster-os1-64"},
      {"ouster_os-128.json", "ouster-os1-128"},
      {"hesai_pandar64_angle.csv", "hesai-pandar64"},
      {"hesai_ot128_angle.csv", "hesai-ot128"}};
  for (const auto& [file, name] : files) {
    SCOPED_TRACE(file);
    const LidarModel found = load_lidar_model((*folder / file).string());
    expect_same_beams(found, load_lidar_model(name));
    EXPECT_TRUE(found.source.starts_with(file)) << found.source;
  }
}

}  // namespace
}  // namespace adasplats
