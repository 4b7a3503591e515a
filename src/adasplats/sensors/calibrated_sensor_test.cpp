// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/calibrated_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

std::vector<double> waves(std::size_t count, double height) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k)
    values.push_back(height * std::sin(0.9 * static_cast<double>(k)));
  return values;
}

// Oracle: the library's sensor.
TEST(CalibratedSensor, IsTheSensorOfTheLibraryWithItsOffsets) {
  const TemporaryFolder folder;
  for (const std::string& name : lidar_model_names()) {
    const LidarModel known = load_lidar_model(name);
    if (known.rosette) continue;
    const auto elevations_rad = waves(known.rings(), 2e-4), ranges_m = waves(known.rings(), 0.03);
    const auto file =
        folder.write("unit.toml", calibrated_sensor_toml(name, {ranges_m, elevations_rad}));
    const LidarModel unit = load_lidar_model(file.string());
    EXPECT_EQ(unit.name, name + "-unit");
    EXPECT_EQ(unit.max_returns, known.max_returns) << name;
    EXPECT_EQ(unit.range_noise_m, known.range_noise_m) << name;
    EXPECT_EQ(unit.divergence_rad[1], known.divergence_rad[1]) << name;
    const auto firings = firings_of(unit), expected = firings_of(known);
    ASSERT_EQ(firings.size(), expected.size()) << name;
    for (std::size_t i = 0; i < firings.size(); i += 97) {
      const std::uint16_t ring = expected[i].ring;
      ASSERT_EQ(firings[i].ring, ring) << name;
      ASSERT_EQ(firings[i].time_s, expected[i].time_s) << name;
      ASSERT_EQ(firings[i].origin, expected[i].origin) << name;
      const auto elevation = [](const Firing& firing) {
        return std::asin(static_cast<double>(firing.direction.z));
      };
      ASSERT_NEAR(elevation(firings[i]) - elevation(expected[i]), elevations_rad[ring], 1e-6)
          << name;
    }
    ASSERT_EQ(unit.range_offsets_m.size(), ranges_m.size()) << name;
    for (std::size_t k = 0; k < ranges_m.size(); ++k)
      ASSERT_NEAR(unit.range_offsets_m[k], ranges_m[k], 0.51e-5) << name;
  }
}

// Oracle: analytic. Beams are sorted, topmost first, and offsets go with them.
TEST(CalibratedSensor, OffsetsOfRangesAreOneABeamAndSortedWithThem) {
  const TemporaryFolder folder;
  const auto low_first =
      folder.write("low.toml", std::string("columns = 4\nelevations_deg = [-1, 2]\n"
                                           "range_offsets_m = [0.01, -0.02]\n"));
  EXPECT_EQ(load_lidar_model(low_first.string()).range_offsets_m,
            (std::vector<double>{-0.02, 0.01}));
  const auto short_list = folder.write(
      "short.toml", std::string("columns = 4\nelevations_deg = [-1, 2]\nrange_offsets_m = [1]\n"));
  expect_error(ErrorKind::config, {"range_offsets_m has 1 values, expected 2"},
               [&] { load_lidar_model(short_list.string()); });
}

SensorIntensity intensity_of_two_levels(std::size_t rings) {
  SensorIntensity unit;
  unit.step = 0.01;
  unit.highest = 0.99;
  unit.ring_nodes = 2;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    unit.ring_expected.insert(unit.ring_expected.end(), {0.1F, 0.5F});
    unit.ring_level.insert(unit.ring_level.end(), {0.125F, 0.5F + static_cast<float>(ring) / 128});
  }
  unit.levels = {0.125F, 0.75F};
  unit.zero_share = {0.5F, 0.25F};
  for (std::size_t k = 0; k < 2 * kTextureNodes; ++k)
    unit.reported.push_back(static_cast<float>(k) / 32);
  return unit;
}

