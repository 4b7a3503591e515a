// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/ray_drop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kDegree = std::numbers::pi / 180;

Vec3f direction_of(double azimuth_deg, double elevation_deg) {
  const double azimuth = azimuth_deg * kDegree, elevation = elevation_deg * kDegree;
  return vec_cast<float>(Vec3d{std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation)});
}

EchoConditions random_echo(Random& random) {
  const auto draw = [&](double low, double high) {
    return static_cast<float>(random.uniform(low, high));
  };
  return {draw(1, 80), draw(0, 1), draw(0.01, 1)};
}

struct Draws {
  std::vector<EchoConditions> echoes;
  std::vector<std::uint8_t> dropped;
};

Draws draws_of(const RayDropModel& truth, std::size_t count) {
  Draws draws;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(3, 0, i);
    draws.echoes.push_back(random_echo(random));
    draws.dropped.push_back(random.uniform() < truth.probability(draws.echoes.back()) ? 1 : 0);
  }
  return draws;
}

RayDropModel some_model() {
  RayDropModel model;
  model.weights = {-3, 0.3, 0.05, 0.2, 1, 0.5, -0.6, -0.1};
  return model;
}

/// Oracle: the model that the draws were made with.
TEST(RayDrop, LogisticIsRecoveredFromDraws) {
  const RayDropModel truth = some_model();
  const Draws draws = draws_of(truth, 200000);
  const RayDropModel found = fit_ray_drop(draws.echoes, draws.dropped);
  double worst = 0, expected = 0, drawn = 0;
  for (std::size_t i = 0; i < draws.echoes.size(); ++i) {
    const double p = found.probability(draws.echoes[i]);
    worst = std::max(worst, std::fabs(p - truth.probability(draws.echoes[i])));
    expected += p;
    drawn += draws.dropped[i];
  }
  EXPECT_LT(worst, 0.04);
  // The likelihood is largest where the sums agree; the penalty hardly moves it.
  EXPECT_NEAR(expected / drawn, 1, 1e-4);
}

/// Oracle: with one kind of echo the share of drops is the probability.
TEST(RayDrop, EqualEchoesGiveTheirShare) {
  const std::vector<EchoConditions> echoes(1000, {20, 0.5F, 0.3F});
  std::vector<std::uint8_t> dropped(1000, 0);
  std::fill_n(dropped.begin(), 250, std::uint8_t{1});
  EXPECT_NEAR(fit_ray_drop(echoes, dropped).probability(echoes[0]), 0.25, 1e-3);
}

TEST(RayDrop, SeparableDrawsEnd) {
  std::vector<EchoConditions> echoes;
  std::vector<std::uint8_t> dropped;
  for (int i = 0; i < 1000; ++i) {
    echoes.push_back({static_cast<float>(i) * 0.1F, 1, 0.3F});
    dropped.push_back(i >= 500 ? 1 : 0);
  }
  const RayDropModel found = fit_ray_drop(echoes, dropped);
  EXPECT_LT(found.probability({20, 1, 0.3F}), 0.01);
  EXPECT_GT(found.probability({90, 1, 0.3F}), 0.99);
}

TEST(RayDrop, UnknownReflectanceIsTheUsualOne) {
  RayDropModel model = some_model();
  model.usual_reflectance = 0.25;
  EXPECT_EQ(model.probability({30, 0.4F, kNan}), model.probability({30, 0.4F, 0.25F}));
  // Fitted: the median of those that are known.
  std::vector<EchoConditions> echoes(300, {20, 0.5F, kNan});
  std::vector<std::uint8_t> dropped(300, 0);
  for (std::size_t i = 0; i < 150; ++i) dropped[2 * i] = 1;
  EXPECT_EQ(fit_ray_drop(echoes, dropped).usual_reflectance, 0.3);
  echoes[0].reflectance = 0.125F;
  EXPECT_EQ(fit_ray_drop(echoes, dropped).usual_reflectance, 0.125);
}

TEST(RayDrop, ProbabilitiesAreFiniteAtTheEdges) {
  const RayDropModel model = some_model();
  for (const EchoConditions& echo :
       {EchoConditions{0, 0, 0}, {1e6F, 1, 1e6F}, {-1, -1, -1}, {1, 2, 0}}) {
    const double p = model.probability(echo);
    EXPECT_TRUE(p >= 0 && p <= 1) << p;
  }
}

