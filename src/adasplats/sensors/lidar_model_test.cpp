// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lidar_model.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double elevation_deg(Vec3f d) {
  return std::atan2(static_cast<double>(d.z),
                    std::hypot(static_cast<double>(d.x), static_cast<double>(d.y))) /
         kDegree;
}

void expect_direction(Vec3f found, Vec3d expected) {
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(static_cast<double>(found[axis]), expected[axis], 1e-7) << "axis " << axis;
}

LidarModel one_beam(double elevation_rad, std::uint32_t columns) {
  LidarModel model;
  model.elevations_rad = {elevation_rad};
  model.columns = columns;
  return model;
}

// Oracle: the definition of azimuth and elevation.
TEST(Firings, AzimuthRunsFromForwardToTheLeft) {
  const auto firings = firings_of(one_beam(0, 4));
  ASSERT_EQ(firings.size(), 4U);
  expect_direction(firings[0].direction, {1, 0, 0});
  expect_direction(firings[1].direction, {0, 1, 0});
  expect_direction(firings[2].direction, {-1, 0, 0});
  expect_direction(firings[3].direction, {0, -1, 0});
}

TEST(Firings, ElevationIsUp) {
  expect_direction(firings_of(one_beam(90 * kDegree, 1))[0].direction, {0, 0, 1});
  expect_direction(firings_of(one_beam(-30 * kDegree, 1))[0].direction, {std::sqrt(0.75), 0, -0.5});
}

TEST(Firings, ClockwiseRunsToTheRight) {
  LidarModel model = one_beam(0, 4);
  model.clockwise = true;
  expect_direction(firings_of(model)[1].direction, {0, -1, 0});
}

TEST(Firings, AzimuthOffsetsTurnABeamCounterClockwise) {
  LidarModel model = one_beam(0, 4);
  model.azimuth_offsets_rad = {90 * kDegree};
  expect_direction(firings_of(model)[0].direction, {0, 1, 0});
  model.azimuth_offsets_rad = {0, 0};
  EXPECT_THROW(firings_of(model), std::logic_error);
}

TEST(Firings, ComeRingByRingWithColumnAndTime) {
  LidarModel model = one_beam(0, 5);
  model.elevations_rad = {0.1, 0.0};
  model.rotation_hz = 20;
  const auto firings = firings_of(model);
  ASSERT_EQ(firings.size(), model.rays_per_scan());
  EXPECT_EQ(model.rings(), 2U);
  for (std::size_t i = 0; i < firings.size(); ++i) {
    EXPECT_EQ(firings[i].ring, i / 5);
    EXPECT_EQ(firings[i].column, i % 5);
    EXPECT_FLOAT_EQ(firings[i].time_s, 0.05F * static_cast<float>(i % 5) / 5.0F);
  }
}

TEST(Firings, NoBeamsOrColumnsGiveNoRays) {
  EXPECT_TRUE(firings_of(LidarModel{}).empty());
  EXPECT_TRUE(firings_of(one_beam(0, 0)).empty());
}

