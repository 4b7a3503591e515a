// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/echoes/beam_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

/// Twelve beams, 0.2 m above the origin.
LidarModel sensor() {
  LidarModel model;
  model.name = "twelve";
  model.rotation_hz = 10;
  for (int beam = 0; beam < 12; ++beam) {
    model.elevations_rad.push_back((2 - 1.5 * beam) * kDegree);
    model.beam_origins_m.push_back({0, 0, 0.2});
  }
  return model;
}

/// The true mounting of the lasers, which find_beam_grid must estimate.
double offset_rad(std::size_t beam) { return (0.013 + 1.7 * static_cast<double>(beam)) * kDegree; }
double beside_m(std::size_t beam) { return beam % 2 == 0 ? 0.026 : -0.026; }

/// One step more or less now and then, as the clock and the encoder beat.
std::vector<int> true_firing_steps() {
  std::vector<int> steps(2150);
  for (std::size_t k = 0; k < steps.size(); ++k)
    steps[k] = static_cast<int>(std::floor(static_cast<double>(k) * 4000.0 / 2150));
  return steps;
}

struct Made {
  KittiScan scan;
  std::vector<float> ranges_m;  ///< of all that return, beam by beam
  std::size_t fired = 0;
};

/// The measurements of the beams; `returns` decides by beam and firing which return.
template <class Returns>
Made make_scan(const Returns& returns) {
  const LidarModel model = sensor();
  Made made;
  for (std::size_t beam = 0; beam < 12; ++beam) {
    for (const int step : true_firing_steps()) {
      Random random(5, beam, static_cast<std::uint64_t>(step));
      ++made.fired;
      if (!returns(beam, step, random)) continue;
      const double azimuth = step * 0.09 * kDegree + offset_rad(beam);
      const double elevation = model.elevations_rad[beam];
      const double range_m = random.uniform(3, 40);
      const Vec3d along = {std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      const Vec3d origin = {-beside_m(beam) * std::sin(azimuth), beside_m(beam) * std::cos(azimuth),
                            0.2};
      Vec3f point = vec_cast<float>(origin + range_m * along);
      for (int axis = 0; axis < 3; ++axis)
        point[axis] = std::round(point[axis] * 1000) / 1000;  // files hold millimetres
      made.scan.positions.push_back(point);
      made.scan.intensities.push_back(0.25F);
      made.ranges_m.push_back(static_cast<float>(range_m));
    }
  }
  return made;
}

const auto kNineOfTen = [](std::size_t, int, Random& random) { return random.uniform() < 0.9; };

/// Oracle: the beams that the scan was made of.
TEST(BeamGrid, FindsBeamsWithoutReturn) {
  const Made made = make_scan(kNineOfTen);
  const BeamGrid grid = find_beam_grid(made.scan, sensor());
  EXPECT_EQ(grid.columns, 2150U);
  EXPECT_EQ(grid.size(), made.fired);
  EXPECT_EQ(grid.points, made.scan.positions.size());
  EXPECT_EQ(grid.doubled, 0U);
  EXPECT_EQ(grid.outside, 0U);
  EXPECT_EQ(grid.empty(), made.fired - made.scan.positions.size());
}

TEST(BeamGrid, BeamsPassThroughTheirPoints) {
  const Made made = make_scan(kNineOfTen);
  const BeamGrid grid = find_beam_grid(made.scan, sensor());
  double sum_m = 0, true_sum_m = 0;
  std::size_t returned = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Firing& beam = grid.beams[i];
    EXPECT_NEAR(length(beam.direction), 1, 1e-5);
    EXPECT_NEAR(length(Vec3f{beam.origin.x, beam.origin.y, 0}), 0.026, 0.0021);
    EXPECT_EQ(grid.returned(i), grid.intensities[i] == 0.25F);
    EXPECT_TRUE(beam.time_s >= 0 && beam.time_s <= 0.1F) << beam.time_s;
    if (!grid.returned(i)) continue;
    sum_m += static_cast<double>(grid.ranges_m[i]);
    ++returned;
    const Vec3f end = beam.origin + grid.ranges_m[i] * beam.direction;
    // The nearest measured point of this ring and column was made from this beam; checked by sum
    // and by the distance to some point below.
    if (i % 997 != 0) continue;
    float nearest_m = 1e9F;
    for (const Vec3f& point : made.scan.positions)
      nearest_m = std::min(nearest_m, length(point - end));
    EXPECT_LT(nearest_m, 0.01F);
  }
  for (const float range_m : made.ranges_m) true_sum_m += static_cast<double>(range_m);
  EXPECT_EQ(returned, made.ranges_m.size());
  EXPECT_NEAR(sum_m / true_sum_m, 1, 1e-4);
}

