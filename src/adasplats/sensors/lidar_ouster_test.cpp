// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/packet_sensor.h"

namespace adasplats {
namespace {

class OusterJson : public testing::Test {
 protected:
  LidarModel load(const std::string& text) const {
    return load_lidar_model(folder_.write("mine.json", text).string());
  }
  void expect_data_error(const std::string& text, const std::string& says) const {
    expect_error(ErrorKind::data, {"mine.json", says}, [&] { load(text); });
  }
  TemporaryFolder folder_;
};

/// All keys on one level, as firmware 2.x gives them.
const std::string kFlat =
    R"({"beam_altitude_angles": [10, -10.5], "beam_azimuth_angles": [3, -1],
        "lidar_mode": "512x20", "lidar_origin_to_beam_origin_mm": 15,
        "lidar_to_sensor_transform": [-1,0,0,0, 0,-1,0,0, 0,0,1,36, 0,0,0,1],
        "prod_line": "OS-0-2", "prod_sn": "7"})";

// Oracle: Ouster Sensor Documentation, "Lidar Range to XYZ" and "Sensor Coordinate Frame": with the
// encoder's angle theta (counter-clockwise), range r from the axis, n to the beam's origin.
Vec3d sdk_point(double column, double r_m, double n_m, double altitude_rad, double azimuth_rad) {
  const double encoder = 2 * std::numbers::pi * (1.0 - column / 512);
  const double along = encoder - azimuth_rad;
  const double x = (r_m - n_m) * std::cos(along) * std::cos(altitude_rad) + n_m * std::cos(encoder);
  const double y = (r_m - n_m) * std::sin(along) * std::cos(altitude_rad) + n_m * std::sin(encoder);
  return {-x, -y, (r_m - n_m) * std::sin(altitude_rad) + 0.036};
}

TEST_F(OusterJson, AReturnLiesWhereTheMakersFormulaPutsIt) {
  const LidarModel model = load(kFlat);
  EXPECT_EQ(model.columns, 512U);
  EXPECT_EQ(model.rotation_hz, 20);
  EXPECT_EQ(model.max_range_m, 50);  // of the OS0 of the library
  EXPECT_EQ(model.source, "mine.json, OS-0-2 7");
  const auto firings = firings_of(model);
  ASSERT_EQ(firings.size(), 1024U);
  for (const std::uint32_t column : {0U, 1U, 130U, 511U})
    for (const std::uint32_t beam : {0U, 1U}) {
      const Firing& firing = firings[512 * beam + column];
      const Vec3d expected = sdk_point(column, 20.015, 0.015, (beam == 0 ? 10 : -10.5) * kDegree,
                                       (beam == 0 ? 3 : -1) * kDegree);
      const Vec3d found =
          vec_cast<double>(firing.origin) + 20.0 * vec_cast<double>(firing.direction);
      EXPECT_LT(length(found - expected), 1e-5) << column << " " << beam;
      EXPECT_FLOAT_EQ(firing.time_s, static_cast<float>(column / 512.0 / 20));
    }
}

// Oracle: the same keys in groups, as firmware 3 gives them, give the same sensor.
TEST_F(OusterJson, GroupedKeysAreTheSame) {
  const LidarModel flat = load(kFlat);
  const LidarModel grouped = load(
      R"({"beam_intrinsics": {"beam_altitude_angles": [10, -10.5], "beam_azimuth_angles": [3, -1],
             "beam_to_lidar_transform": [1,0,0,15, 0,1,0,0, 0,0,1,0, 0,0,0,1],
             "lidar_origin_to_beam_origin_mm": 15},
          "config_params": {"lidar_mode": "512x20",
             "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16_DUAL"},
          "lidar_intrinsics": {"lidar_to_sensor_transform":
             [-1,0,0,0, 0,-1,0,0, 0,0,1,36, 0,0,0,1]},
          "sensor_info": {"prod_line": "OS-0-2"}})");
  EXPECT_EQ(grouped.max_returns, 2);
  ASSERT_TRUE(grouped.packets.has_value());
  EXPECT_EQ(grouped.packets->format, PacketFormat::ouster_dual);
  EXPECT_EQ(flat.max_returns, 1);
  EXPECT_EQ(grouped.first_azimuth_rad, flat.first_azimuth_rad);
  EXPECT_EQ(grouped.elevations_rad, flat.elevations_rad);
  EXPECT_EQ(grouped.azimuth_offsets_rad, flat.azimuth_offsets_rad);
  ASSERT_EQ(grouped.beam_origins_m.size(), 2U);
  EXPECT_EQ(grouped.beam_origins_m[0], flat.beam_origins_m[0]);
}