// Oracle: paper section "Velodyne HDL-64".
TEST(Hdl64Paper, HasThePapersFan) {
  const LidarModel model = hdl_64_paper();
  const auto firings = firings_of(model);
  ASSERT_EQ(firings.size(), 144'000U);
  EXPECT_EQ(model.rays_per_scan(), 144'000U);
  EXPECT_EQ(model.rings(), 64U);
  EXPECT_EQ(model.max_range_m, 120.0);
  EXPECT_NEAR(elevation_deg(firings.front().direction), 2.0, 1e-5);
  EXPECT_NEAR(elevation_deg(firings.back().direction), -24.8, 1e-5);
  for (std::size_t ring = 1; ring < 64; ++ring)
    EXPECT_NEAR(model.elevations_rad[ring - 1] - model.elevations_rad[ring], 26.8 / 63 * kDegree,
                1e-12);
  for (const Firing& firing : firings) ASSERT_NEAR(length(firing.direction), 1.0F, 2e-7F);
}

// Oracle: paper section "Velodyne HDL-32".
TEST(Hdl32Paper, HasThePapersFan) {
  const LidarModel model = hdl_32_paper();
  const auto firings = firings_of(model);
  ASSERT_EQ(firings.size(), 57'600U);
  EXPECT_EQ(model.columns, 1800U);
  EXPECT_EQ(model.max_range_m, 100.0);
  EXPECT_NEAR(elevation_deg(firings.front().direction), 10.67, 1e-5);
  EXPECT_NEAR(elevation_deg(firings.back().direction), -30.67, 1e-5);
  EXPECT_NEAR(model.elevations_rad[0] - model.elevations_rad[1], 41.34 / 31 * kDegree, 1e-12);
}

class LidarFiles : public testing::Test {
 protected:
  LidarFiles()
      : folder_(std::filesystem::temp_directory_path() /
                ("adasplats sensors é " + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~LidarFiles() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    const auto path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  /// Loads a file that must fail and gives its message.
  static std::string failure(const std::string& path, ErrorKind kind) {
    try {
      load_lidar_model(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "no error for " << path;
    return "";
  }
  std::string toml_failure(const std::string& text) const {
    return failure(write("bad.toml", text), ErrorKind::config);
  }
  std::string csv_failure(const std::string& text) const {
    return failure(write("bad.csv", text), ErrorKind::data);
  }

  std::filesystem::path folder_;
};

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST_F(LidarFiles, KnownNamesAreLoaded) {
  for (const std::string& name : lidar_model_names()) EXPECT_EQ(load_lidar_model(name).name, name);
}

TEST_F(LidarFiles, AnUnknownNameNamesTheNearest) {
  expect_contains(failure("hdl64-paper", ErrorKind::usage), "did you mean 'hdl-64-paper'");
  expect_contains(failure("zzzzzzzzzzzzzzzzz", ErrorKind::usage), "hdl-32-paper");
}

TEST_F(LidarFiles, AMissingFileIsNoInput) {
  failure((folder_ / "none.toml").string(), ErrorKind::no_input);
  failure((folder_ / "none.csv").string(), ErrorKind::no_input);
}

// Oracle: round trip with the built-in model.
TEST_F(LidarFiles, TheFanOfATomlFileIsThatOfThePaper) {
  const LidarModel model =
      load_lidar_model(write("mine.toml",
                             "name = \"mine\"\nbeams = 64\nelevation_top_deg = 2.0\n"
                             "elevation_bottom_deg = -24.8\ncolumns = 2250\nmax_range_m = 120\n"));
  EXPECT_EQ(model.name, "mine");
  EXPECT_EQ(model.elevations_rad, hdl_64_paper().elevations_rad);
  EXPECT_EQ(model.columns, 2250U);
  EXPECT_EQ(model.max_range_m, 120.0);
}

TEST_F(LidarFiles, EveryKeyOfATomlFileIsRead) {
  const LidarModel model = load_lidar_model(
      write("all.toml",
            "elevations_deg = [10, 0.0, -10.5]\nazimuth_offsets_deg = [1, 2, -3]\n"
            "columns = 8\nrotation_hz = 20\nmin_range_m = 0.5\nmax_range_m = 50.5\n"
            "range_noise_m = 0.02\nclockwise = true\n"));
  EXPECT_EQ(model.name, "all");
  ASSERT_EQ(model.elevations_rad.size(), 3U);
  EXPECT_DOUBLE_EQ(model.elevations_rad[2], -10.5 * kDegree);
  EXPECT_DOUBLE_EQ(model.azimuth_offsets_rad[2], -3 * kDegree);
  EXPECT_EQ(model.columns, 8U);
  EXPECT_EQ(model.rotation_hz, 20.0);
  EXPECT_EQ(model.min_range_m, 0.5);
  EXPECT_EQ(model.max_range_m, 50.5);
  EXPECT_EQ(model.range_noise_m, 0.02);
  EXPECT_TRUE(model.clockwise);
}

TEST_F(LidarFiles, AFanOfOneBeamIsItsTop) {
  const LidarModel model = load_lidar_model(write(
      "one.toml", "beams = 1\nelevation_top_deg = 5\nelevation_bottom_deg = -5\ncolumns = 1"));
  ASSERT_EQ(model.elevations_rad.size(), 1U);
  EXPECT_DOUBLE_EQ(model.elevations_rad[0], 5 * kDegree);
}

TEST_F(LidarFiles, AnUnknownKeyIsNamedWithItsLineAndTheNearest) {
  const std::string text = toml_failure("elevations_deg = [0]\ncolumns = 4\nrotation_hertz = 10\n");
  expect_contains(text, "bad.toml:3:");
  expect_contains(text, "unknown key 'rotation_hertz', did you mean 'rotation_hz'");
}

TEST_F(LidarFiles, WrongTomlIsRefusedWithItsLine) {
  const std::string beams = "elevations_deg = [0]\n";
  expect_contains(toml_failure(beams + "columns = 4\ncolumns = 5\n"), "bad.toml:3:");
  expect_contains(toml_failure(beams + "columns = 'four'\n"), "bad.toml:2: columns");
  expect_contains(toml_failure(beams + "columns = 0\n"), "bad.toml:2: columns");
  expect_contains(toml_failure(beams + "columns = 4.5\n"), "bad.toml:2: columns");
  expect_contains(toml_failure(beams + "columns = 99999999999\n"), "bad.toml:2: columns");
  expect_contains(toml_failure(beams), "columns is missing");
  expect_contains(toml_failure("columns = 4\n"), "elevations_deg is missing");
  expect_contains(toml_failure("columns = 4\nbeams = 3\n"), "elevation_top_deg is missing");
  expect_contains(toml_failure(beams + "beams = 3\ncolumns = 4\n"), "cannot stand together");
  expect_contains(toml_failure("elevations_deg = []\ncolumns = 4\n"), "bad.toml:1: elevations_deg");
  expect_contains(toml_failure("elevations_deg = [0, nan]\ncolumns = 4\n"), "from -90 to 90");
  expect_contains(toml_failure("elevations_deg = [0,\n 91]\ncolumns = 4\n"), "bad.toml:2:");
  expect_contains(toml_failure(beams + "columns = 4\nazimuth_offsets_deg = [1, 2]\n"),
                  "has 2 values, expected 1");
  expect_contains(toml_failure(beams + "columns = 4\nrotation_hz = 0\n"),
                  "bad.toml:3: rotation_hz");
  expect_contains(toml_failure(beams + "columns = 4\nmin_range_m = 9\nmax_range_m = 9\n"),
                  "bad.toml:4: max_range_m");
  expect_contains(toml_failure(beams + "columns = 4\nclockwise = 1\n"), "neither true nor false");
  expect_contains(toml_failure(beams + "columns = 4\nname = 1\n"), "is not a string");
  expect_contains(toml_failure("columns = \n"), "bad.toml:1:");
}

TEST_F(LidarFiles, HostileTomlIsAnErrorNotACrash) {
  toml_failure("a = " + std::string(100'000, '['));
  toml_failure("a = " + std::string(100'000, '{'));
  std::string dotted = "a";
  for (int i = 0; i < 100'000; ++i) dotted += ".a";
  toml_failure(dotted + " = 1\n");
  toml_failure("[" + dotted + "]\n");
  toml_failure(dotted.substr(0, 16'000) + " = 1\n");  // as deep as the limit lets through
  toml_failure(std::string("\0\xff\xfe", 3));
}

// Oracle: the definition of azimuth and elevation.
TEST_F(LidarFiles, ACsvOfRaysIsAFreePattern) {
  const LidarModel model = load_lidar_model(
      write("rays.csv",
            "azimuth_deg,elevation_deg,time_s,ring\r\n0, 0, 0.01, 3\r\n\r\n# left\r\n"
            "90,0,0.02,1\r\n12.5,90,0.03,0"));
  EXPECT_EQ(model.name, "rays");
  EXPECT_EQ(model.rays_per_scan(), 3U);
  EXPECT_EQ(model.rings(), 4U);
  const auto firings = firings_of(model);
  expect_direction(firings[0].direction, {1, 0, 0});
  expect_direction(firings[1].direction, {0, 1, 0});
  expect_direction(firings[2].direction, {0, 0, 1});
  EXPECT_EQ(firings[1].ring, 1);
  EXPECT_EQ(firings[1].column, 1U);
  EXPECT_FLOAT_EQ(firings[1].time_s, 0.02F);
}

TEST_F(LidarFiles, ACsvNeedsOnlyTheAngles) {
  const LidarModel model = load_lidar_model(write("two.csv", "180,0\n-90,0\n"));
  const auto firings = firings_of(model);
  ASSERT_EQ(firings.size(), 2U);
  expect_direction(firings[0].direction, {-1, 0, 0});
  expect_direction(firings[1].direction, {0, -1, 0});
  EXPECT_EQ(model.rings(), 1U);
}

TEST_F(LidarFiles, WrongCsvIsRefusedWithItsLine) {
  expect_contains(csv_failure(""), "no rays");
  expect_contains(csv_failure("azimuth_deg,elevation_deg\n"), "no rays");
  expect_contains(csv_failure("1,2\n3\n"), "bad.csv:2: 1 values");
  expect_contains(csv_failure("1,2,3,4,5\n"), "bad.csv:1: 5 values");
  expect_contains(csv_failure("1,2\n\n1,x\n"), "bad.csv:3: elevation_deg is 'x'");
  expect_contains(csv_failure("nan,2\n"), "azimuth_deg is 'nan'");
  expect_contains(csv_failure("1,inf\n"), "elevation_deg is 'inf'");
  expect_contains(csv_failure("1,2,\n"), "time_s is ''");
  expect_contains(csv_failure("1,2,0,-1\n"), "ring is '-1'");
  expect_contains(csv_failure("1,2,0,65536\n"), "ring is '65536'");
  expect_contains(csv_failure("1;2\n"), "1 values");
}

}  // namespace
}  // namespace adasplats
