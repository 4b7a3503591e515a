// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/ray_drop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

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
    draws.dropped.push_back(random.uniform() < drop_probability(truth, draws.echoes.back()) ? 1
                                                                                            : 0);
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
    const double p = drop_probability(found, draws.echoes[i]);
    worst = std::max(worst, std::fabs(p - drop_probability(truth, draws.echoes[i])));
    expected += p;
    drawn += draws.dropped[i];
  }
  EXPECT_LT(worst, 0.04);
  // The likelihood is largest where the sums agree; the penalty hardly moves it.
  EXPECT_NEAR(expected / drawn, 1, 1e-4);
}

/// Oracle: the model of the sensor, whatever the splats add to it.
TEST(RayDrop, LogOddsOfSplatsAreNotTheSensors) {
  const RayDropModel truth = some_model();
  Draws draws;
  for (std::size_t i = 0; i < 200000; ++i) {
    Random random(4, 0, i);
    EchoConditions echo = random_echo(random);
    echo.drop_log_odds = static_cast<float>(random.uniform(-3, 3));
    draws.dropped.push_back(random.uniform() < drop_probability(truth, echo) ? 1 : 0);
    draws.echoes.push_back(echo);
  }
  const RayDropModel found = fit_ray_drop(draws.echoes, draws.dropped);
  for (std::size_t i = 0; i < 1000; ++i) {
    EchoConditions echo = draws.echoes[i];
    EXPECT_NEAR(drop_probability(found, echo), drop_probability(truth, echo), 0.05);
    const double before = drop_probability(truth, echo);
    echo.drop_log_odds += 1;
    const double odds = before / (1 - before) * std::exp(1.0);
    EXPECT_NEAR(drop_probability(truth, echo), odds / (1 + odds), 1e-6);
  }
}

/// Oracle: with one kind of echo the share of drops is the probability.
TEST(RayDrop, EqualEchoesGiveTheirShare) {
  const std::vector<EchoConditions> echoes(1000, {20, 0.5F, 0.3F});
  std::vector<std::uint8_t> dropped(1000, 0);
  std::fill_n(dropped.begin(), 250, std::uint8_t{1});
  EXPECT_NEAR(drop_probability(fit_ray_drop(echoes, dropped), echoes[0]), 0.25, 1e-3);
}

TEST(RayDrop, SeparableDrawsEnd) {
  std::vector<EchoConditions> echoes;
  std::vector<std::uint8_t> dropped;
  for (int i = 0; i < 1000; ++i) {
    echoes.push_back({static_cast<float>(i) * 0.1F, 1, 0.3F});
    dropped.push_back(i >= 500 ? 1 : 0);
  }
  const RayDropModel found = fit_ray_drop(echoes, dropped);
  EXPECT_LT(drop_probability(found, {20, 1, 0.3F}), 0.01);
  EXPECT_GT(drop_probability(found, {90, 1, 0.3F}), 0.99);
}

TEST(RayDrop, UnknownReflectanceIsTheUsualOne) {
  RayDropModel model = some_model();
  model.usual_reflectance = 0.25;
  EXPECT_EQ(drop_probability(model, {30, 0.4F, kNaN}), drop_probability(model, {30, 0.4F, 0.25F}));
  // Fitted: the median of those that are known.
  std::vector<EchoConditions> echoes(300, {20, 0.5F, kNaN});
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
    const double p = drop_probability(model, echo);
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
  EXPECT_EQ(drop_probability(model, {5, 1, 0.3F, direction_of(20, -20.5)}), 1);
  EXPECT_TRUE(model.blocks(direction_of(10.01, -20.5)));
  EXPECT_TRUE(model.blocks(direction_of(20, -20.7)));  // another sensor's beam near by
  EXPECT_TRUE(model.blocks({-1, 0, -0.3739F}));        // half a turn itself
  EXPECT_FALSE(model.blocks(direction_of(9.9, -20.5)));
  EXPECT_FALSE(model.blocks(direction_of(30.1, -20.5)));
  EXPECT_FALSE(model.blocks(direction_of(20, -20.0)));
  EXPECT_FALSE(model.blocks(direction_of(20, -21.0)));
  EXPECT_FALSE(model.blocks({0, 0, 0}));  // unknown
  EXPECT_FALSE(model.blocks({kNaN, 0, 0}));
}

TEST(BlockedSectors, ChangingSectorsAreNotBlocked) {
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

// Oracle: a ring whose elevation wanders, as in scans whose motion was taken out, is one ring.
// Oracle: the chance itself; bounds may decide nothing otherwise.
TEST(RayDrop, BeamsAreLostBelowTheirProbability) {
  Random random(21, 0, 0);
  std::size_t lost = 0, kept = 0;
  for (int model = 0; model < 30; ++model) {
    DropRules rules;
    for (double& weight : rules.weights) weight = random.uniform(-1.5, 1.5);
    rules.weights[0] = random.uniform(-6, 2);
    for (int i = 0; i < 3000; ++i) {
      EchoConditions echo = random_echo(random);
      if (i % 10 == 0) echo.reflectance = kNaN;
      echo.drop_log_odds = static_cast<float>(random.uniform(-4, 4));
      const double chance = drop_chance(rules, echo.range_m, echo.cos_incidence, echo.reflectance,
                                        echo.drop_log_odds);
      // Any number, and those beside the chance.
      for (const double drawn : {random.uniform(), chance * (1 - 1e-12), chance * (1 + 1e-12)}) {
        const bool is = is_lost(rules, echo.range_m, echo.cos_incidence, echo.reflectance,
                                echo.drop_log_odds, drawn);
        ASSERT_EQ(is, drawn < chance) << drawn << " " << chance;
        (is ? lost : kept) += 1;
      }
    }
  }
  EXPECT_GT(lost, 1000U);
  EXPECT_GT(kept, 1000U);
}

TEST(BlockedSectors, BelongToARingWhateverItsElevation) {
  std::vector<EchoConditions> echoes;
  std::vector<std::uint8_t> lost;
  std::vector<std::uint32_t> places;
  std::vector<std::uint16_t> rings;
  for (std::uint32_t place = 0; place < 5; ++place)
    for (int azimuth = -180; azimuth < 180; ++azimuth)
      for (const std::uint16_t ring : {std::uint16_t{7}, std::uint16_t{8}}) {
        const double elevation = (ring == 7 ? -10 : -11) + 0.03 * place + 0.02 * (azimuth % 5);
        echoes.push_back({5, 1, 0.3F, direction_of(azimuth + 0.5, elevation)});
        lost.push_back(ring == 8 && azimuth >= 20 && azimuth < 30 ? 1 : 0);
        places.push_back(place);
        rings.push_back(ring);
      }
  const std::vector<BlockedSector> blocked = find_blocked_sectors(echoes, lost, places, rings);
  ASSERT_EQ(blocked.size(), 1U);
  EXPECT_NEAR(static_cast<double>(blocked[0].elevation_rad) / kDegree, -10.94, 0.01);
  EXPECT_NEAR(static_cast<double>(blocked[0].azimuth_begin_rad) / kDegree, 20, 1e-3);
  EXPECT_NEAR(static_cast<double>(blocked[0].azimuth_end_rad) / kDegree, 30, 1e-3);
  rings.pop_back();
  EXPECT_THROW(find_blocked_sectors(echoes, lost, places, rings), std::logic_error);
}

TEST(BlockedSectors, ElevationsAreSeparatedAtTheirMiddle) {
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

}  // namespace
}  // namespace adasplats
