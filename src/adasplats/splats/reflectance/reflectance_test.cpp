// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/reflectance/reflectance.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/splats/model_engine.h"
#include "adasplats/splats/reflectance/element_steps.h"
#include "adasplats/splats/reflectance/response_tables.h"

namespace adasplats {
namespace {

/// A square of ground, dim for x < 0 and bright for x > 0. Disks do not overlap: of two in one
/// plane the first alone is met.
std::vector<Disk> ground() {
  std::vector<Disk> disks;
  for (int ix = -12; ix <= 12; ++ix) {
    for (int iy = -12; iy <= 12; ++iy) {
      disks.push_back({{0.5F * static_cast<float>(ix), 0.5F * static_cast<float>(iy), 0.0F},
                       0.25F,
                       {0.0F, 0.0F, 1.0F}});
    }
  }
  return disks;
}

float true_reflectance(float x) { return x < 0 ? 0.2F : 0.6F; }
/// Both linear, so that tables hold them exactly; 1 at 10 m and head on.
float true_range_gain(float range_m) { return 1.2F - 0.02F * range_m; }
float true_incidence_gain(float cosine) { return 0.5F + 0.5F * cosine; }

/// What sensors 2 to 20 m above the ground measure there.
PointCloud measured_ground(std::size_t rays) {
  PointCloud cloud;
  for (std::size_t i = 0; i < rays; ++i) {
    Random random(1, 0, i);
    const auto draw = [&](double low, double high) {
      return static_cast<float>(random.uniform(low, high));
    };
    const Vec3f sensor = {draw(-8, 8), draw(-8, 8), draw(2, 20)};
    const Vec3f point = {draw(-6.25, 6.25), draw(-6.25, 6.25), 0.0F};
    const float range_m = length(point - sensor);
    cloud.positions.push_back(point);
    cloud.sensor_positions.push_back(sensor);
    cloud.intensities.push_back(true_reflectance(point.x) * true_range_gain(range_m) *
                                true_incidence_gain(sensor.z / range_m));
  }
  return cloud;
}

Reflectances measure(const std::vector<Disk>& disks, const PointCloud& cloud, int threads = 2,
                     float fallback = 0.5F) {
  const Executor executor(threads);
  return make_cpu_model_engine(executor)->measure_reflectances(
      disks, std::vector<float>(disks.size(), fallback), cloud);
}

/// Oracle: the reflectances and gains that the intensities were made with, within 2 %.
void expect_truth(const std::vector<Disk>& disks, const Reflectances& found) {
  ASSERT_EQ(found.values.size(), disks.size());
  for (std::size_t d = 0; d < disks.size(); ++d) {
    const float x = disks[d].center.x;
    if (x == 0) continue;  // reaches over the border
    const float truth = true_reflectance(x);
    EXPECT_NEAR(found.values[d], truth, 0.02F * truth) << d;
  }
  for (const float range_m : {4.0F, 7.0F, 15.0F, 22.0F}) {
    for (const float cosine : {0.35F, 0.5F, 0.85F, 1.0F}) {
      const float truth = true_range_gain(range_m) * true_incidence_gain(cosine);
      EXPECT_NEAR(found.response.gain(range_m, cosine), truth, 0.02F * truth)
          << range_m << " m, " << cosine;
    }
  }
}

TEST(Reflectance, RecoversReflectancesAndResponseOfAPlane) {
  const std::vector<Disk> disks = ground();
  expect_truth(disks, measure(disks, measured_ground(150000)));
}

TEST(Reflectance, ResponseIsOneAtTenMetresHeadOn) {
  const Reflectances found = measure(ground(), measured_ground(20000));
  EXPECT_FLOAT_EQ(found.response.gain(10, 1), 1.0F);
}

TEST(Reflectance, SameBytesForAnyNumberOfThreads) {
  const std::vector<Disk> disks = ground();
  const PointCloud cloud = measured_ground(20000);
  const Reflectances one = measure(disks, cloud, 1), three = measure(disks, cloud, 3);
  EXPECT_EQ(one.values, three.values);
  EXPECT_EQ(one.response.range_gains, three.response.range_gains);
  EXPECT_EQ(one.response.incidence_gains, three.response.incidence_gains);
}

TEST(Reflectance, RaysThatEndElsewhereAndIntensitiesNotFiniteDoNotCount) {
  const std::vector<Disk> disks = ground();
  PointCloud cloud = measured_ground(150000);
  const std::size_t count = cloud.size();
  for (std::size_t i = 0; i < count; i += 3) {
    cloud.sensor_positions.push_back(cloud.sensor_positions[i]);
    // Something that is not in the model, 30 % of the way before the ground.
    cloud.positions.push_back(cloud.sensor_positions[i] +
                              0.7F * (cloud.positions[i] - cloud.sensor_positions[i]));
    cloud.intensities.push_back(1.0F);
    cloud.sensor_positions.push_back(cloud.sensor_positions[i]);
    cloud.positions.push_back(cloud.positions[i]);
    cloud.intensities.push_back(kNaN);
  }
  expect_truth(disks, measure(disks, cloud));
}

// Without the units, whole numbers would hold nothing of some sensors and overflow with others.
TEST(Reflectance, UnitsOfIntensitiesDoNotMatter) {
  const std::vector<Disk> disks = ground();
  const PointCloud cloud = measured_ground(20000);
  const Reflectances expected = measure(disks, cloud);
  for (const float unit : {0x1p-70F, 0x1p16F, 0x1p90F}) {
    PointCloud scaled = cloud;
    for (float& intensity : scaled.intensities) intensity *= unit;
    const Reflectances found = measure(disks, scaled, 2, 0.5F * unit);
    EXPECT_EQ(found.response.range_gains, expected.response.range_gains);
    EXPECT_EQ(found.response.incidence_gains, expected.response.incidence_gains);
    for (std::size_t d = 0; d < disks.size(); ++d)
      EXPECT_EQ(found.values[d], unit * expected.values[d]) << d;
  }
}

TEST(TableFit, NodesWithoutRaysTakeTheirNeighboursValues) {
  TableSums<4> sums;
  for (int k = 0; k < 1000; ++k) {
    sums.add(0, 0.5, 0.5);   // a value of 1 at node 0
    sums.add(1, 0.25, 0.5);  // 0.5 at node 1
  }
  const std::array<float, 4> values = solved(sums, 0);
  EXPECT_EQ(values[0], 1.0F);
  for (const std::size_t node : {1U, 2U, 3U}) EXPECT_NEAR(values[node], 0.5F, 2e-3F) << node;
  EXPECT_EQ(solved(TableSums<4>{}, 2), (std::array<float, 4>{1, 1, 1, 1}));
}

TEST(TableFit, PowersOfTwoAbove) {
  EXPECT_EQ(power_of_two_above(0), 1.0);
  EXPECT_EQ(power_of_two_above(0.75), 1.0);
  EXPECT_EQ(power_of_two_above(1), 2.0);
  EXPECT_EQ(power_of_two_above(300), 512.0);
}

TEST(ResponseTables, PlacesAmongNodes) {
  const std::array<float, 3> nodes = {2, 4, 8};
  EXPECT_EQ(position_among(nodes, 1), 0.0F);
  EXPECT_EQ(position_among(nodes, 3), 0.5F);
  EXPECT_EQ(position_among(nodes, 4), 1.0F);
  EXPECT_EQ(position_among(nodes, 5), 1.25F);
  EXPECT_EQ(position_among(nodes, 90), 2.0F);
  EXPECT_EQ(value_at(std::array<float, 3>{1, 2, 6}, 1.25F), 3.0F);
  EXPECT_EQ(value_at(std::array<float, 3>{1, 2, 6}, 2.0F), 6.0F);
}

TEST(Reflectance, DisksThatNoRayIsNearHaveTheFallback) {
  std::vector<Disk> disks = ground();
  disks.push_back({{50, 50, 0}, 0.5F, {0, 0, 1}});
  EXPECT_EQ(measure(disks, measured_ground(20000)).values.back(), 0.5F);
  // No information: the mean of the model is used.
  const float usual = measure(disks, measured_ground(20000), 2, kNaN).values.back();
  EXPECT_GT(usual, 0.2F);
  EXPECT_LT(usual, 0.6F);
}

TEST(Reflectance, TooLittleGivesTheFallbackAndNoResponse) {
  const std::vector<Disk> disks = ground();
  const auto expect_fallback = [&](const PointCloud& cloud) {
    const Reflectances found = measure(disks, cloud);
    EXPECT_EQ(found.values, std::vector<float>(disks.size(), 0.5F));
    EXPECT_TRUE(found.response.empty());
    EXPECT_EQ(found.response.gain(30, 0.1F), 1.0F);
  };
  expect_fallback({});
  PointCloud on_disk = measured_ground(1000);
  for (std::size_t i = 0; i < on_disk.size(); ++i) on_disk.positions[i] = disks[i % 600].center;
  EXPECT_FALSE(measure(disks, on_disk).response.empty());
  on_disk.positions.pop_back();
  on_disk.sensor_positions.pop_back();
  on_disk.intensities.pop_back();
  expect_fallback(on_disk);
  PointCloud without_sensors = measured_ground(2000);
  without_sensors.sensor_positions.clear();
  expect_fallback(without_sensors);
  PointCloud without_intensities = measured_ground(2000);
  without_intensities.intensities.clear();
  expect_fallback(without_intensities);
}

// A third of the beams is lost where x > 3, a twentieth elsewhere; of the disk in the middle all.
// Oracle: the odds; and the reflectances without lost beams.
TEST(Reflectance, LostBeamsGiveTheLogOddsOfDisks) {
  const std::vector<Disk> disks = ground();
  PointCloud cloud = measured_ground(150000);
  PointCloud returned;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3f p = cloud.positions[i];
    const bool middle = std::hypot(p.x, p.y) < 0.25F;
    if (middle || Random(5, 0, i).uniform() < (p.x > 3.25F ? 1.0 / 3 : 0.05)) {
      cloud.intensities[i] = kLostIntensity;
      continue;
    }
    returned.positions.push_back(p);
    returned.sensor_positions.push_back(cloud.sensor_positions[i]);
    returned.intensities.push_back(cloud.intensities[i]);
  }
  const Reflectances found = measure(disks, cloud);
  EXPECT_EQ(found.values, measure(disks, returned).values);
  EXPECT_TRUE(measure(disks, returned).drop_log_odds.empty());
  EXPECT_EQ(found.drop_log_odds, measure(disks, cloud, 3).drop_log_odds);
  ASSERT_EQ(found.drop_log_odds.size(), disks.size());
  double sums[2] = {}, counts[2] = {};
  for (std::size_t d = 0; d < disks.size(); ++d) {
    const Vec3f c = disks[d].center;
    if (c.x == 0 && c.y == 0) {
      EXPECT_GT(found.drop_log_odds[d], 4);
      continue;
    }
    sums[c.x > 3.25F] += static_cast<double>(found.drop_log_odds[d]);
    counts[c.x > 3.25F] += 1;
  }
  const double expected = std::log((1.0 / 2) / (0.05 / 0.95));
  EXPECT_NEAR(sums[1] / counts[1] - sums[0] / counts[0], expected, 0.15 * expected);
}

TEST(Reflectance, BlackWorldIsBlack) {
  const std::vector<Disk> disks = ground();
  PointCloud cloud = measured_ground(20000);
  for (float& intensity : cloud.intensities) intensity = 0;
  const Reflectances found = measure(disks, cloud, 2, 0.0F);
  for (const float value : found.values) EXPECT_EQ(value, 0.0F);
  EXPECT_EQ(found.response.gain(20, 0.5F), 1.0F);
}

TEST(Reflectance, NoDisksGiveAnEmptyResult) {
  EXPECT_TRUE(measure({}, measured_ground(2000)).values.empty());
}

TEST(IntensityResponse, IsLinearBetweenNodesAndConstantOutside) {
  const IntensityResponse response{{10, 20}, {1.0F, 0.5F}, {0.0F, 1.0F}, {0.4F, 1.0F}};
  EXPECT_FLOAT_EQ(response.gain(10, 1), 1.0F);
  EXPECT_FLOAT_EQ(response.gain(15, 1), 0.75F);
  EXPECT_FLOAT_EQ(response.gain(0, 1), 1.0F);
  EXPECT_FLOAT_EQ(response.gain(1000, 1), 0.5F);
  EXPECT_FLOAT_EQ(response.gain(15, 0.5F), 0.75F * 0.7F);
  EXPECT_FLOAT_EQ(response.gain(15, -1), 0.75F * 0.4F);
}

/// A model file in a folder that goes away.
class ResponseFile : public testing::Test {
 protected:
  ResponseFile()
      : path(std::filesystem::temp_directory_path() /
             (std::string("adasplats_response_") +
              testing::UnitTest::GetInstance()->current_test_info()->name() + ".ply")) {
    model.disks = {{{1, 2, 3}, 0.5F, {0, 0, 1}}};
    model.intensities = {0.25F};
  }
  ~ResponseFile() override { std::filesystem::remove(path); }

