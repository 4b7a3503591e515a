// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lidar_model.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/words.h"

namespace adasplats {
namespace {

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

TEST(Firings, BeginAtTheFirstAzimuth) {
  LidarModel model = one_beam(0, 4);
  model.first_azimuth_rad = 180 * kDegree;
  model.clockwise = true;
  const auto firings = firings_of(model);
  expect_direction(firings[0].direction, {-1, 0, 0});
  expect_direction(firings[1].direction, {0, 1, 0});
  expect_direction(firings[3].direction, {0, -1, 0});
}

// Oracle: the head turns by 360 degrees * rotation_hz a second.
TEST(Firings, TheHeadTurnsOnUntilABeamFires) {
  LidarModel model = one_beam(0, 4);
  model.firing_times_s = {0.025};  // of 0.1 s: a quarter
  auto firings = firings_of(model);
  expect_direction(firings[0].direction, {0, 1, 0});
  EXPECT_FLOAT_EQ(firings[0].time_s, 0.025F);
  EXPECT_FLOAT_EQ(firings[3].time_s, 0.1F);
  model.clockwise = true;
  expect_direction(firings_of(model)[0].direction, {0, -1, 0});
  model.firing_times_s = {0, 0};
  EXPECT_THROW(firings_of(model), std::logic_error);
}

// Oracle: x of the head's frame points to the head's azimuth, whatever the beam's offset is.
TEST(Firings, OriginsTurnWithTheHead) {
  LidarModel model = one_beam(0, 4);
  EXPECT_EQ(firings_of(model)[1].origin, (Vec3f{0, 0, 0}));
  model.beam_origins_m = {{0.3, 0.1, 0.2}};
  model.azimuth_offsets_rad = {45 * kDegree};
  const auto firings = firings_of(model);
  expect_direction(firings[0].origin, {0.3, 0.1, 0.2});
  expect_direction(firings[1].origin, {-0.1, 0.3, 0.2});
  expect_direction(firings[2].origin, {-0.3, -0.1, 0.2});
  model.beam_origins_m = {{}, {}};
  EXPECT_THROW(firings_of(model), std::logic_error);
}

TEST(Firings, OfATurningSensorRepeat) {
  const LidarModel model = one_beam(0, 4);
  EXPECT_TRUE(repeats(model));
  EXPECT_EQ(firings_of(model, 5)[1].direction, firings_of(model)[1].direction);
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

/// The angles of an XT16.
std::string hesai_table() {
  std::string text = "Channel,Elevation,Azimuth\n";
  for (int k = 1; k <= 16; ++k)
    text += std::to_string(k) + "," + std::to_string(17 - 2 * k) + ",3\n";
  return text;
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

TEST_F(LidarFiles, EveryNewKeyOfATomlFileIsRead) {
  const LidarModel model = load_lidar_model(
      write("all.toml",
            "elevations_deg = [10, -10]\ncolumns = 8\nfirst_azimuth_deg = -90\n"
            "beam_origins_m = [[0.1, 0, 0.2], [0.3, 0.4, 0.5]]\nfiring_times_us = [1.5, 0]\n"
            "angular_noise_deg = 0.01\nrange_resolution_m = 0.002\n"
            "divergence_deg = [0.2, 0.1]\ndivergence_kind = \"1/e2\"\nmax_returns = 3\nsource = "
            "\"a book\"\n"));
  EXPECT_DOUBLE_EQ(model.first_azimuth_rad, -90 * kDegree);
  ASSERT_EQ(model.beam_origins_m.size(), 2U);
  EXPECT_EQ(model.beam_origins_m[1], (Vec3d{0.3, 0.4, 0.5}));
  EXPECT_DOUBLE_EQ(model.firing_times_s[0], 1.5e-6);
  EXPECT_DOUBLE_EQ(model.angular_noise_rad, 0.01 * kDegree);
  EXPECT_EQ(model.range_resolution_m, 0.002);
  EXPECT_DOUBLE_EQ(model.divergence_rad[0], 0.2 * kDegree);
  EXPECT_DOUBLE_EQ(model.divergence_rad[1], 0.1 * kDegree);
  EXPECT_EQ(model.divergence_kind, DivergenceKind::full_e2);
  EXPECT_EQ(model.max_returns, 3);
  EXPECT_EQ(model.source, "a book");
}

// Oracle: a full width at half maximum is sqrt(2 ln 2) / 2 of the full angle at 1/e^2.
TEST_F(LidarFiles, ADivergenceIsConvertedByItsKind) {
  const auto horizontal_rad = [&](const std::string& kind) {
    return load_lidar_model(write("kind.toml",
                                  "elevations_deg = [0]\ncolumns = 4\n"
                                  "divergence_deg = [0.2, 0.1]\n"
                                  "divergence_kind = \"" +
                                      kind + "\"\n"))
        .divergence_rad[0];
  };
  EXPECT_NEAR(horizontal_rad("fwhm"), 0.2 * kDegree * 2 / std::sqrt(2 * std::log(2.0)), 1e-12);
  EXPECT_NEAR(horizontal_rad("1/e2-half"), 0.4 * kDegree, 1e-12);
  EXPECT_NEAR(horizontal_rad("unknown"), 0.2 * kDegree, 1e-12);
  write("base.toml", "like = \"ouster-os1-128\"\nrange_noise_m = 0.5\n");
  const LidarModel like = load_lidar_model((folder_ / "base.toml").string());
  EXPECT_EQ(like.divergence_kind, DivergenceKind::fwhm);
  EXPECT_EQ(like.divergence_rad[0], load_lidar_model("ouster-os1-128").divergence_rad[0]);
}

TEST_F(LidarFiles, OneOriginStandsForAllBeams) {
  const LidarModel model = load_lidar_model(
      write("one.toml", "elevations_deg = [1, 0]\ncolumns = 4\nbeam_origins_m = [0.1, 0, 0.2]\n"));
  ASSERT_EQ(model.beam_origins_m.size(), 2U);
  EXPECT_EQ(model.beam_origins_m[1], (Vec3d{0.1, 0, 0.2}));
}

TEST_F(LidarFiles, BeamsAreSortedWithAllThatIsTheirs) {
  const LidarModel model = load_lidar_model(
      write("up.toml",
            "elevations_deg = [-5, 5, 0]\ncolumns = 4\nazimuth_offsets_deg = [1, 2, 3]\n"
            "firing_times_us = [10, 20, 30]\nbeam_origins_m = [[1,0,0], [2,0,0], [3,0,0]]\n"
            "column_steps = [1, 2, 1]\ncolumn_phases = [0, 1, 0]\n"));
  EXPECT_DOUBLE_EQ(model.elevations_rad[0], 5 * kDegree);
  EXPECT_DOUBLE_EQ(model.azimuth_offsets_rad[0], 2 * kDegree);
  EXPECT_DOUBLE_EQ(model.firing_times_s[0], 20e-6);
  EXPECT_EQ(model.beam_origins_m[0].x, 2);
  EXPECT_DOUBLE_EQ(model.elevations_rad[2], -5 * kDegree);
  const auto firings = firings_of(model);
  ASSERT_EQ(firings.size(), 10U);
  EXPECT_EQ(firings[0].column, 1U);
  EXPECT_EQ(firings[1].column, 3U);
  EXPECT_EQ(firings[2].ring, 1);
  EXPECT_EQ(model.columns, 4U);
}

// Oracle: the sensor of the library, but for what is said.
TEST_F(LidarFiles, ASensorCanBeLikeAnother) {
  const LidarModel vlp = load_lidar_model("velodyne-vlp-16");
  const LidarModel mine =
      load_lidar_model(write("mine.toml",
                             "like = \"velodyne-vlp-16\"\nrange_noise_m = 0.005\nrotation_hz = 20\n"
                             "columns = 904\n"));
  EXPECT_EQ(mine.name, "mine");
  EXPECT_EQ(mine.source, vlp.source);
  EXPECT_EQ(mine.elevations_rad, vlp.elevations_rad);
  EXPECT_EQ(mine.firing_times_s, vlp.firing_times_s);
  EXPECT_EQ(mine.range_noise_m, 0.005);
  EXPECT_EQ(mine.columns, 904U);
  EXPECT_EQ(mine.max_range_m, vlp.max_range_m);

  const LidarModel other_beams =
      load_lidar_model(write("other.toml", "like = \"mine.toml\"\nelevations_deg = [1, 0]\n"));
  EXPECT_EQ(other_beams.rings(), 2U);
  EXPECT_TRUE(other_beams.firing_times_s.empty());
  EXPECT_EQ(other_beams.rotation_hz, 20);

  const LidarModel skipping = load_lidar_model(
      write("skipping.toml", "like = \"hesai-ot128\"\ncolumns = 1800\nrotation_hz = 20\n"));
  EXPECT_EQ(skipping.rays_per_scan(), 345'600U / 2);

  const LidarModel rosette =
      load_lidar_model(write("livox.toml", "like = \"livox-mid-40\"\nmax_range_m = 90\n"));
  ASSERT_TRUE(rosette.rosette);
  EXPECT_EQ(rosette.max_range_m, 90);

  write("rays.csv", "0,0,0\n1,0,0.1\n");
  const LidarModel rays =
      load_lidar_model(write("like rays.toml", "like = \"rays.csv\"\nrange_noise_m = 0.01\n"));
  EXPECT_EQ(rays.rays_per_scan(), 2U);
  EXPECT_EQ(rays.range_noise_m, 0.01);
}

TEST_F(LidarFiles, WrongLikenessIsRefusedWithItsLine) {
  // Longer than the name of any file may be.
  expect_contains(toml_failure("like = \"" + std::string(300, 'x') + "\"\n"), "neither a sensor");
  expect_contains(toml_failure("\nlike = \"velodyne-vlp-17\"\n"), "did you mean 'velodyne-vlp-16'");
  expect_contains(toml_failure("\nlike = \"nothing.toml\"\n"),
                  "bad.toml:2: like is 'nothing.toml'");
  expect_contains(toml_failure("like = \"\"\n"), "neither a sensor nor a file");
  expect_contains(toml_failure("like = 1\n"), "is not a string");
  expect_contains(toml_failure("like = \"bad.toml\"\n"), "more than 8 files");
  expect_contains(toml_failure("like = \"velodyne-vlp-16\"\nrotation_hz = 20\n"),
                  "at most 1446 columns");
  expect_contains(toml_failure("like = \"livox-mid-40\"\ncolumns = 4\n"), "does not fit");
  write("rays.csv", "0,0,0\n1,0,0.1\n");
  const LidarModel half =
      load_lidar_model(write("half.toml", "like = \"rays.csv\"\nrotation_hz = 10\n"));
  EXPECT_EQ(half.rays_per_scan(), 1U);  // the pattern goes on in the next scan
  expect_contains(toml_failure("like = \"rays.csv\"\nclockwise = true\n"), "does not fit");
}

TEST_F(LidarFiles, WrongNewKeysAreRefusedWithTheirLine) {
  const std::string beams = "elevations_deg = [1, 0]\ncolumns = 4\n";
  const auto reject = [&](const std::string& line, const std::string& says) {
    expect_contains(toml_failure(beams + line + "\n"), says);
  };
  reject("firing_times_us = [1]", "bad.toml:3: firing_times_us has 1 values, expected 2");
  reject("firing_times_us = [1, -1]", "bad.toml:3: firing_times_us");
  reject("firing_times_us = [1, nan]", "bad.toml:3: firing_times_us");
  reject("firing_times_us = [1, 26000]", "bad.toml:2: columns leave 25000 us a column");
  reject("beam_origins_m = [1, 2]", "not [x, y, z]");
  reject("beam_origins_m = [[1, 2, 3]]", "has 1 values, expected 2");
  reject("beam_origins_m = [[1, 2, 3], 4]", "not a list [x, y, z]");
  reject("beam_origins_m = [[1, 2, 3], [1, 2, 'x']]", "bad.toml:3: beam_origins_m");
  reject("divergence_deg = [1, 1]", "bad.toml:3: divergence_deg needs divergence_kind");
  reject("divergence_deg = [1, 1]\ndivergence_kind = \"FWHM\"", "expected one of 'fwhm', '1/e2'");
  reject("divergence_deg = [1, 1]\ndivergence_kind = 1", "bad.toml:4: divergence_kind");
  reject("divergence_kind = \"fwhm\"", "bad.toml:3: divergence_kind needs divergence_deg");
  reject("divergence_deg = [60, 1]\ndivergence_kind = \"1/e2-half\"", "wider than 90 degrees");
  reject("divergence_deg = [1]", "is not [horizontal, vertical]");
  reject("divergence_deg = []", "is not a list of numbers");
  reject("max_returns = 0", "bad.toml:3: max_returns");
  reject("column_steps = [0, 1]", "bad.toml:3: column_steps");
  reject("column_phases = [0, 1]", "needs column_steps");
  reject("column_steps = [2, 2]\ncolumn_phases = [0, 2]", "not below its step");
  reject("[rosette]\npoints_per_s = 1", "cannot be combined with a rosette");
  reject("rosette = 1", "cannot be combined with a rosette");
}

TEST_F(LidarFiles, TooManyRaysAreRefused) {
  const std::string many = "beams = 60000\nelevation_top_deg = 1\nelevation_bottom_deg = 0\n";
  expect_contains(toml_failure(many + "columns = 16000000\n"), "960000000000 rays a scan");
  expect_contains(toml_failure("elevations_deg = [0]\ncolumns = 16000000\ncolumn_steps = [2]\n"),
                  "16000000 rays a scan");
}

TEST_F(LidarFiles, ARosetteIsRead) {
  const std::string start = "[rosette]\nprism_turns_per_minute = [600, -1200]\n";
  const LidarModel model = load_lidar_model(
      write("rosette.toml", start + "deflection_deg = [3, 1]\npoints_per_s = 4000\n"
                                    "laser_tilts_deg = [1, 0]\n"));
  ASSERT_TRUE(model.rosette);
  EXPECT_EQ(model.rosette->prism_hz[1], -20);
  EXPECT_DOUBLE_EQ(model.rosette->deflection_rad[0], 3 * kDegree);
  EXPECT_EQ(model.rays_per_scan(), 400U);
  EXPECT_EQ(model.rings(), 2U);
  expect_contains(toml_failure(start), "deflection_deg is missing");
  expect_contains(toml_failure(start + "deflection_deg = [3]\npoints_per_s = 4000\n"),
                  "is not one number a prism");
  expect_contains(toml_failure(start + "deflection_degrees = [3]\n"),
                  "did you mean 'deflection_deg'");
  expect_contains(toml_failure("rosette = 1\n"), "is not a table");
  expect_contains(toml_failure("rotation_hz = 0.001\n" + start +
                               "deflection_deg = [3, 1]\npoints_per_s = 1e9\n"),
                  "has 1000000000000 rays a scan, expected at most");
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
  expect_contains(toml_failure(beams + "beams = 3\ncolumns = 4\n"), "cannot be combined");
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
  toml_failure("a = [}");
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

TEST_F(LidarFiles, AHeaderNamesTheColumnsOfACsvInAnyOrder) {
  const auto firings =
      firings_of(load_lidar_model(write("named.csv", "Ring,Elevation_deg,Azimuth_deg\n2,0,90\n")));
  ASSERT_EQ(firings.size(), 1U);
  EXPECT_EQ(firings[0].ring, 2);
  expect_direction(firings[0].direction, {0, 1, 0});
  expect_contains(csv_failure("azimuth_deg,elevation_dge\n1,2\n"), "did you mean 'elevation_deg'");
  expect_contains(csv_failure("azimuth_deg,azimuth_deg\n1,2\n"), "two columns");
  expect_contains(csv_failure("azimuth_deg,time_s\n1,2\n"), "no column 'elevation_deg'");
  expect_contains(csv_failure("azimuth_deg,elevation_deg\n1,2,3\n"), "bad.csv:2: 3 values");
}

// Oracle: four rays at equal times fill a scan of 4/3 of the last time.
TEST_F(LidarFiles, TheTimesOfACsvTellHowLongAScanIs) {
  const auto hz = [&](const std::string& text) {
    return load_lidar_model(write("t.csv", text)).rotation_hz;
  };
  EXPECT_NEAR(hz("0,0,0\n1,0,0.0125\n2,0,0.025\n3,0,0.0375\n"), 20, 1e-5);
  EXPECT_EQ(hz("0,0\n1,0\n"), 10);
  EXPECT_EQ(hz("0,0,0\n"), 10);
  expect_contains(csv_failure("0,0,-1\n"), "time_s is negative");
}

// A time beyond float's range was an infinite one, and the sensor turned 0 times a second.
TEST_F(LidarFiles, TheTimesOfACsvAreThoseOfAScan) {
  expect_contains(csv_failure("0,0,0\n2,0,11" + std::string(60, '1') + "2\n"),
                  "bad.csv:2: time_s is '1111");
  expect_contains(csv_failure("0,0,1e39\n"), "bad.csv:1: time_s is '1e39', expected seconds");
  expect_contains(csv_failure("0,0,0\n0,1,86401\n"), "at most a day");
  EXPECT_DOUBLE_EQ(load_lidar_model(write("t.csv", "0,0,0\n1,0,86400\n")).rotation_hz,
                   1.0 / (2 * 86'400));
  expect_contains(csv_failure("0,0,0\n0,1,1e-44\n"), "scans a second, expected at most a million");
}

TEST_F(LidarFiles, ATableWithoutNamesThatBeginsWithTheTimeIsAnError) {
  std::string text;
  for (int i = 0; i < 40; ++i)
    text += std::to_string(0.01 * i) + "," + std::to_string(i % 7) + "," +
            std::to_string(80 + i % 9) + "\n";
  expect_contains(csv_failure(text), "column 1 ascends from ray to ray like a time");
}

// rs_driver writes elevation and azimuth of each channel without names.
TEST_F(LidarFiles, TablesOfChannelsWithoutNamesAreNotReadAsRays) {
  std::string channels, grid;
  for (int k = 0; k < 32; ++k) {
    channels += std::to_string(2.3 + 2.8 * k) + "," + std::to_string(k % 3) + "\n";
    grid += std::to_string(k % 8) + "," + std::to_string(k / 8) + "\n";
  }
  expect_contains(csv_failure(channels), "32 lines of two angles without names");
  EXPECT_EQ(load_lidar_model(write("g.csv", grid)).rays_per_scan(), 32U);
  EXPECT_EQ(
      load_lidar_model(write("r.csv", "azimuth_deg,elevation_deg\n" + channels)).rays_per_scan(),
      32U);
}

TEST_F(LidarFiles, TimesWithoutUnitMustBeSeconds) {
  const auto table = [](const std::string& name, double step) {
    std::string text = name + ",Azimuth/deg,Zenith/deg\n";
    for (int k = 0; k < 100; ++k)
      text += std::to_string(step * k) + "," + std::to_string(k) + ",80\n";
    return text;
  };
  expect_contains(csv_failure(table("Timestamp", 5000)), "5000 apart, expected at most 0.001 s");
  expect_contains(csv_failure(table("offset_time", 5000)), "such as time_ns");
  expect_contains(csv_failure(table("time", 5.5)), "such as time_us");
  const double step_s = 1e-4;
  EXPECT_NEAR(load_lidar_model(write("t.csv", table("Timestamp", step_s))).pattern_s, 0.01, 1e-6);
  EXPECT_NEAR(load_lidar_model(write("u.csv", table("timestamp_us", 100))).pattern_s, 0.01, 1e-6);
}

// Oracle: the table; zenith counts from +z. livox_laser_simulation has this header.
TEST_F(LidarFiles, ALivoxTableContinuesFromScanToScan) {
  std::string text = "Time/s,Azimuth/deg,Zenith/deg\r\n";
  constexpr int kRays = 250;  // of 0.25 s
  for (int k = 0; k < kRays; ++k)
    text += std::to_string(0.001 * k) + "," + std::to_string(k) + "," +
            std::to_string(90 - 0.1 * k) + "\r\n";
  const LidarModel model = load_lidar_model(write("avia.csv", text));
  EXPECT_EQ(model.rotation_hz, 10);
  EXPECT_EQ(model.rays_per_scan(), 100U);
  EXPECT_FALSE(repeats(model));
  EXPECT_FALSE(fires_at_once(model));
  for (const std::uint64_t scan : {0U, 1U, 2U, 3U, 1000U}) {
    const auto firings = firings_of(model, scan);
    ASSERT_EQ(firings.size(), 100U);
    for (std::size_t i = 0; i < firings.size(); ++i) {
      const auto k = static_cast<double>((100 * scan + i) % kRays);
      EXPECT_NEAR(elevation_deg(firings[i].direction), 0.1 * k, 1e-4);
      EXPECT_NEAR(firings[i].time_s, 0.001 * static_cast<double>(i), 1e-6);
      EXPECT_EQ(firings[i].column, i);
    }
  }
  expect_direction(firings_of(model)[90].direction, {0, static_cast<float>(std::cos(9 * kDegree)),
                                                     static_cast<float>(std::sin(9 * kDegree))});
  // A shorter table is one scan.
  const LidarModel brief =
      load_lidar_model(write("b.csv", "Time/s,Azimuth/deg,Zenith/deg\n0,0,90\n0.01,90,45\n"));
  EXPECT_EQ(brief.rotation_hz, 10);
  EXPECT_EQ(firings_of(brief, 7).size(), 2U);
  EXPECT_TRUE(repeats(brief));
}

// mid360.csv of livox_laser_simulation numbers its rows in the column Time/s; 4 s at 200 kHz.
TEST_F(LidarFiles, ALivoxTableMayNumberItsRows) {
  std::string text = "Time/s,Azimuth/deg,Zenith/deg\n";
  for (int k = 1; k <= 90'000; ++k)
    text += std::to_string(k) + "," + std::to_string(k % 360) + ",80\n";
  const LidarModel mid = load_lidar_model(write("mid360.csv", text));
  EXPECT_EQ(mid.rays_per_scan(), 20'000U);
  EXPECT_NEAR(firings_of(mid)[200].time_s, 0.001, 1e-6);
  EXPECT_NEAR(mid.pattern_s, 0.45, 1e-4);
  EXPECT_EQ(load_lidar_model(write("avia.csv", text)).rays_per_scan(), 24'000U);
  expect_contains(csv_failure("Time/s,Azimuth/deg,Zenith/deg\n0,0,90\n90000,0,91\n"), "a day");
}

// Oracle: half of the pattern, and then the other half.
TEST_F(LidarFiles, AFasterScanHasAPartOfThePattern) {
  LidarModel model = load_lidar_model(write("t.csv", "0,0,0\n1,0,0.025\n2,0,0.05\n3,0,0.075\n"));
  EXPECT_EQ(firings_of(model, 1).size(), 4U);
  model.rotation_hz = 20;
  const auto second = firings_of(model, 1);
  ASSERT_EQ(second.size(), 2U);
  EXPECT_NEAR(second[1].time_s, 0.025, 1e-6);
  EXPECT_NEAR(std::atan2(second[1].direction.y, second[1].direction.x), 3 * kDegree, 1e-6);
}

TEST_F(LidarFiles, RaysOfAFlashFireAtOnce) {
  EXPECT_TRUE(fires_at_once(load_lidar_model(write("f.csv", "0,0\n1,0\n2,0\n"))));
  EXPECT_TRUE(fires_at_once(load_lidar_model(write("f.csv", "0,0,0.5\n1,0,0.5\n"))));
  EXPECT_FALSE(fires_at_once(load_lidar_model(write("f.csv", "0,0,0\n1,0,0.01\n"))));
  EXPECT_FALSE(fires_at_once(hdl_64_paper()));
  EXPECT_FALSE(fires_at_once(load_lidar_model("livox-mid-40")));
}

TEST_F(LidarFiles, AnglesOfACsvInOtherUnits) {
  const auto first = [&](const std::string& text) {
    return firings_of(load_lidar_model(write("u.csv", text)))[0].direction;
  };
  expect_direction(first("azimuth_rad,elevation_rad\n1.5707963,0\n"), {0, 1, 0});
  expect_direction(first("Azimuth [deg],Elevation [deg],Time [us],Line\n90,0,5,1\n"), {0, 1, 0});
  expect_direction(first("zenith/rad,azimuth/rad\n0,0\n"), {0, 0, 1});
  std::string rows, zeros;
  for (int k = 0; k < 16; ++k) {
    rows += std::to_string(0.3 * k) + ",1.2\n";
    zeros += "0,0\n";
  }
  expect_contains(csv_failure(rows), "are they in radians?");
  expect_contains(csv_failure("Azimuth/deg,Zenith/deg\n" + rows), "are they in radians?");
  EXPECT_EQ(load_lidar_model(write("n.csv", "azimuth_deg,elevation_deg\n" + rows)).rays_per_scan(),
            16U);
  expect_contains(csv_failure(zeros), "all angles are 0");
  expect_contains(csv_failure("azimuth_deg,elevation_deg\n0,91\n"), "bad.csv:2: elevation is '91'");
  expect_contains(csv_failure("azimuth_deg,zenith_deg\n0,181\n"), "zenith is '181'");
  expect_contains(csv_failure("azimuth_s,elevation_deg\n0,1\n"), "unknown column 'azimuth_s'");
}

// Random changes, the same in each run: nothing but Error may escape.
TEST_F(LidarFiles, ChangedFilesAreErrorsNotCrashes) {
  const std::vector<std::pair<std::string, std::string>> seeds = {
      {"a.toml",
       "name = \"a\"\nelevations_deg = [1, 0]\ncolumns = 4\nfiring_times_us = [1, 0]\n"
       "beam_origins_m = [[0, 0, 1], [0, 0, 2]]\ncolumn_steps = [1, 2]\n"},
      {"b.toml",
       "[rosette]\nprism_turns_per_minute = [600, -1200]\ndeflection_deg = [3, 1]\n"
       "points_per_s = 4000\n"},
      {"a.json", R"({"beam_altitude_angles": [1, 0], "beam_azimuth_angles": [1, 0],
                     "lidar_mode": "16x10", "lidar_origin_to_beam_origin_mm": 1.5})"},
      {"a.yaml",
       "lasers:\n- {laser_id: 0, vert_correction: 0.1}\n- laser_id: 1\n"
       "  vert_correction: 0.2\nnum_lasers: 2\n"},
      {"a.csv", "azimuth_deg,elevation_deg,time_s,ring\n1,2,0.5,1\n2,2,0.6,1\n"},
      {"a_angle.csv", hesai_table()}};
  std::size_t loaded = 0;
  for (std::size_t seed = 0; seed < seeds.size(); ++seed)
    for (std::uint64_t run = 0; run < 50; ++run) {
      Random random(7, seed, run);
      std::string text = seeds[seed].second;
      const auto changes = 1 + random.next_bits() % 3;
      for (std::uint64_t change = 0; change < changes && !text.empty(); ++change) {
        const std::size_t at = random.next_bits() % text.size();
        constexpr std::string_view kBytes = "0159.-,:[]{}='\" \n#e\0\xff";
        switch (random.next_bits() % 3) {
          case 0: text[at] = kBytes[random.next_bits() % kBytes.size()]; break;
          case 1: text.erase(at, 1 + random.next_bits() % 5); break;
          default: text.insert(at, text.substr(0, random.next_bits() % 9)); break;
        }
      }
      try {
        const LidarModel model = load_lidar_model(write(seeds[seed].first, text));
        for (const double elevation_rad : model.elevations_rad)
          ASSERT_TRUE(std::isfinite(elevation_rad));
        ++loaded;
      } catch (const Error&) {
      }
    }
  EXPECT_GT(loaded, 10U);  // not all changes break a file
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

/// Relative intensity of a Gaussian beam at an angle to its axis.
double gaussian_intensity(double off_rad, double full_e2_rad) {
  const double radius = 0.5 * full_e2_rad;
  return std::exp(-2.0 * off_rad * off_rad / (radius * radius));
}

// Oracle: the definitions, on the profile of a Gaussian beam.
TEST(Divergence, ConvertsEveryKindToTheLevelOfAGaussianBeam) {
  const double stated = 3e-3;
  const double level = std::exp(-2.0);
  const auto at = [&](DivergenceKind kind, double off) {
    return gaussian_intensity(off, full_e2_angle_rad(stated, kind));
  };
  EXPECT_NEAR(at(DivergenceKind::fwhm, 0.5 * stated), 0.5, 1e-12);
  EXPECT_NEAR(at(DivergenceKind::full_e2, 0.5 * stated), level, 1e-12);
  EXPECT_NEAR(at(DivergenceKind::half_e2, stated), level, 1e-12);
  EXPECT_NEAR(at(DivergenceKind::unknown, 0.5 * stated), level, 1e-12);
}

// Oracle: the published factor; half the energy of a Gaussian beam lies within its half maximum.
TEST(Divergence, HalfTheEnergyLiesWithinTheHalfMaximum) {
  const double radius = 0.5 * full_e2_angle_rad(1.0, DivergenceKind::fwhm);
  EXPECT_NEAR(radius, 0.849, 5e-4);
  EXPECT_NEAR(1.0 - std::exp(-2.0 * 0.25 / (radius * radius)), 0.5, 1e-12);
}

TEST(Divergence, EveryKindHasAUniqueWord) {
  for (const auto& [word, kind] : kDivergenceKinds)
    EXPECT_EQ(word_of(kind, kDivergenceKinds), word);
  EXPECT_EQ(full_e2_angle_rad(0, DivergenceKind::fwhm), 0.0);
}

}  // namespace
}  // namespace adasplats