TEST_F(OusterJson, ContentTellsTheFormatWithoutAnExtension) {
  const auto file = folder_.write("metadata", "\n " + kFlat);
  EXPECT_EQ(load_lidar_model(file.string()).columns, 512U);
}

TEST_F(OusterJson, WrongFilesAreRefused) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = kFlat;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  expect_data_error("", "not valid JSON");
  expect_data_error("{\n\n\"a\": }", "mine.json:3: not valid JSON");
  expect_data_error("[1, 2]", "not a JSON object");
  expect_data_error("{}", "no beam_altitude_angles");
  expect_data_error(with("[10, -10.5]", "[10]"), "has 1 beams, beam_azimuth_angles 2");
  expect_data_error(with("[10, -10.5]", "[]"), "no beam_altitude_angles");
  expect_data_error(with("[10, -10.5]", "[10, \"x\"]"), "not a list of numbers");
  expect_data_error(with("[10, -10.5]", "[10, 91]"), "an angle of 91");
  expect_data_error(with("[10, -10.5]", "[10, NaN]"), "not valid JSON");
  expect_data_error(with("[10, -10.5]", "[10, 1e999]"), "not valid JSON");
  expect_data_error(with("512x20", "512"), "lidar_mode is '512'");
  expect_data_error(with("512x20", "0x20"), "lidar_mode");
  expect_data_error(with("512x20", "512xnan"), "lidar_mode");
  expect_data_error(with("512x20", "99999999999x10"), "lidar_mode");
  expect_data_error(with("\"lidar_mode\"", "\"lidar_mod\""), "lidar_mode is ''");
  expect_data_error(with("_mm\": 15", "_mm\": \"15\""), "is not a number");
  expect_data_error(with("_mm\": 15", "_mm\": 1e300"), "its beams start");
  expect_data_error(with("0,0,1,36", "0,0,1,1e60"), "its beams start");
  expect_data_error(with("0,0,1,36", "0,1,0,36"), "not a rotation about z");
  expect_data_error(with("0,0,1,36, ", ""), "not a rotation about z");
  expect_data_error(with("-1,0,0,0, 0", "-1,0,0,5, 0"), "moves the axis");
}

/// Metadata of firmware 1.13: lists of `listed` entries, of which every (listed / beams)-th is
/// used; without zeros as up to 1.12.
std::string padded(int listed, int beams, const std::string& product, bool has_zeros = true) {
  std::string altitudes, azimuths;
  for (int k = 0; k < listed; ++k) {
    const bool is_used = !has_zeros || k % (listed / beams) == listed / beams - 1;
    const std::string comma = k == 0 ? "" : ", ";
    altitudes += comma + (is_used ? std::to_string(15 - 0.5 * k) : "0");
    azimuths += comma + (is_used ? "-3.1" : "0");
  }
  return R"({"beam_altitude_angles": [)" + altitudes + R"(], "beam_azimuth_angles": [)" + azimuths +
         R"(], "lidar_mode": "1024x10", "prod_line": ")" + product + R"("})";
}

// Oracle: the product's number of beams; packets have a place for each entry of the lists.
TEST_F(OusterJson, PaddingIsNoBeam) {
  for (const int beams : {16, 32}) {
    const LidarModel model = load(padded(64, beams, "OS-1-" + std::to_string(beams) + "-A0"));
    ASSERT_EQ(model.elevations_rad.size(), static_cast<std::size_t>(beams));
    EXPECT_EQ(firings_of(model).size(), static_cast<std::size_t>(beams) * 1024);
    const int first = 64 / beams - 1;
    EXPECT_NEAR(model.elevations_rad[0], (15 - 0.5 * first) * kDegree, 1e-9);
    const PacketSensor sensor = packet_sensor(model);
    EXPECT_EQ(sensor.lasers(), 64U);
    EXPECT_EQ(sensor.laser_of_ring[1], 128 / beams - 1);
    EXPECT_EQ(sensor.ring_of_laser[0], kNoRing);
    EXPECT_EQ(load(padded(64, beams, "OS-1-" + std::to_string(beams), false)).elevations_rad,
              model.elevations_rad);
    EXPECT_EQ(load(calibration_file(sensor).text).elevations_rad.size(),
              model.elevations_rad.size());
  }
  EXPECT_EQ(load(padded(64, 16, "")).elevations_rad.size(), 16U);
  expect_data_error(padded(64, 16, "OS-1-32"), "16 beams that are not 0, prod_line is 'OS-1-32'");
  expect_data_error(padded(32, 32, "OS-1-64"), "have 32 beams, prod_line is 'OS-1-64'");
}

