// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/weather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/simulate/scan/firing_report.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {
namespace {

LidarModel test_sensor() {
  LidarModel sensor;
  sensor.name = "test";
  sensor.max_range_m = 100;
  sensor.divergence_rad[0] = 3e-3;
  sensor.divergence_rad[1] = 1.5e-3;
  return sensor;
}

std::vector<Firing> fan(std::size_t count) {
  std::vector<Firing> firings;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t column = i / 4;
    const auto turn = 6.28F * static_cast<float>(i) / static_cast<float>(count);
    firings.push_back({{std::cos(turn), std::sin(turn), 0},
                       static_cast<std::uint16_t>(i % 4),
                       static_cast<std::uint32_t>(column),
                       1e-6F * static_cast<float>(column),
                       {0, 0, 0.5F}});
  }
  return firings;
}

/// A return of every firing at one range.
Scan wall(const std::vector<Firing>& firings, float range_m, float intensity) {
  Scan scan;
  scan.rays = firings.size();
  scan.time_s = 12.5;
  for (const Firing& firing : firings) {
    scan.positions.push_back(firing.origin + range_m * firing.direction);
    scan.ranges_m.push_back(range_m);
    scan.intensities.push_back(intensity);
    scan.classes.push_back(50);
    scan.instances.push_back(3);
    scan.rings.push_back(firing.ring);
    scan.columns.push_back(firing.column);
    scan.times_s.push_back(firing.time_s);
  }
  return scan;
}

/// Where the returns of a firing end that begin at `begin`, in a scan in the order of its firings.
std::size_t end_of_firing(const Scan& scan, std::size_t begin, const Firing& firing) {
  std::size_t end = begin;
  while (end < scan.size() && scan.rings[end] == firing.ring &&
         scan.columns[end] == firing.column && scan.times_s[end] == firing.time_s &&
         (end == begin || (!scan.return_indices.empty() &&
                           scan.return_indices[end] > scan.return_indices[end - 1])))
    ++end;
  return end;
}

/// What in_air() makes of the returns of a clear scan, firing by firing.
Scan in_weather(const Scan& clear, std::span<const Firing> firings, const LidarModel& sensor,
                const BeamOptions& beam, const Weather& weather, std::uint64_t seed,
                std::uint64_t scan_index) {
  std::vector<double> expected;
  FiringRules rules;
  rules.air = air_rules(weather, sensor, expected);
  if (rules.air.is_clear()) return clear;
  rules.beam = beam;
  rules.min_range_m = static_cast<float>(sensor.min_range_m);
  rules.max_range_m = static_cast<float>(sensor.max_range_m);
  rules.range_noise_m = sensor.range_noise_m;
  rules.range_resolution_m = sensor.range_resolution_m;
  Scan scan;
  scan.rays = clear.rays;
  scan.time_s = clear.time_s;
  std::size_t begin = 0;
  for (std::uint32_t i = 0; i < firings.size(); ++i) {
    const Firing& firing = firings[i];
    const std::size_t end = end_of_firing(clear, begin, firing);
    std::array<ReportedReturn, 8> returns;
    int count = 0;
    for (; begin < end; ++begin)
      returns.at(static_cast<std::size_t>(count++)) = {
          clear.ranges_m[begin], static_cast<std::uint32_t>(begin),
          clear.intensities.empty() ? std::numeric_limits<float>::quiet_NaN()
                                    : clear.intensities[begin],
          0, 0};
    count = in_air<8>(rules, returns.data(), count, rules.range_noise_m,
                      Random(weather_seed(seed), scan_index, i));
    for (int k = 0; k < count; ++k) {
      const ReportedReturn& one = returns.at(static_cast<std::size_t>(k));
      const bool in_the_air = one.primitive == Hit::kNone;
      scan.positions.push_back(firing.origin + one.range_m * firing.direction);
      scan.ranges_m.push_back(one.range_m);
      if (!clear.intensities.empty()) scan.intensities.push_back(one.intensity);
      if (!clear.classes.empty())
        scan.classes.push_back(in_the_air ? std::uint16_t{0} : clear.classes[one.primitive]);
      if (!clear.instances.empty())
        scan.instances.push_back(in_the_air ? std::uint16_t{0} : clear.instances[one.primitive]);
      scan.rings.push_back(firing.ring);
      scan.columns.push_back(firing.column);
      scan.times_s.push_back(firing.time_s);
      if (beam.returns > 1) scan.return_indices.push_back(static_cast<std::uint8_t>(one.index));
    }
  }
  EXPECT_EQ(begin, clear.size());
  return scan;
}