TEST(RayDrop, NeedsAHundredOfEither) {
  const std::vector<EchoConditions> echoes(300);
  std::vector<std::uint8_t> dropped(300, 0);
  std::fill_n(dropped.begin(), 99, std::uint8_t{1});
  EXPECT_THROW(fit_ray_drop(echoes, dropped), Error);
  dropped[99] = 1;
  EXPECT_NO_THROW(fit_ray_drop(echoes, dropped));
  std::fill(dropped.begin() + 99, dropped.end(), std::uint8_t{1});
  std::fill_n(dropped.begin(), 99, std::uint8_t{0});
  EXPECT_THROW(fit_ray_drop(echoes, dropped), Error);
  EXPECT_THROW(fit_ray_drop({}, {}), Error);
  EXPECT_THROW(fit_ray_drop(echoes, std::vector<std::uint8_t>(3)), std::logic_error);
}

/// Beams of four scans at two elevations, half a degree apart; `is_dropped` of scan, elevation
/// and azimuth.
template <class IsDropped>
std::vector<BlockedSector> sectors_where(const IsDropped& is_dropped) {
  Draws draws;
  std::vector<std::uint32_t> scans;
  for (std::uint32_t scan = 0; scan < 4; ++scan) {
    for (const double elevation : {-20.5, -20.0}) {
      for (int k = 0; k < 1800; ++k) {
        const double azimuth = -179.9 + 0.2 * k;
        draws.echoes.push_back({5, 1, 0.3F, direction_of(azimuth, elevation)});
        draws.dropped.push_back(is_dropped(scan, elevation, azimuth) ? 1 : 0);
        scans.push_back(scan);
      }
    }
  }
  return find_blocked_sectors(draws.echoes, draws.dropped, scans);
}

TEST(BlockedSectors, AreWhereScansAgree) {
  RayDropModel model;
  model.blocked = sectors_where([](std::uint32_t, double elevation, double azimuth) {
    return elevation < -20.2 && ((azimuth > 10 && azimuth < 30) || azimuth > 170);
  });
  ASSERT_EQ(model.blocked.size(), 2U);
  EXPECT_NEAR(model.blocked[0].azimuth_begin_rad / kDegree, 10, 1e-4);
  EXPECT_NEAR(model.blocked[0].azimuth_end_rad / kDegree, 30, 1e-4);
  EXPECT_NEAR(model.blocked[0].elevation_rad / kDegree, -20.5, 1e-4);
  EXPECT_EQ(model.probability({5, 1, 0.3F, direction_of(20, -20.5)}), 1);
  EXPECT_TRUE(model.blocks(direction_of(10.01, -20.5)));
  EXPECT_TRUE(model.blocks(direction_of(20, -20.7)));  // another sensor's beam near by
  EXPECT_TRUE(model.blocks({-1, 0, -0.3739F}));        // half a turn itself
  EXPECT_FALSE(model.blocks(direction_of(9.9, -20.5)));
  EXPECT_FALSE(model.blocks(direction_of(30.1, -20.5)));
  EXPECT_FALSE(model.blocks(direction_of(20, -20.0)));
  EXPECT_FALSE(model.blocks(direction_of(20, -21.0)));
  EXPECT_FALSE(model.blocks({0, 0, 0}));  // unknown
  EXPECT_FALSE(model.blocks({kNan, 0, 0}));
}

TEST(BlockedSectors, WhatChangesFromScanToScanIsNone) {
  EXPECT_TRUE(sectors_where([](std::uint32_t scan, double, double azimuth) {
                return scan < 2 && azimuth < 0;
              }).empty());
  EXPECT_EQ(sectors_where([](std::uint32_t scan, double, double azimuth) {
              return scan < 3 && azimuth < 0;
            }).size(),
            2U);
  EXPECT_TRUE(find_blocked_sectors({}, {}, {}).empty());
  const std::vector<EchoConditions> nowhere(5);
  EXPECT_TRUE(find_blocked_sectors(nowhere, std::vector<std::uint8_t>(5, 1),
                                   std::vector<std::uint32_t>{0, 1, 2, 3, 4})
                  .empty());
  EXPECT_THROW(find_blocked_sectors(nowhere, {}, {}), std::logic_error);
}