  /// Replaces text of the file that save_model wrote.
  void replace(const std::string& from, const std::string& to) {
    std::ifstream in(path, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    std::string all = text.str();
    ASSERT_NE(all.find(from), std::string::npos);
    all.replace(all.find(from), from.size(), to);
    std::ofstream(path, std::ios::binary) << all;
  }

  std::filesystem::path path;
  SplatModel model;
};

TEST_F(ResponseFile, ComesBackAsItWas) {
  model.response = {{2, 10.1F, 80}, {1.1F, 1, 0.3F}, {0, 1}, {0.7F, 1}};
  save_model(path, model);
  const IntensityResponse read = load_model(path).response;
  EXPECT_EQ(read.ranges_m, model.response.ranges_m);
  EXPECT_EQ(read.range_gains, model.response.range_gains);
  EXPECT_EQ(read.cos_incidences, model.response.cos_incidences);
  EXPECT_EQ(read.incidence_gains, model.response.incidence_gains);
}

TEST_F(ResponseFile, OlderFilesHaveNone) {
  save_model(path, model);
  EXPECT_TRUE(load_model(path).response.empty());
}

TEST_F(ResponseFile, BrokenTablesAreErrors) {
  model.response = {{2, 10, 80}, {1.25F, 1, 0.5F}, {0, 1}, {0.75F, 1}};
  const std::vector<std::pair<std::string, std::string>> changes = {
      {"2 10 80", "2 10"},      {"2 10 80", "10 2 80"},  {"2 10 80", "2 nan 80"},
      {"1.25 1 0.5", "1 -1 2"}, {"1.25 1 0.5", "1 x 2"}, {"response_cosines 0 1", "response_x 0 1"},
  };
  for (const auto& [from, to] : changes) {
    save_model(path, model);
    replace(from, to);
    EXPECT_THROW(load_model(path), Error) << to;
  }
}

}  // namespace
}  // namespace adasplats
