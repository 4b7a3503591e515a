// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/beam_surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

struct Found {
  std::size_t flat = 0, rough = 0, edge = 0;
};

/// Beams of a grid of 60 x 20 directions, 0.2 and 0.4 degrees apart, with ranges of
/// range_of(column, row, direction).
template <class RangeOf>
Found found_in(const RangeOf& range_of) {
  std::vector<Vec3f> points;
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 60; ++column) {
      const double azimuth = 0.2 * column * std::numbers::pi / 180;
      const double elevation = -0.4 * (row + 5) * std::numbers::pi / 180;
      const Vec3d d = {std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      points.push_back(vec_cast<float>(range_of(column, row, d) * d));
    }
  }
  const auto surroundings = surroundings_of(points, Executor(2));
  const auto count = [&](Surroundings of) {
    return static_cast<std::size_t>(std::ranges::count(surroundings, of));
  };
  return {count(Surroundings::flat), count(Surroundings::rough), count(Surroundings::edge)};
}

double of_ground(Vec3d d) { return -1.7 / d.z; }

// Oracle: the shape that was scanned.
TEST(SurroundingsOf, GroundIsFlatAlthoughItsRingsAreApart) {
  const Found found = found_in([](int, int, Vec3d d) { return of_ground(d); });
  EXPECT_EQ(found.flat, 1200U);
}

TEST(SurroundingsOf, AWallBeforeAnotherHasAnEdge) {
  const Found found =
      found_in([](int column, int, Vec3d d) { return (column < 30 ? 5 : 8) / d.x; });
  EXPECT_GE(found.edge, 40U);  // a column on either side
  EXPECT_LE(found.edge, 120U);
  EXPECT_EQ(found.edge + found.flat, 1200U);
}

TEST(SurroundingsOf, ScatteredEndsAreRough) {
  const Found found = found_in([](int column, int row, Vec3d) {
    Random random(1, static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(column));
    return 10 + random.uniform(-0.3, 0.3);
  });
  EXPECT_GT(found.rough, 1150U);
}

TEST(SurroundingsOf, FewPointsHaveSurroundingsToo) {
  EXPECT_TRUE(surroundings_of({}, Executor(2)).empty());
  const std::vector<Vec3f> points = {{1, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(surroundings_of(points, Executor(2))[1], Surroundings::rough);
}

}  // namespace
}  // namespace adasplats