// Oracle: what was written.
TEST(CalibratedSensor, TraitsAreReadBack) {
  const TemporaryFolder folder;
  const std::string name = "velodyne-vlp-16";
  const SensorIntensity intensity = intensity_of_two_levels(16);
  std::vector<double> noise_m;
  for (int ring = 0; ring < 16; ++ring) noise_m.push_back(0.001 * (ring + 1));
  SensorTraits traits;
  traits.ring_noise_m = noise_m;
  traits.max_range_m = 79.5;
  traits.intensity = &intensity;
  SensorFields fields{2, 16, 5, {}};
  for (std::size_t i = 0; i < 2 * 16 * 5 * kSensorFields; ++i)
    fields.bytes.push_back(static_cast<std::uint8_t>(7 * i));
  traits.fields = &fields;
  RayDropModel drop;
  drop.weights = {-2, 0.5, 0, 0, 1, 0, 0.25, 0};
  drop.usual_reflectance = 0.2;
  drop.edge_runs = {0.2, 0.1};
  drop.fitted_to = "here";
  drop.blocked = {{-0.2F, -0.5F, 0.5F}, {0.1F, 1, 2}, {0.1F, 2.5F, 3}};
  traits.drop = &drop;
  const VehicleBody body = {
      {{3, 0, 0.5F, 1.5F, 0.25F}, {3, 719, 1, 2.001F, 0}, {4, 5, 0.25F, 3, 1}}};
  traits.body = &body;
  traits.fitted_to = "3 scans of here";
  const auto file = folder.write("unit.toml", calibrated_sensor_toml(name, {}, traits));
  const LidarModel unit = load_lidar_model(file.string());
  ASSERT_EQ(unit.ring_noise_m.size(), noise_m.size());
  for (std::size_t k = 0; k < noise_m.size(); ++k)
    EXPECT_NEAR(unit.ring_noise_m[k], noise_m[k], 0.51e-5);
  EXPECT_EQ(unit.max_range_m, 79.5);
  EXPECT_NE(unit.source.find("3 scans of here"), std::string::npos);
  ASSERT_TRUE(unit.intensity.has_value());
  EXPECT_EQ(unit.intensity->step, 0.01);
  EXPECT_EQ(unit.intensity->highest, 0.99);
  EXPECT_EQ(unit.intensity->ring_nodes, 2U);
  for (std::size_t k = 0; k < 32; ++k)
    EXPECT_NEAR(unit.intensity->ring_level[k], intensity.ring_level[k], 1e-6F);
  EXPECT_EQ(unit.intensity->ring_expected, intensity.ring_expected);
  EXPECT_EQ(unit.intensity->levels, intensity.levels);
  EXPECT_EQ(unit.intensity->zero_share, intensity.zero_share);
  EXPECT_EQ(unit.intensity->reported, intensity.reported);
  ASSERT_TRUE(unit.fields.has_value());
  EXPECT_EQ(unit.fields->turns, 2U);
  EXPECT_EQ(unit.fields->rings, 16U);
  EXPECT_EQ(unit.fields->columns, 5U);
  EXPECT_EQ(unit.fields->bytes, fields.bytes);
  ASSERT_TRUE(unit.drop.has_value());
  EXPECT_EQ(unit.drop->weights, drop.weights);
  EXPECT_EQ(unit.drop->usual_reflectance, 0.2);
  EXPECT_EQ(unit.drop->edge_runs, drop.edge_runs);
  ASSERT_EQ(unit.drop->blocked.size(), 3U);
  EXPECT_NEAR(unit.drop->blocked[2].azimuth_end_rad, 3, 1e-5);
  ASSERT_TRUE(unit.body.has_value());
  ASSERT_EQ(unit.body->cells.size(), 3U);
  EXPECT_EQ(unit.body->cells[1].ring, 3);
  EXPECT_EQ(unit.body->cells[1].column, 719);
  EXPECT_EQ(unit.body->cells[1].range_m, 2.001F);
  EXPECT_EQ(unit.body->cells[2].share, 0.25F);
  // A sensor that is like it has it, too; its own noise or beams replace it.
  const auto like = folder.write("like.toml", std::string("like = \"unit.toml\"\n"));
  EXPECT_EQ(load_lidar_model(like.string()).ring_noise_m, unit.ring_noise_m);
  const auto plain =
      folder.write("plain.toml", std::string("like = \"unit.toml\"\nrange_noise_m = 0.01\n"));
  EXPECT_TRUE(load_lidar_model(plain.string()).ring_noise_m.empty());
  const auto other =
      folder.write("other.toml", std::string("like = \"unit.toml\"\nelevations_deg = [1, 2]\n"));
  EXPECT_FALSE(load_lidar_model(other.string()).intensity.has_value());
  EXPECT_FALSE(load_lidar_model(other.string()).fields.has_value());
  EXPECT_FALSE(load_lidar_model(other.string()).drop || load_lidar_model(other.string()).body);
}

