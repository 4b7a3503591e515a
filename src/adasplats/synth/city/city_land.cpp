// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/city_land.h"

#include <cmath>
#include <numbers>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kLandStream = 0x6c616e64;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kMaxSlopeOfBend =
    0.045;  // of one wave: crossings stay within 10 degrees of a right angle
constexpr double kMaxSlopeOfHill = 0.014;

}  // namespace

double CityLand::Wave::at(double t) const {
  return amplitude * std::sin(kTurn * t / length_m + phase);
}

CityLand::CityLand(std::uint64_t seed) {
  Random random(seed, kLandStream, 0);
  const auto draw = [&](double shortest, double longest, double slope) {
    Wave wave = {0, random.uniform(shortest, longest), random.uniform(0, kTurn)};
    wave.amplitude = random.uniform(0.2, 1) * slope * wave.length_m / kTurn;
    return wave;
  };
  for (Wave& wave : shift_east_) wave = draw(400, 1100, kMaxSlopeOfBend);
  for (Wave& wave : shift_north_) wave = draw(400, 1100, kMaxSlopeOfBend);
  for (Hill& hill : hills_) {
    hill.wave = draw(250, 1000, kMaxSlopeOfHill);
    const double direction = random.uniform(0, kTurn);
    hill.east = std::cos(direction);
    hill.north = std::sin(direction);
  }
}

Vec3d CityLand::at(double u, double v) const {
  Vec3d place = {u, v, 0};
  for (const Wave& wave : shift_east_) place.x += wave.at(v);
  for (const Wave& wave : shift_north_) place.y += wave.at(u);
  for (const Hill& hill : hills_) place.z += hill.wave.at(hill.east * u + hill.north * v);
  return place;
}

}  // namespace adasplats