TEST(BlockedSectors, ElevationsAreToldApartAtTheirMiddle) {
  RayDropModel model;
  const auto sector = [](double elevation_deg, double begin_deg, double end_deg) {
    return BlockedSector{static_cast<float>(elevation_deg * kDegree),
                         static_cast<float>(begin_deg * kDegree),
                         static_cast<float>(end_deg * kDegree)};
  };
  model.blocked = {sector(-20.4, 0, 10), sector(-20.4, 40, 50), sector(-20, 20, 30)};
  EXPECT_TRUE(model.blocks(direction_of(5, -20.25)));
  EXPECT_TRUE(model.blocks(direction_of(45, -20.25)));
  EXPECT_FALSE(model.blocks(direction_of(25, -20.25)));
  EXPECT_FALSE(model.blocks(direction_of(5, -20.15)));
  EXPECT_TRUE(model.blocks(direction_of(25, -20.15)));
  EXPECT_TRUE(model.blocks(direction_of(25, -19.8)));
}

/// A file that goes away.
class RayDropFile : public testing::Test {
 protected:
  RayDropFile()
      : path(std::filesystem::temp_directory_path() /
             (std::string("adasplats_") +
              testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml")) {}
  ~RayDropFile() override { std::filesystem::remove(path); }

  std::string error_of(const std::string& text) {
    std::ofstream(path) << text;
    try {
      load_ray_drop(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::config);
      return error.what();
    }
    return {};
  }

  std::filesystem::path path;
};

TEST_F(RayDropFile, RoundTrip) {
  RayDropModel model = some_model();
  model.usual_reflectance = 0.1;
  model.fitted_to = "a \"sensor\" \\ place\n";
  model.edge_runs = {0.25, 0, 0.125};
  model.blocked = sectors_where([](std::uint32_t, double elevation, double azimuth) {
    return (azimuth > 10 && azimuth < 30) || (elevation < -20.2 && azimuth < -160);
  });
  ASSERT_EQ(model.blocked.size(), 3U);
  save_ray_drop(path, model);
  const RayDropModel read = load_ray_drop(path);
  EXPECT_EQ(read.weights, model.weights);
  EXPECT_EQ(read.usual_reflectance, 0.1);
  EXPECT_EQ(read.edge_runs, model.edge_runs);
  EXPECT_EQ(read.fitted_to, "a \"sensor\" \\ place ");
  ASSERT_EQ(read.blocked.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(read.blocked[i].elevation_rad, model.blocked[i].elevation_rad);
    EXPECT_FLOAT_EQ(read.blocked[i].azimuth_begin_rad, model.blocked[i].azimuth_begin_rad);
    EXPECT_FLOAT_EQ(read.blocked[i].azimuth_end_rad, model.blocked[i].azimuth_end_rad);
  }
}

TEST_F(RayDropFile, ErrorsNameTheLine) {
  const std::string weights = "weights = [1, 2, 3, 4, 5, 6, 7, 8]\n";
  EXPECT_EQ(error_of(weights), "");
  EXPECT_NE(error_of("").find("weights is missing"), std::string::npos);
  EXPECT_NE(error_of("\nweights = [1, 2]").find(":2: weights is not a list of 8"),
            std::string::npos);
  EXPECT_NE(error_of("weights = [1, 2, 3, 4, 5, 6, 7, nan]").find(":1: "), std::string::npos);
  EXPECT_NE(error_of(weights + "weihgts = 1").find("did you mean 'weights'"), std::string::npos);
  EXPECT_NE(error_of(weights + "usual_reflectance = 'x'").find(":2: "), std::string::npos);
  EXPECT_NE(error_of(weights + "fitted_to = 1").find(":2: "), std::string::npos);
  EXPECT_NE(error_of(weights + "blocked = [1]").find(":2: "), std::string::npos);
  EXPECT_NE(error_of(weights + "edge_runs = [0, 0, 0, 0, 0, 0, 0]").find(":2: edge_runs has 7"),
            std::string::npos);
  EXPECT_NE(error_of(weights + "edge_runs = [0.5, 0.5, 0.1]").find("more than 1 together"),
            std::string::npos);
  EXPECT_NE(error_of(weights + "[[blocked]]\nelevation_deg = 1").find(":2: "), std::string::npos);
  EXPECT_NE(error_of(weights + "[[blocked]]\nelevation_deg = 1\nazimuths_deg = [[1]]").find(":4: "),
            std::string::npos);
  EXPECT_NE(error_of(weights + "[[blocked]]\nelevation_deg = 1\nazimuths_deg = [[1, 999]]")
                .find("-180 to 180"),
            std::string::npos);
  EXPECT_NE(error_of("weights = [").find(":1: "), std::string::npos);
  EXPECT_NE(error_of(std::string(10000, '.')).find("too large"), std::string::npos);
}

TEST_F(RayDropFile, MissingFileIsNoInput) {
  try {
    load_ray_drop(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::no_input);
  }
}

}  // namespace
}  // namespace adasplats