TEST(CalibratedSensor, ErrorsOfFieldsSayWhatIsWrong) {
  const TemporaryFolder folder;
  const auto error_is = [&](const std::string& lines, const std::string& says) {
    const auto file =
        folder.write("bad.toml", "columns = 4\nelevations_deg = [-1, 2]\n[fields]\n" + lines);
    expect_error(ErrorKind::config, {says}, [&] { load_lidar_model(file.string()); });
  };
  error_is("columns = 1\nbytes = 'AAAAAAAA'\n", "turns is missing");
  error_is("turns = 0\ncolumns = 1\nbytes = 'AAAAAAAA'\n", "turns");
  error_is("turns = 1\ncolumns = 2\nbytes = 'AAAAAAAA'\n",
           "bad.toml:6: bytes has 6 bytes, expected 16");
  error_is("turns = 1\ncolumns = 1\nbytes = 'AAAA*AAA'\n", "is not base64");
  error_is("turns = 1\ncolumns = 1\nbyte = 'AAAAAAAA'\n", "did you mean 'bytes'");
}

TEST(CalibratedSensor, ErrorsOfDropAndBodySayWhatIsWrong) {
  const TemporaryFolder folder;
  const auto error_is = [&](const std::string& lines, const std::string& says) {
    const auto file = folder.write("bad.toml", "columns = 4\nelevations_deg = [-1, 2]\n" + lines);
    expect_error(ErrorKind::config, {says}, [&] { load_lidar_model(file.string()); });
  };
  error_is("[drop]\nweight = [1]\n", "bad.toml:4: unknown key 'weight', did you mean 'weights'?");
  error_is("[drop]\nweights = [1]\n", "bad.toml:4: weights is not a list of 8");
  error_is("drop = 1\n", "drop is not a table");
  error_is("[body]\ncells = [[0, 0, 50, 1000]]\n", "has a list of 4 numbers, expected 5");
  error_is("[body]\ncells = [[2, 0, 50, 1000, 0]]\n", "bad.toml:4: cells has a row 1 that is not");
  error_is("[body]\ncells = [[0, 0.25, 50, 1000, 0]]\n", "cells has a row 1");
  error_is("[body]\ncells = [[0, 0, 101, 1000, 0]]\n", "cells has a row 1");
  error_is("[body]\ncells = [[0, 0, 50, 0, 0]]\n", "cells has a row 1");
  error_is("[body]\ncells = [[1, 0, 5, 9, 0], [0, 0, 5, 9, 0], [1, 0, 6, 9, 0]]\n",
           "two rows for one ring and azimuth");
}

TEST(CalibratedSensor, ErrorsOfIntensitiesSayWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string row = "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]";
  const std::string good =
      "highest = 1\nlevels = [0.1]\nzero_share = [0]\nreported = [" + row + "]\n";
  const auto error_is = [&](const std::string& lines, const std::string& says) {
    const auto file =
        folder.write("bad.toml", "columns = 4\nelevations_deg = [-1, 2]\n[intensity]\n" + lines);
    expect_error(ErrorKind::config, {says}, [&] { load_lidar_model(file.string()); });
  };
  const auto file =
      folder.write("good.toml", "columns = 4\nelevations_deg = [-1, 2]\n[intensity]\n" + good);
  EXPECT_TRUE(load_lidar_model(file.string()).intensity.has_value());
  error_is("highest = 1\n", "levels is missing");
  error_is(good + "zero_shares = [0]\n", "did you mean 'zero_share'");
  error_is(good + "ring_expected = [[0, 1], [0, 1]]\n", "require each other");
  error_is(good + "ring_expected = [[0, 1], [1, 0]]\nring_level = [[0, 1], [0, 1]]\n",
           "is not ascending");
  error_is(good + "ring_expected = [[0, 1], [0]]\nring_level = [[0, 1], [0, 1]]\n",
           "has a list of 1 numbers, expected 2");
  error_is(good + "ring_expected = [[0, 1]]\nring_level = [[0, 1]]\n", "one list a ring");
  error_is("highest = 1\nlevels = [0.1, 0.2]\nzero_share = [0]\nreported = [" + row + "]\n",
           "needs as many values");
  error_is("highest = 1\nlevels = [0.1]\nzero_share = [2]\nreported = [" + row + "]\n",
           "zero_share is not a number from 0 to 1");
}

TEST(CalibratedSensor, OffsetsOfOtherSensorsAreNoUnit) {
  expect_error(ErrorKind::usage, {"vlp-16", "did you mean"},
               [] { calibrated_sensor_toml("vlp-16", {}); });
  const std::vector<double> many(17);
  EXPECT_THROW(calibrated_sensor_toml("velodyne-vlp-16", {many, {}}), std::logic_error);
  EXPECT_THROW(calibrated_sensor_toml("livox-mid-40", {}), std::logic_error);
}

}  // namespace
}  // namespace adasplats