/// A return of the first firing alone, too near to be lost or to have anything before it.
Scan sky(const std::vector<Firing>& firings) {
  Scan scan = wall({firings[0]}, 0.5F, 0.01F);
  scan.rays = firings.size();
  return scan;
}

void expect_equal(const Scan& a, const Scan& b) {
  EXPECT_EQ(a.rays, b.rays);
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.ranges_m, b.ranges_m);
  EXPECT_EQ(a.intensities, b.intensities);
  EXPECT_EQ(a.classes, b.classes);
  EXPECT_EQ(a.instances, b.instances);
  EXPECT_EQ(a.rings, b.rings);
  EXPECT_EQ(a.columns, b.columns);
  EXPECT_EQ(a.times_s, b.times_s);
  EXPECT_EQ(a.return_indices, b.return_indices);
}

/// Every attribute has one value a point and nothing is NaN or out of range.
void expect_sound(const Scan& scan, const LidarModel& sensor) {
  EXPECT_EQ(scan.ranges_m.size(), scan.size());
  EXPECT_EQ(scan.rings.size(), scan.size());
  EXPECT_EQ(scan.columns.size(), scan.size());
  EXPECT_EQ(scan.times_s.size(), scan.size());
  for (const auto size : {scan.intensities.size(), scan.classes.size(), scan.instances.size(),
                          scan.return_indices.size()})
    EXPECT_TRUE(size == 0 || size == scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ASSERT_TRUE(is_finite(scan.positions[i]));
    ASSERT_GT(static_cast<double>(scan.ranges_m[i]), sensor.min_range_m);
    ASSERT_LE(static_cast<double>(scan.ranges_m[i]), sensor.max_range_m);
    ASSERT_NEAR(static_cast<double>(length(scan.positions[i] - Vec3f{0, 0, 0.5F})),
                static_cast<double>(scan.ranges_m[i]), 1e-4);
  }
  EXPECT_TRUE(std::ranges::all_of(scan.intensities, [](float value) { return value >= 0; }));
}

/// Within 5 standard deviations of a binomial share.
void expect_share(std::size_t found, std::size_t all, double share) {
  const auto n = static_cast<double>(all);
  EXPECT_NEAR(static_cast<double>(found) / n, share, 5 * std::sqrt(share * (1 - share) / n) + 1e-9);
}

TEST(Weather, ClearAirLeavesTheScanUnchanged) {
  const auto firings = fan(100);
  Scan scan = wall(firings, 50, 0.5F);
  EXPECT_TRUE(Weather{}.is_clear());
  expect_equal(in_weather(scan, firings, test_sensor(), {}, {}, 1, 2), scan);
  expect_equal(in_weather(scan, firings, test_sensor(), {}, {.fog_visibility_m = 0}, 1, 2), scan);
  EXPECT_EQ(reported_share({}, test_sensor(), 90, 0.1), 1.0);
  EXPECT_EQ(clutter_share({}, test_sensor(), 90), 0.0);
}

// Oracle: published relations. Koschmieder; pi N0 / Lambda^3 of Marshall and Palmer 1948, which is
// 0.365 R^0.63 per km; snow of 1 mm/h has a visibility of about 1 km.
TEST(Weather, ExtinctionMatchesTheLiterature) {
  EXPECT_NEAR(extinction_per_m({.fog_visibility_m = 100}), 0.03912, 1e-12);
  for (const double rate : {1.0, 10.0, 50.0})
    EXPECT_NEAR(1e3 * extinction_per_m({.rain_mm_h = rate}), 0.365 * std::pow(rate, 0.63),
                0.002 * std::pow(rate, 0.63));
  const double visibility_m = 3.912 / extinction_per_m({.snow_mm_h = 1});
  EXPECT_GT(visibility_m, 800);
  EXPECT_LT(visibility_m, 1500);
  EXPECT_DOUBLE_EQ(extinction_per_m({.rain_mm_h = 5, .fog_visibility_m = 300, .snow_mm_h = 2}),
                   extinction_per_m({.rain_mm_h = 5}) +
                       extinction_per_m({.fog_visibility_m = 300}) +
                       extinction_per_m({.snow_mm_h = 2}));
}