TEST(BeamGrid, ColumnsGoClockwiseFromTheRearAndTimesWithThem) {
  const BeamGrid grid = find_beam_grid(make_scan(kNineOfTen).scan, sensor());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Vec3f d = grid.beams[i].direction;
    const double share = 0.5 - std::atan2(d.y, d.x) / (2 * std::numbers::pi);
    EXPECT_NEAR(grid.beams[i].time_s, 0.1 * share, 1e-6);
    EXPECT_EQ(grid.beams[i].column, i % grid.columns);
    if (i % grid.columns == 0) continue;
    const Vec3f before = grid.beams[i - 1].direction;
    EXPECT_LT(before.x * d.y - before.y * d.x, 0);
  }
}

TEST(BeamGrid, AWideGapIsBeamsWithoutReturn) {
  // Half of the rings see nothing for a quarter of a turn, the others do.
  const Made made = make_scan([](std::size_t beam, int step, Random& random) {
    return random.uniform() < 0.95 && (beam < 6 || step < 1000 || step > 2000);
  });
  const BeamGrid grid = find_beam_grid(made.scan, sensor());
  EXPECT_EQ(grid.size(), made.fired);
  EXPECT_EQ(grid.empty(), made.fired - made.scan.positions.size());
}

TEST(BeamGrid, RingsWithFewPointsAreLeftOut) {
  const Made made = make_scan([](std::size_t beam, int step, Random& random) {
    return beam == 3 ? step < 150 : random.uniform() < 0.9;
  });
  const BeamGrid grid = find_beam_grid(made.scan, sensor());
  EXPECT_EQ(grid.size(), made.fired / 12 * 11);
  EXPECT_EQ(grid.outside, made.scan.positions.size() - grid.points);
  EXPECT_GT(grid.outside, 0U);
}

TEST(BeamGrid, DoublesAndStrangersAreCounted) {
  Made made = make_scan(kNineOfTen);
  made.scan.positions.push_back(made.scan.positions[7]);
  made.scan.positions.push_back({5, 5, 30});
  made.scan.positions.push_back({kNaN, 0, 0});
  made.scan.positions.push_back({0, 0, 0});
  made.scan.intensities.clear();
  const BeamGrid grid = find_beam_grid(made.scan, sensor());
  EXPECT_EQ(grid.doubled, 1U);
  EXPECT_EQ(grid.outside, 3U);
  EXPECT_EQ(grid.points, made.scan.positions.size() - 4);
  for (const float intensity : grid.intensities) EXPECT_TRUE(std::isnan(intensity));
}

TEST(BeamGrid, OtherPointsAreAnError) {
  const auto expect_data_error = [](const KittiScan& scan) {
    try {
      find_beam_grid(scan, sensor());
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::data);
    }
  };
  expect_data_error({});
  // On the cones, but on no lattice: as motion compensation leaves them.
  Made bent = make_scan(kNineOfTen);
  for (Vec3f& point : bent.scan.positions) {
    const float turn = 0.005F * std::sin(3 * std::atan2(point.y, point.x));
    point = {point.x - turn * point.y, point.y + turn * point.x, point.z};
  }
  expect_data_error(bent.scan);
  LidarModel none = sensor();
  none.elevations_rad.clear();
  EXPECT_THROW(find_beam_grid({}, none), Error);
}

}  // namespace
}  // namespace adasplats
