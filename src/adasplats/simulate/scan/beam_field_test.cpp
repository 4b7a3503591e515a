// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/beam_field.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "adasplats/simulate/scan/intensity_rules.h"

namespace adasplats {
namespace {

constexpr std::uint32_t kRings = 64, kColumns = 2000, kScans = 6;

/// Fields of some scans, ring by ring.
std::vector<double> fields_of(BeamField field, const FieldShares& shares) {
  const FieldWeights weights = field_weights(shares);
  std::vector<double> values;
  for (std::uint32_t scan = 0; scan < kScans; ++scan)
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
      for (std::uint32_t column = 0; column < kColumns; ++column)
        values.push_back(field_value(beam_field_parts(7, scan, ring, column), field, weights));
  return values;
}

double mean_product(const std::vector<double>& a, const std::vector<double>& b, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = 0; i + lag < a.size(); ++i) sum += a[i] * b[i + lag];
  return sum / static_cast<double>(a.size() - lag);
}

// Oracle: analytic. 0.006: five deviations of the mean of 768,000 white numbers; 0.1: of 4 x 8 x 11
// patches of the coarsest octave in each of six scans, thrice over.
TEST(BeamField, IsNormalWithTheVarianceOfItsShares) {
  const std::vector<double> white = fields_of(BeamField::drop, {});
  EXPECT_NEAR(mean_product(white, std::vector<double>(white.size(), 1), 0), 0, 0.006);
  EXPECT_NEAR(mean_product(white, white, 0), 1, 0.01);
  EXPECT_NEAR(mean_product(white, white, 1), 0, 0.006);
  EXPECT_NEAR(mean_product(white, white, kColumns), 0, 0.006);
  const std::vector<double> mixed = fields_of(BeamField::zero, {0.2, 0.2, 0.2, 0.2});
  EXPECT_NEAR(mean_product(mixed, mixed, 0), 1, 0.1);
  std::size_t below = 0;
  for (const double value : mixed) below += value < -1 ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(below) / static_cast<double>(mixed.size()), normal_share(-1),
              0.02);
}

// Oracle: fields of four kinds are said not to depend on each other.
TEST(BeamField, FieldsAreIndependent) {
  const std::vector<double> white = fields_of(BeamField::texture, {0.2, 0.3, 0.1, 0});
  for (const BeamField other : {BeamField::drop, BeamField::zero, BeamField::unevenness})
    EXPECT_NEAR(mean_product(white, fields_of(other, {0.2, 0.3, 0.1, 0}), 0), 0, 0.05);
}

TEST(BeamField, IsAFunctionOfSeedScanRingAndColumn) {
  const auto first_of = [](std::uint64_t seed, std::uint64_t scan, std::uint32_t ring,
                           std::uint32_t column) {
    return beam_field_parts(seed, scan, ring, column).of[0][kOctaves];
  };
  const double one = first_of(1, 2, 3, 4);
  EXPECT_EQ(first_of(1, 2, 3, 4), one);
  EXPECT_NE(first_of(2, 2, 3, 4), one);
  EXPECT_NE(first_of(1, 3, 3, 4), one);
  EXPECT_NE(first_of(1, 2, 4, 4), one);
  EXPECT_NE(first_of(1, 2, 3, 5), one);
}

// Oracle: analytic. The mean square of a log-normal amplitude is made 1, whatever the unevenness.
TEST(BeamField, UnevenTexturesKeepTheirVariance) {
  const FieldWeights weights = field_weights({});
  for (const double unevenness : {0.0, 0.5, 0.9}) {
    double squares = 0;
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
      for (std::uint32_t column = 0; column < kColumns; ++column) {
        const double value =
            texture_value(beam_field_parts(3, 0, ring, column), weights, unevenness, 2);
        squares += value * value;
      }
    EXPECT_NEAR(squares / (kRings * kColumns), 4, 0.4) << unevenness;
  }
}

/// Two levels, a gain a ring, textures of half to twice the level.
struct DrawnUnit {
  std::vector<float> expected = {0, 1, 0, 1}, level = {0, 1, 0, 0.5F}, levels = {0, 1};
  std::vector<float> zero_share = {1, 0}, reported;
  IntensityRules rules;

  DrawnUnit() {
    for (const float one : levels)
      for (std::uint32_t k = 0; k < kTextureNodes; ++k)
        reported.push_back(one * (1 + texture_node(k) / 6));
    rules.on = true;
    rules.step = 0.25F;
    rules.highest = 1.25F;
    rules.rings = 2;
    rules.ring_nodes = 2;
    rules.level_count = 2;
    rules.ring_expected = expected.data();
    rules.ring_level = level.data();
    rules.levels = levels.data();
    rules.zero_share = zero_share.data();
    rules.reported = reported.data();
    rules.zero = rules.texture = field_weights({});
  }
};

// Oracle: by hand from the tables.
TEST(UnitIntensities, FollowTheTables) {
  const DrawnUnit unit;
  EXPECT_EQ(level_of(unit.rules, 0, 0.5F), 0.5F);
  EXPECT_EQ(level_of(unit.rules, 1, 0.5F), 0.25F);
  EXPECT_EQ(level_of(unit.rules, 2, 0.7F), 0.7F);  // no such ring
  for (std::uint32_t k = 0; k < kTextureNodes; ++k)
    EXPECT_NEAR(textured(unit.rules, 0.5F, static_cast<double>(texture_node(k))),
                0.5F * (1 + texture_node(k) / 6), 1e-6F);
  EXPECT_NEAR(textured(unit.rules, 1, -9), 0.5F, 1e-6F);
  EXPECT_NEAR(textured(unit.rules, 1, 9), 1.5F, 1e-6F);
  EXPECT_EQ(converted(unit.rules, 0.6F), 0.5F);
  EXPECT_EQ(converted(unit.rules, 9), 1.25F);
  EXPECT_EQ(converted(unit.rules, -1), 0);
}

// Oracle: analytic: half of the beams of level 0.5 report zero, the others a step at least.
TEST(UnitIntensities, AreZeroOrSteps) {
  const DrawnUnit unit;
  std::size_t zeros = 0;
  constexpr std::uint32_t kBeams = 20'000;
  for (std::uint32_t column = 0; column < kBeams; ++column) {
    const float value = unit_intensity(unit.rules, 0, 0.5F, beam_field_parts(1, 0, 0, column));
    zeros += value == 0 ? 1 : 0;
    ASSERT_EQ(value / 0.25F, std::round(value / 0.25F));
    ASSERT_LE(value, 1.25F);
  }
  EXPECT_NEAR(static_cast<double>(zeros) / kBeams, 0.5, 0.02);
  EXPECT_EQ(unit_intensity(unit.rules, 0, 0, beam_field_parts(1, 0, 0, 0)), 0);
  EXPECT_GT(unit_intensity(unit.rules, 0, 1, beam_field_parts(1, 0, 0, 0)), 0);
}

}  // namespace
}  // namespace adasplats
