// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/divergence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/words.h"

namespace adasplats {
namespace {

/// Intensity of a Gaussian beam off its axis, that on it being 1.
double intensity(double off_rad, double full_e2_rad) {
  const double radius = 0.5 * full_e2_rad;
  return std::exp(-2.0 * off_rad * off_rad / (radius * radius));
}

// Oracle: the definitions, on the profile of a Gaussian beam.
TEST(Divergence, EveryKindIsItsLevelOfAGaussianBeam) {
  const double stated = 3e-3;
  const double level = std::exp(-2.0);
  const auto at = [&](DivergenceKind kind, double off) {
    return intensity(off, full_e2_angle_rad(stated, kind));
  };
  EXPECT_NEAR(at(DivergenceKind::fwhm, 0.5 * stated), 0.5, 1e-12);
  EXPECT_NEAR(at(DivergenceKind::full_e2, 0.5 * stated), level, 1e-12);
  EXPECT_NEAR(at(DivergenceKind::half_e2, stated), level, 1e-12);
  EXPECT_NEAR(at(DivergenceKind::unknown, 0.5 * stated), level, 1e-12);
}

// Oracle: the published factor; half the energy of a Gaussian beam lies within its half maximum.
TEST(Divergence, HalfTheEnergyLiesWithinTheHalfMaximum) {
  const double radius = 0.5 * full_e2_angle_rad(1.0, DivergenceKind::fwhm);
  EXPECT_NEAR(radius, 0.849, 5e-4);
  EXPECT_NEAR(1.0 - std::exp(-2.0 * 0.25 / (radius * radius)), 0.5, 1e-12);
}

TEST(Divergence, EveryKindHasAWordOfItsOwn) {
  for (const auto& [word, kind] : kDivergenceKinds)
    EXPECT_EQ(word_of(kind, kDivergenceKinds), word);
  EXPECT_EQ(full_e2_angle_rad(0, DivergenceKind::fwhm), 0.0);
}

}  // namespace
}  // namespace adasplats