TEST_F(OusterJson, AnglesThatAreNotThoseOfBeamsAreErrors) {
  const auto with = [&](const std::string& altitudes, const std::string& azimuths) {
    return R"({"beam_altitude_angles": [)" + altitudes + R"(], "beam_azimuth_angles": [)" +
           azimuths + R"(], "lidar_mode": "1024x10"})";
  };
  expect_data_error(with("0, 0", "0, 0"), "all 2 beams have the elevation 0");
  expect_data_error(with("0, 0, 0, 0, 0, 0, 0, 0", "0, 0, 0, 0, 0, 0, 0, 0"),
                    "all 8 beams have the elevation 0");
  expect_data_error(with("0, 0", "1, 2"), "all 2 beams have the elevation 0");
  expect_data_error(with("1, 2, 1", "3, 3, 3"), "beams 0 and 2 (from 0) have the same angles");
  expect_data_error(with("0.35, 0.3, 0.2, 0.1, 0, -0.1, -0.2, -0.35", "0, 0, 0, 0, 0, 0, 0, 0"),
                    "span only 0.7 degrees");
  EXPECT_EQ(load(with("0", "0")).rings(), 1U);
  EXPECT_EQ(load(with("1, 0", "0, 0")).rings(), 2U);
}

// Oracle: the columns of the window, which may contain the start of a revolution.
TEST_F(OusterJson, OnlyColumnsOfTheWindowFire) {
  const auto columns_of = [&](const std::string& window) {
    std::string text = kFlat;
    text.insert(1, R"("data_format": {"column_window": )" + window + "},");
    const LidarModel model = load(text);
    const auto firings = firings_of(model);
    EXPECT_EQ(firings.size(), model.rays_per_scan());
    std::vector<std::uint32_t> columns;
    for (const Firing& firing : firings)
      if (firing.ring == 1) columns.push_back(firing.column);
    return columns;
  };
  EXPECT_EQ(columns_of("[0, 511]").size(), 512U);
  EXPECT_EQ(columns_of("[256, 255]").size(), 512U);
  EXPECT_EQ(columns_of("[7, 9]"), (std::vector<std::uint32_t>{7, 8, 9}));
  EXPECT_EQ(columns_of("[511, 1]"), (std::vector<std::uint32_t>{0, 1, 511}));
  EXPECT_EQ(columns_of("[510, 511]"), (std::vector<std::uint32_t>{510, 511}));
  for (const char* wrong : {"[0]", "[0, 512]", "[-1, 3]", "[0.5, 3]"}) {
    std::string text = kFlat;
    text.insert(1, R"("column_window": )" + std::string(wrong) + ",");
    expect_data_error(text, "column_window is not [first, last] of 512 columns");
  }
}

TEST_F(OusterJson, HostileFilesAreErrorsNotCrashes) {
  expect_data_error(std::string(1'000'000, '['), "not valid JSON");
  expect_data_error("{\"a\":" + std::string(200'000, '[') + std::string(200'000, ']') + "}",
                    "no beam_altitude_angles");
  expect_data_error(std::string("{\"a\0\xff\xfe", 6), "not valid JSON");
}

// Oracle: default_lidar_origin_to_beam_origin() of Ouster's SDK.
TEST_F(OusterJson, BeamsOfOldMetadataStartOffTheAxis) {
  const auto along_m = [&](const std::string& line) {
    return load(R"({"beam_altitude_angles": [10, -10.5], "beam_azimuth_angles": [3, -1],
                    "lidar_mode": "512x20")" +
                line + "}")
        .beam_origins_m[0]
        .x;
  };
  EXPECT_NEAR(along_m(""), 0.012163, 1e-9);
  EXPECT_NEAR(along_m(R"(, "prod_line": "OS-0-2")"), 0.02767, 1e-9);
}

}  // namespace
}  // namespace adasplats
