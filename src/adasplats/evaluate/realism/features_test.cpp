// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "adasplats/evaluate/realism/drawn_scan_test.h"

namespace adasplats {
namespace {

using test::drawn_scan;
using test::DrawnReturn;
using test::kDrawnColumns;
using test::kDrawnRings;
using test::kDrawnStep_rad;

double statistic(const RingScan& scan, const std::string& name, const ScanFile& file = {}) {
  const std::vector<double> values = statistics_of_scan(scan, kDrawnStep_rad, file);
  for (std::size_t s = 0; s < scan_statistics().size(); ++s)
    if (scan_statistics()[s].name == name) return values.at(s);
  ADD_FAILURE() << name;
  return 0;
}

/// Mean of a feature over the patches of a scan that have it.
double feature(const RingScan& scan, const std::string& name) {
  const std::vector<float> values = features_of_patches(scan, kDrawnStep_rad);
  double sum = 0, count = 0;
  for (std::size_t f = 0; f < patch_features().size(); ++f) {
    if (patch_features()[f].name != name) continue;
    for (std::size_t i = f; i < values.size(); i += patch_features().size()) {
      if (values[i] != values[i]) continue;
      sum += static_cast<double>(values[i]);
      ++count;
    }
    return sum / count;
  }
  ADD_FAILURE() << name;
  return 0;
}

/// Range to the ground 1.7 m below, or to a wall 10 m around where that is nearer.
double street_m(std::size_t ring) {
  const double elevation_rad = test::drawn_elevation_rad(ring);
  const double wall_m = 10 / std::cos(elevation_rad);
  return elevation_rad < 0 ? std::min(wall_m, -1.7 / std::sin(elevation_rad)) : wall_m;
}

TEST(Features, TheNoiseOfRangesIsFound) {
  for (const double sigma_m : {0.005, 0.02}) {
    const RingScan scan = drawn_scan([&](std::size_t ring, std::size_t column) {
      Random random = test::of_beam(1, ring, column);
      return DrawnReturn{street_m(ring) + sigma_m * random.normal()};
    });
    EXPECT_NEAR(statistic(scan, "range_noise_m"), sigma_m, 0.02 * sigma_m);
    // Second differences of white noise: -4 to 6.
    EXPECT_NEAR(feature(scan, "second_lag"), -2.0 / 3, 0.01);
    // The mean of all that is from the 50th to the 90th percentile of |x|, x normal: the integral
    // of 2 x phi(x) is -2 phi(x), from 0.6745 to 1.6449.
    const auto phi = [](double x) {
      return std::exp(-0.5 * x * x) / std::sqrt(2 * std::acos(-1.0));
    };
    const double high = 2 * (phi(0.6745) - phi(1.6449)) / 0.4;
    EXPECT_NEAR(std::exp(feature(scan, "second_high")), high * std::sqrt(6) * sigma_m,
                0.03 * sigma_m);
  }
}

TEST(Features, IgnoreStepsOfRangesAndFloatsOfIntensities) {
  // Ranges in steps of 2 mm, as a sensor has them, and the same moved by half a millimetre;
  // intensities in hundredths, and the next floats.
  const auto scan_with = [](double moved_m, float towards) {
    return drawn_scan([=](std::size_t ring, std::size_t column) {
      Random random = test::of_beam(5, ring, column);
      const double range_m = 0.002 * std::round((10 + 0.02 * random.normal()) / 0.002);
      const float intensity = 0.01F * std::round(static_cast<float>(100 * random.uniform()));
      return DrawnReturn{range_m + moved_m * std::sin(static_cast<double>(column)),
                         std::nextafter(intensity, towards)};
    });
  };
  const std::vector<float> one = features_of_patches(scan_with(0, 0), kDrawnStep_rad);
  const std::vector<float> other = features_of_patches(scan_with(2e-4, 1), kDrawnStep_rad);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    const PatchFeature& each = patch_features()[k % patch_features().size()];
    if (std::string(each.name).starts_with("intensity_") &&
        std::string(each.name) != "intensity_second_lag") {
      EXPECT_EQ(one[k], other[k]) << each.name;
    }
    if (std::string(each.name).starts_with("second_")) {
      EXPECT_NEAR(one[k], other[k], 2e-3) << each.name;
    }
  }
}

TEST(Features, NoiseThatNeighboursShareIsAnotherOne) {
  const RingScan scan = drawn_scan([&](std::size_t ring, std::size_t column) {
    double sum = 0;  // of five neighbours each
    for (std::size_t k = 0; k < 5; ++k) sum += test::of_beam(1, ring, column + k).normal();
    return DrawnReturn{street_m(ring) + 0.01 * sum};
  });
  // Autocovariance of x is 5 - |lag|; of second differences -c(0) 4 + ... : by that sequence.
  const auto c = [](int lag) { return std::max(0, 5 - std::abs(lag)); };
  const double own = 6 * c(0) - 8 * c(1) + 2 * c(2);
  const double next = -4 * c(0) + 7 * c(1) - 4 * c(2) + c(3);
  EXPECT_NEAR(feature(scan, "second_lag"), next / own, 0.02);
}

TEST(Features, OffsetsOfLasersAreFound) {
  std::vector<double> offsets_m;
  double squares = 0;
  for (std::size_t ring = 0; ring < kDrawnRings; ++ring) {
    offsets_m.push_back(0.03 * Random(2, 8, ring).normal());
    squares += offsets_m.back() * offsets_m.back();
  }
  const double deviation_m = std::sqrt(squares / kDrawnRings);
  const auto scan_with = [&](double share) {
    return drawn_scan([&](std::size_t ring, std::size_t column) {
      Random random = test::of_beam(3, ring, column);
      // A plane wall all around cannot be: the ground and four walls.
      const Vec3d d = test::drawn_direction(ring, column);
      const double wall_m = 10 / std::max(std::fabs(d.x), std::fabs(d.y));
      const double range_m = d.z < 0 ? std::min(wall_m, -1.7 / d.z) : wall_m;
      return DrawnReturn{range_m + share * offsets_m[ring] + 0.01 * random.normal()};
    });
  };
  EXPECT_NEAR(statistic(scan_with(1), "laser_offsets_m"), deviation_m, 0.2 * deviation_m);
  EXPECT_LT(statistic(scan_with(0), "laser_offsets_m"), 0.003);
  EXPECT_GT(feature(scan_with(1), "rings_off_plane"), feature(scan_with(0), "rings_off_plane") + 1);
}

TEST(Features, RunsOfMissingBeamsAreCounted) {
  // In each of the 64 sectors of 32 beams of a ring: a run of 1, one of 3 and one of 8.
  const auto is_missing = [](std::size_t column) {
    const std::size_t k = column % 32;
    return k == 2 || (k >= 6 && k < 9) || (k >= 16 && k < 24);
  };
  const RingScan scan =
      drawn_scan([&](std::size_t, std::size_t column) -> std::optional<DrawnReturn> {
        if (is_missing(column)) return {};
        return DrawnReturn{10};
      });
  constexpr double kSectors = kDrawnRings * kDrawnColumns / 32;
  EXPECT_EQ(statistic(scan, "returns"), 20 * kSectors);
  EXPECT_EQ(statistic(scan, "missing"), 12 * kSectors);
  EXPECT_EQ(statistic(scan, "missing_runs_of_1"), kSectors);
  EXPECT_EQ(statistic(scan, "missing_runs_6_to_20"), 8 * kSectors);
  EXPECT_NEAR(feature(scan, "missing"), 12.0 / 32, 1e-6);
  EXPECT_NEAR(feature(scan, "runs_of_1"), 1.0 / 20, 1e-6);
  EXPECT_NEAR(feature(scan, "runs_to_5"), 1.0 / 20, 1e-6);
  EXPECT_NEAR(feature(scan, "runs_to_20"), 1.0 / 20, 1e-6);
  EXPECT_NEAR(feature(scan, "missing_next"), 9.0 / 12, 1e-6);
  EXPECT_NEAR(feature(scan, "missing_below"), 1, 1e-6);
  EXPECT_EQ(feature(scan, "nothing"), 0);
}

TEST(Features, LongRunsAreSkyAndNoDropouts) {
  // 100 beams over the border of patches.
  const RingScan scan =
      drawn_scan([&](std::size_t ring, std::size_t column) -> std::optional<DrawnReturn> {
        if (ring % 2 == 0 && column >= 60 && column < 160) return {};
        return DrawnReturn{10};
      });
  EXPECT_EQ(statistic(scan, "missing"), 0);
  EXPECT_EQ(feature(scan, "missing"), 0);
  EXPECT_NEAR(feature(scan, "nothing"), 0.5 * 100 / kDrawnColumns, 1e-3);
}

TEST(Features, EdgesAndPointsInBetween) {
  // A post of 8 beams in every 64, 5 m before the wall; of every second one a point in between.
  const RingScan scan = drawn_scan([&](std::size_t ring, std::size_t column) {
    const std::size_t k = column % 64;
    if (k == 8 && ring % 2 == 0) return DrawnReturn{7.5};
    return DrawnReturn{k >= 8 && k < 16 ? 5.0 : 10.0};
  });
  // Pairs over the border of patches count to the patch of the first, triples of the middle one.
  EXPECT_NEAR(feature(scan, "edges"), 2.5 / 64, 1e-3);
  EXPECT_NEAR(feature(scan, "between"), 0.5 / 64, 1e-3);
  EXPECT_EQ(feature(scan, "isolated"), 0);
}

TEST(Features, IntensitiesThatAreZeroOrEqualAreCounted) {
  // Per ring: 16 zeros in a row of 64, the others by turns.
  const RingScan scan = drawn_scan([&](std::size_t ring, std::size_t column) {
    const std::size_t k = column % 64;
    const float level = ring % 2 == 0 ? 0.25F : 0.75F;
    return DrawnReturn{10, k < 16 ? 0.0F : level + (k % 2 == 0 ? 0.125F : 0.0F)};
  });
  EXPECT_NEAR(statistic(scan, "intensity_zeros"), 0.25, 1e-9);
  EXPECT_NEAR(statistic(scan, "intensity_zero_next"), 15.0 / 16, 1e-4);
  EXPECT_EQ(statistic(scan, "intensity_most"), 0.875);
  EXPECT_NEAR(feature(scan, "equal"), 15.0 / 64, 1e-3);
  EXPECT_NEAR(feature(scan, "intensity_second_50"), 0.25, 1e-6);
  EXPECT_NEAR(feature(scan, "intensity_rings"), 0.5, 1e-6);
}

TEST(Features, TheNoiseOfIntensitiesIsFound) {
  const RingScan scan = drawn_scan([&](std::size_t ring, std::size_t column) {
    Random random = test::of_beam(4, ring, column);
    return DrawnReturn{10, static_cast<float>(0.5 + 0.03 * random.normal())};
  });
  EXPECT_NEAR(statistic(scan, "intensity_noise"), 0.03, 0.02 * 0.03);
}

TEST(Features, JitterOfAzimuthsIsFound) {
  // Azimuths to whole steps of an encoder that is 1.86 times as fine: gaps are 1 or 2 of its steps.
  RingScan scan;
  scan.begins = {0};
  double sum = 0, squares = 0;
  for (int k = 0, before = 0; k < 2150; ++k) {
    const int step = static_cast<int>(std::floor(k * 4000.0 / 2150));
    scan.azimuths_rad.push_back(static_cast<float>(step * 2 * std::numbers::pi / 4000));
    scan.ranges_m.push_back(10);
    scan.intensities.push_back(1);
    scan.directions.push_back({1, 0, 0});
    if (k > 0) sum += step - before;
    if (k > 0) squares += (step - before) * (step - before);
    before = step;
  }
  scan.begins.push_back(scan.size());
  const double step_rad = 2 * std::numbers::pi / 2150;
  count_missing(scan, step_rad);
  const double deviation = std::sqrt(squares / 2149 - sum / 2149 * (sum / 2149)) * 2150 / 4000;
  const std::vector<double> values = statistics_of_scan(scan, step_rad, {});
  const auto named = std::ranges::find(scan_statistics(), std::string("azimuth_jitter"),
                                       [](const ScanStatistic& s) { return std::string(s.name); });
  EXPECT_NEAR(values.at(static_cast<std::size_t>(named - scan_statistics().begin())), deviation,
              1e-4);
}

TEST(Features, AreNaNWithoutIntensities) {
  KittiScan points = test::drawn_points([](std::size_t, std::size_t) { return DrawnReturn{10}; });
  points.intensities.clear();
  RingScan scan = arrange_in_rings({}, 0, points, test::kDrawnHeights_m);
  count_missing(scan, kDrawnStep_rad);
  EXPECT_TRUE(std::isnan(feature(scan, "intensity_50")));
  EXPECT_TRUE(std::isnan(statistic(scan, "intensity_zeros")));
}

TEST(Features, PatchesOfSkyAreLeftOut) {
  const RingScan scan =
      drawn_scan([&](std::size_t ring, std::size_t) -> std::optional<DrawnReturn> {
        if (ring < 7) return {};  // of the first eight rings one returns: less than a quarter
        return DrawnReturn{10};
      });
  EXPECT_EQ(features_of_patches(scan, kDrawnStep_rad).size(),
            patch_features().size() * 7 * (kDrawnColumns / kPatchColumns));
}

TEST(Features, StatisticsHaveTheNamesOfTheirValues) {
  const RingScan scan = drawn_scan([](std::size_t, std::size_t) { return DrawnReturn{10}; });
  EXPECT_EQ(statistics_of_scan(scan, kDrawnStep_rad, {}).size(), scan_statistics().size());
  const ScanFile file = {.unfolded_rings = 64, .near_points = 37};
  EXPECT_EQ(statistic(scan, "near_points", file), 37);
  EXPECT_EQ(statistic(scan, "unfolded_rings", file), 64);
  EXPECT_NEAR(statistic(scan, "range_most_m"), 10, 1e-5);
}

}  // namespace
}  // namespace adasplats
