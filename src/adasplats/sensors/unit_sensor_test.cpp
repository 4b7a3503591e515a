// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/unit_sensor.h"

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
TEST(UnitSensor, IsTheSensorOfTheLibraryWithItsOffsets) {
  const TemporaryFolder folder;
  for (const std::string& name : lidar_model_names()) {
    const LidarModel known = load_lidar_model(name);
    if (known.rosette) continue;
    const auto elevations_rad = waves(known.rings(), 2e-4), ranges_m = waves(known.rings(), 0.03);
    const auto file = folder.write("unit.toml", unit_sensor_toml(name, {ranges_m, elevations_rad}));
    const LidarModel unit = load_lidar_model(file.string());
    EXPECT_EQ(unit.name, name + "-unit");
    EXPECT_EQ(unit.most_returns, known.most_returns) << name;
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
TEST(UnitSensor, OffsetsOfRangesAreOneABeamAndSortedWithThem) {
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

TEST(UnitSensor, OffsetsOfOtherSensorsAreNoUnit) {
  expect_error(ErrorKind::usage, {"vlp-16", "did you mean"},
               [] { unit_sensor_toml("vlp-16", {}); });
  const std::vector<double> many(17);
  EXPECT_THROW(unit_sensor_toml("velodyne-vlp-16", {many, {}}), std::logic_error);
  EXPECT_THROW(unit_sensor_toml("livox-mid-40", {}), std::logic_error);
}

}  // namespace
}  // namespace adasplats