// Oracle: Beer and Lambert, there and back.
TEST(Weather, IntensityFallsOverTheWayThereAndBack) {
  const auto firings = fan(500);
  const Weather fog{.fog_visibility_m = 200};
  const Scan scan = in_weather(wall(firings, 30, 0.8F), firings, test_sensor(), {}, fog, 1, 0);
  std::size_t of_wall = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.classes[i] != 50) continue;
    ++of_wall;
    ASSERT_EQ(scan.ranges_m[i], 30.0F) << "a sensor without noise has none in fog";
    ASSERT_NEAR(static_cast<double>(scan.intensities[i]), 0.8 * std::exp(-2 * 3.912 / 200 * 30),
                1e-6);
  }
  EXPECT_GT(of_wall, 300U);
}

// Oracle: exp(-(exp(2 alpha r) - 1) / m), here from its words; reported far from what could answer
// in the air in mode "last".
TEST(Weather, ReturnsAreLostByTheFormula) {
  const auto firings = fan(20'000);
  const LidarModel sensor = test_sensor();
  const BeamOptions last{.mode = ReturnMode::last};
  for (const Weather& weather : {Weather{.rain_mm_h = 50}, Weather{.fog_visibility_m = 150},
                                 Weather{.snow_mm_h = 2, .white_intensity = 255}}) {
    for (const float range_m : {20.0F, 60.0F, 95.0F}) {
      const auto white = static_cast<float>(weather.white_intensity);
      const Scan scan =
          in_weather(wall(firings, range_m, 0.4F * white), firings, sensor, last, weather, 7, 0);
      const double r = static_cast<double>(range_m);
      const double alpha = extinction_per_m(weather);
      const double m = 0.4 / 0.8 * (100.0 / r) * (100.0 / r);
      const double expected = std::exp(-(std::exp(2 * alpha * r) - 1) / m);
      EXPECT_NEAR(reported_share(weather, sensor, r, 0.4), expected, 1e-6);
      const auto reported = std::ranges::count(scan.classes, std::uint16_t{50});
      expect_share(static_cast<std::size_t>(reported), firings.size(), expected);
      expect_sound(scan, sensor);
    }
  }
}

TEST(Weather, UnknownAndTinyReflectancesCountAsDocumented) {
  const Weather rain{.rain_mm_h = 30};
  const LidarModel sensor = test_sensor();
  EXPECT_EQ(reported_share(rain, sensor, 60, kNaN), reported_share(rain, sensor, 60, 0.3));
  EXPECT_EQ(reported_share(rain, sensor, 60, 0), reported_share(rain, sensor, 60, 0.01));
  EXPECT_LT(reported_share(rain, sensor, 60, 0.1), reported_share(rain, sensor, 60, 0.3));
  const auto firings = fan(20'000);
  Scan scan = wall(firings, 60, 0);
  scan.intensities.clear();
  const Scan wet = in_weather(scan, firings, sensor, {.mode = ReturnMode::last}, rain, 1, 0);
  EXPECT_TRUE(wet.intensities.empty());
  expect_share(static_cast<std::size_t>(std::ranges::count(wet.classes, std::uint16_t{50})),
               firings.size(), reported_share(rain, sensor, 60, 0.3));
}

/// Answers of the air per metre at a range, by the formulas of docs/noise.md.
double answers_per_m(const Weather& weather, double r, double max_range_m) {
  const double pi = std::numbers::pi;
  const double alpha = extinction_per_m(weather);
  const double needed =
      std::max(0.8 * (r / max_range_m) * (r / max_range_m), 0.005) * std::exp(2 * alpha * r);
  const double width_m = std::sqrt((0.011 + 3e-3 * r) * (0.011 + 1.5e-3 * r));
  const auto particles = [&](double n0, double slope, double reflectance) {
    const double share = std::sqrt(needed / reflectance);
    if (share > 1) return 0.0;
    return pi / 4 * width_m * width_m * n0 * std::exp(-slope * 1000 * width_m * share);
  };
  double sum = 0;
  if (weather.rain_mm_h > 0) {
    const double slope = 4.1 * std::pow(weather.rain_mm_h, -0.21);
    sum += particles(8000 / slope, slope, 2 * pi / 18.8);
  }
  if (weather.snow_mm_h > 0) {
    const double slope = 2.55 * std::pow(weather.snow_mm_h, -0.48);
    sum += particles(3800 * std::pow(weather.snow_mm_h, -0.87) / slope,
                     slope / std::pow(10, 1.0 / 3), 2 * pi / 25);
  }
  if (weather.fog_visibility_m < 1e6) {
    const double backscatter = 0.046 * (3.912 / weather.fog_visibility_m) / std::log(20.0);
    sum += std::exp(-needed / (pi * backscatter * 0.75)) / 0.75;
  }
  return sum;
}

/// Answers to expect between two ranges: midpoints, 1 mm.
double answers_between(const Weather& weather, double from_m, double to_m) {
  double sum = 0;
  for (double r = from_m + 0.0005; r < to_m; r += 0.001)
    sum += 0.001 * answers_per_m(weather, r, 100);
  return sum;
}

// Oracle: the integral of the rates by another rule, and Pearson's chi-square of the ranges.
TEST(Weather, ClutterFollowsTheFormula) {
  const auto firings = fan(50'000);
  const LidarModel sensor = test_sensor();
  for (const Weather& weather :
       {Weather{.rain_mm_h = 100}, Weather{.fog_visibility_m = 60}, Weather{.snow_mm_h = 1}}) {
    const Scan scan = in_weather(sky(firings), firings, sensor, {}, weather, 3, 9);
    const double all = answers_between(weather, 1, 100);
    EXPECT_NEAR(clutter_share(weather, sensor, 100), 1 - std::exp(-all), 1e-4);
    expect_share(scan.size() - 1, firings.size(), 1 - std::exp(-all));
    expect_sound(scan, sensor);
    const std::vector<double> edges{1, 1.5, 2, 2.5, 3, 4, 5, 7, 10, 100};
    double chi_square = 0;
    double before = 0;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      const double within = answers_between(weather, edges[i], edges[i + 1]);
      const double share = std::exp(-before) - std::exp(-before - within);
      before += within;
      const auto found = std::ranges::count_if(scan.ranges_m, [&](float r) {
        return static_cast<double>(r) > edges[i] && static_cast<double>(r) <= edges[i + 1];
      });
      const double expected = share * static_cast<double>(firings.size());
      const double off = static_cast<double>(found) - expected;
      if (expected > 5) chi_square += off * off / expected;
    }
    EXPECT_LT(chi_square, 33.7) << "9 degrees of freedom, 1 in 10,000";
    ASSERT_GT(scan.size(), 1U);
    EXPECT_EQ(std::ranges::count(scan.classes, 0), static_cast<std::ptrdiff_t>(scan.size()) - 1);
    EXPECT_EQ(std::ranges::count(scan.instances, 0), static_cast<std::ptrdiff_t>(scan.size()) - 1);
    EXPECT_LE(std::ranges::max(scan.intensities), 0.34F) << "2 pi / 18.8 at most";
  }
}

TEST(Weather, ClutterOccursAtAnyRangeBeyondTheMinimum) {
  const auto firings = fan(20'000);
  LidarModel sensor = test_sensor();
  sensor.min_range_m = 3;
  const Weather snow{.snow_mm_h = 1};
  Scan scan = in_weather(sky(firings), firings, sensor, {}, snow, 3, 9);
  scan.ranges_m.erase(scan.ranges_m.begin());  // the return of the sky
  const double share = 1 - std::exp(-answers_between(snow, 3, 100));
  expect_share(scan.ranges_m.size(), firings.size(), share);
  EXPECT_NEAR(clutter_share(snow, sensor, 100), share, 1e-4);
  EXPECT_GT(std::ranges::min(scan.ranges_m), 3.0F);
  std::ranges::sort(scan.ranges_m);
  const auto count = static_cast<std::ptrdiff_t>(scan.ranges_m.size());
  const auto same = std::unique(scan.ranges_m.begin(), scan.ranges_m.end());
  EXPECT_GT(same - scan.ranges_m.begin(), count - count / 100) << "not on a grid";
}

TEST(Weather, NoClutterBehindAWall) {
  const auto firings = fan(5'000);
  const BeamOptions first{.mode = ReturnMode::first};
  const Weather snow{.snow_mm_h = 2};
  const Scan scan = in_weather(wall(firings, 4, 0.5F), firings, test_sensor(), first, snow, 1, 0);
  EXPECT_GT(scan.size(), firings.size() - 20) << "next to nothing gets lost at 4 m";
  EXPECT_LE(std::ranges::max(scan.ranges_m), 4.0F);
  expect_share(static_cast<std::size_t>(std::ranges::count(scan.classes, std::uint16_t{0})),
               firings.size(), clutter_share(snow, test_sensor(), 4));
}

TEST(Weather, ModesDecideBetweenAirAndWall) {
  const auto firings = fan(5'000);
  const Weather snow{.snow_mm_h = 5};
  const Scan clear = wall(firings, 12, 0.1F);
  const auto of_air = [&](const BeamOptions& beam) {
    const Scan scan = in_weather(clear, firings, test_sensor(), beam, snow, 1, 0);
    expect_sound(scan, test_sensor());
    return static_cast<std::size_t>(std::ranges::count(scan.classes, std::uint16_t{0}));
  };
  const std::size_t first = of_air({.mode = ReturnMode::first});
  const std::size_t strongest = of_air({.mode = ReturnMode::strongest});
  const std::size_t last = of_air({.mode = ReturnMode::last});
  EXPECT_GT(first, 1000U);
  EXPECT_LT(strongest, first / 2) << "the wall is stronger than most flakes";
  EXPECT_LT(last, 50U) << "where the wall is lost";
  EXPECT_LT(last, strongest);
  EXPECT_EQ(of_air({.returns = 2, .mode = ReturnMode::first}), first);

  const BeamOptions dual{.returns = 2, .mode = ReturnMode::last};
  const Scan scan = in_weather(clear, firings, test_sensor(), dual, snow, 1, 0);
  ASSERT_EQ(scan.return_indices.size(), scan.size());
  EXPECT_GT(scan.size(), firings.size());
  for (std::size_t i = 1; i < scan.size(); ++i) {
    if (scan.return_indices[i] == 0) continue;
    ASSERT_EQ(scan.return_indices[i], 1);
    ASSERT_EQ(scan.return_indices[i - 1], 0);
    ASSERT_EQ(scan.rings[i], scan.rings[i - 1]);
    ASSERT_EQ(scan.columns[i], scan.columns[i - 1]);
    ASSERT_LT(scan.ranges_m[i], scan.ranges_m[i - 1]);
  }
}

TEST(Weather, KeepsTheReturnsOfAFiringTogether) {
  const auto firings = fan(3);
  Scan clear = wall({firings[0], firings[0], firings[2]}, 5, 0.9F);
  clear.ranges_m = {5, 9, 7};
  clear.positions[1] = firings[0].origin + 9.0F * firings[0].direction;
  clear.positions[2] = firings[2].origin + 7.0F * firings[2].direction;
  clear.return_indices = {0, 1, 0};
  const BeamOptions dual{.returns = 2, .mode = ReturnMode::first};
  const Weather haze{.fog_visibility_m = 1e5};
  const Scan scan = in_weather(clear, firings, test_sensor(), dual, haze, 1, 0);
  EXPECT_EQ(scan.ranges_m, clear.ranges_m);
  EXPECT_EQ(scan.return_indices, clear.return_indices);
  EXPECT_EQ(scan.rings, clear.rings);
  EXPECT_EQ(scan.positions, clear.positions);
}

// Oracle: noise as the inverse root of the power, sigma exp(alpha r); sigma itself is in the scan.
TEST(Weather, RangeNoiseGrows) {
  const auto firings = fan(20'000);
  LidarModel sensor = test_sensor();
  sensor.range_noise_m = 0.02;
  const Weather fog{.fog_visibility_m = 400};
  const Scan scan =
      in_weather(wall(firings, 40, 1), firings, sensor, {.mode = ReturnMode::last}, fog, 5, 0);
  double sum = 0;
  double squares = 0;
  double n = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.classes[i] != 50) continue;
    const double off = static_cast<double>(scan.ranges_m[i]) - 40;
    sum += off;
    squares += off * off;
    ++n;
  }
  const double sigma = 0.02 * std::sqrt(std::exp(2 * 3.912 / 400 * 40) - 1);
  EXPECT_GT(n, 15'000);
  EXPECT_NEAR(sum / n, 0, 5 * sigma / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), sigma, 5 * sigma / std::sqrt(2 * n));
  expect_sound(scan, sensor);
}

TEST(Weather, RangesKeepTheResolutionOfTheSensor) {
  const auto firings = fan(2'000);
  LidarModel sensor = test_sensor();
  sensor.range_noise_m = 0.02;
  sensor.range_resolution_m = 0.25;
  const Scan scan =
      in_weather(wall(firings, 40, 1), firings, sensor, {}, {.fog_visibility_m = 100}, 5, 0);
  ASSERT_FALSE(scan.ranges_m.empty());
  for (const float range_m : scan.ranges_m) ASSERT_EQ(std::fmod(range_m, 0.25F), 0.0F);
}

TEST(Weather, DependsOnlyOnSeedScanAndFiring) {
  const auto firings = fan(4'000);
  const LidarModel sensor = test_sensor();
  const Weather weather{.rain_mm_h = 30, .snow_mm_h = 0.5};
  const Scan clear = wall(firings, 70, 0.4F);
  const Scan expected = in_weather(clear, firings, sensor, {}, weather, 1, 2);
  expect_equal(in_weather(clear, firings, sensor, {}, weather, 1, 2), expected);
  EXPECT_NE(in_weather(clear, firings, sensor, {}, weather, 2, 2).columns, expected.columns);
  EXPECT_NE(in_weather(clear, firings, sensor, {}, weather, 1, 3).columns, expected.columns);
  // The second half of the firings has the same weather when the first half returned nothing.
  Scan half = wall({firings.begin() + 2'000, firings.end()}, 70, 0.4F);
  half.rays = firings.size();
  const Scan of_half = in_weather(half, firings, sensor, {}, weather, 1, 2);
  const auto tail = [](const Scan& scan) {
    std::vector<float> ranges;
    for (std::size_t i = 0; i < scan.size(); ++i)
      if (scan.columns[i] >= 500) ranges.push_back(scan.ranges_m[i]);
    return ranges;
  };
  EXPECT_EQ(tail(of_half), tail(expected));
}

TEST(Weather, NoFiringsAndNoRangeLeftAreNoReturns) {
  EXPECT_EQ(in_weather(Scan{}, {}, test_sensor(), {}, {.rain_mm_h = 10}, 1, 0).size(), 0U);
  LidarModel blind = test_sensor();
  blind.min_range_m = 100;
  const auto firings = fan(100);
  EXPECT_EQ(in_weather(sky(firings), firings, blind, {}, {.fog_visibility_m = 20}, 1, 0).size(),
            1U);
  const Weather wool{.fog_visibility_m = 1e-3};
  EXPECT_EQ(in_weather(wall(firings, 50, 1), firings, test_sensor(), {}, wool, 1, 0).size(), 0U)
      << "no light gets through a millimetre of visibility";
}

TEST(Weather, RejectsInvalidWeather) {
  const LidarModel sensor = test_sensor();
  for (const Weather& wrong :
       {Weather{.rain_mm_h = -1}, Weather{.rain_mm_h = kNaN}, Weather{.fog_visibility_m = -5},
        Weather{.fog_visibility_m = kNaN}, Weather{.snow_mm_h = -1}, Weather{.snow_mm_h = kNaN},
        Weather{.rain_mm_h = 1, .white_intensity = 0}}) {
    try {
      in_weather(Scan{}, {}, sensor, {}, wrong, 1, 0);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
  }
}

}  // namespace
}  // namespace adasplats
