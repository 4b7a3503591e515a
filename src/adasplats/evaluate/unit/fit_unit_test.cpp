// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/unit/fit_unit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/unit/field_fit.h"
#include "adasplats/simulate/scan/firing_report.h"

namespace adasplats {
namespace {

constexpr std::uint16_t kRings = 16;
constexpr std::uint32_t kColumns = 1000, kScans = 8;
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// A unit whose parameters are known.
struct Truth {
  std::vector<float> levels = {0, 1}, zero_share = {0.6F, 0}, reported;
  FieldShares zero_field = {0.3, 0.1, 0.4, 0}, texture_field = {0, 0.3, 0.2, 0};
  FieldShares drop_field = {0.1, 0.2, 0.5, 0};
  IntensityRules rules;

  Truth() {
    for (const float level : levels)
      for (std::uint32_t k = 0; k < kTextureNodes; ++k)
        reported.push_back(0.05F + level * (0.5F + texture_node(k) / 8));
    rules.on = true;
    rules.step = 0.01F;
    rules.highest = 0.8F;
    rules.level_count = 2;
    rules.levels = levels.data();
    rules.zero_share = zero_share.data();
    rules.reported = reported.data();
    rules.zero = field_weights(zero_field);
    rules.texture = field_weights(texture_field);
    rules.unevenness = 0.6;
  }
};

double noise_m_of(std::uint32_t ring) { return 0.004 + 0.001 * ring; }

/// Beams of scans that the truth measured: walls whose reflectance wanders, 10 to 30 m away, and
/// one in sixteen farther than the unit sees.
std::vector<UnitBeam> measured_by(const Truth& truth) {
  const FieldWeights drop = field_weights(truth.drop_field);
  std::vector<UnitBeam> beams;
  for (std::uint32_t scan = 0; scan < kScans; ++scan)
    for (std::uint16_t ring = 0; ring < kRings; ++ring)
      for (std::uint32_t column = 0; column < kColumns; ++column) {
        const BeamFieldParts fields = beam_field_parts(5, scan, ring, column);
        Random random(9, scan, std::uint64_t{ring} * kColumns + column);
        UnitBeam beam;
        beam.scan = scan;
        beam.ring = ring;
        beam.column = column;
        beam.hit = true;
        const double turn = 0.01 * column + 0.3 * ring;
        beam.expected_m = static_cast<float>(20 + 10 * std::sin(0.1 * turn));
        if (column % 16 == 0) beam.expected_m = 60;
        beam.expected_intensity = static_cast<float>(0.5 + 0.45 * std::sin(turn + scan));
        beam.reflectance = beam.expected_intensity;
        beam.direction = {1, 0, 0};
        constexpr double chance = 0.1;
        const bool lost = normal_share(field_value(fields, BeamField::drop, drop)) < chance;
        beam.range_m = beam.expected_m + static_cast<float>(noise_m_of(ring) * random.normal());
        beam.intensity = unit_intensity(truth.rules, ring, beam.expected_intensity, fields);
        if (lost || beam.expected_m > 50) beam.range_m = beam.intensity = kNothing;
        beams.push_back(beam);
      }
  return beams;
}

class FitUnit : public testing::Test {
 protected:
  Truth truth_;
  std::vector<UnitBeam> beams_ = measured_by(truth_);
};

// Oracle: the noise that was drawn. 6 %: five deviations of a ring's 7,000 differences, which
// overlap, and the middle half tells half of what all would.
TEST_F(FitUnit, FindsTheNoiseOfEachRing) {
  const std::vector<double> noise_m = fit_ring_noise_m(beams_, kRings);
  ASSERT_EQ(noise_m.size(), kRings);
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    EXPECT_NEAR(noise_m[ring] / noise_m_of(ring), 1, 0.06) << ring;
}

// Oracle: the unit that was drawn.
TEST_F(FitUnit, FindsHowIntensitiesAreMade) {
  const auto unit = fit_unit_intensity(beams_, kRings);
  ASSERT_TRUE(unit.has_value());
  EXPECT_NEAR(unit->step, 0.01, 1e-6);
  EXPECT_NEAR(unit->highest, 0.8, 1e-6);
  for (std::size_t k = 0; k < kFieldOctaves; ++k) {
    EXPECT_NEAR(unit->zero_field[k], truth_.zero_field[k], 0.15) << k;
    EXPECT_NEAR(unit->texture_field[k], truth_.texture_field[k], 0.15) << k;
  }
  EXPECT_NEAR(unit->texture_unevenness, 0.6, 0.15);
  // What the fitted unit makes of the same beams: as many zeros, the same mean, as much spread.
  const IntensityRules rules = [&] {
    Truth holder;
    IntensityRules made = holder.rules;
    made.rings = kRings;
    made.ring_nodes = static_cast<std::uint32_t>(unit->ring_nodes);
    made.ring_expected = unit->ring_expected.data();
    made.ring_level = unit->ring_level.data();
    made.level_count = static_cast<std::uint32_t>(unit->levels.size());
    made.levels = unit->levels.data();
    made.zero_share = unit->zero_share.data();
    made.reported = unit->reported.data();
    made.zero = field_weights(unit->zero_field);
    made.texture = field_weights(unit->texture_field);
    made.unevenness = unit->texture_unevenness;
    return made;
  }();
  double zeros[2] = {0, 0}, sums[2] = {0, 0}, squares[2] = {0, 0}, count = 0;
  for (const UnitBeam& beam : beams_) {
    if (!beam.returned()) continue;
    const float values[2] = {
        beam.intensity, unit_intensity(rules, beam.ring, beam.expected_intensity,
                                       beam_field_parts(77, beam.scan, beam.ring, beam.column))};
    ++count;
    for (const int side : {0, 1}) {
      const auto value = static_cast<double>(values[side]);
      zeros[side] += value == 0 ? 1 : 0;
      sums[side] += value;
      squares[side] += value * value;
    }
  }
  EXPECT_NEAR(zeros[1] / count, zeros[0] / count, 0.03);
  EXPECT_NEAR(sums[1] / count, sums[0] / count, 0.02);
  EXPECT_NEAR(squares[1] / squares[0], 1, 0.08);
}

// Oracle: the field and the share that were drawn.
TEST_F(FitUnit, FindsInWhatPatchesEchoesAreLost) {
  const auto drop = fit_unit_drop(beams_, 50);
  ASSERT_TRUE(drop.has_value());
  ASSERT_TRUE(drop->field.has_value());
  for (std::size_t k = 0; k < kFieldOctaves; ++k)
    EXPECT_NEAR((*drop->field)[k], truth_.drop_field[k], 0.2) << k;
  EXPECT_NEAR(drop->probability({20, 1, 0.5F, {}}), 0.1, 0.03);
}

// Oracle: no return is from beyond 30 m, where a sixteenth of the beams meet something.
TEST_F(FitUnit, FindsWhereReturnsEnd) {
  const auto limit_m = fit_max_range_m(beams_);
  ASSERT_TRUE(limit_m.has_value());
  EXPECT_GE(*limit_m, 30);
  EXPECT_LE(*limit_m, 30.2);
  for (UnitBeam& beam : beams_) beam.expected_m = std::min(beam.expected_m, 30.0F);
  EXPECT_FALSE(fit_max_range_m(beams_).has_value());
}

TEST(FitUnitOfFew, TellsNothingAndSaysSo) {
  const std::vector<UnitBeam> none;
  const UnitFit fit = fit_unit(none, 16, 100);
  EXPECT_TRUE(fit.ring_noise_m.empty());
  EXPECT_FALSE(fit.intensity || fit.drop || fit.max_range_m);
  EXPECT_EQ(fit.not_told.size(), 3U);
}

// Oracle: what the shares were made of; and the fields of scans.
TEST(FieldFit, FindsTheSharesOfCorrelations) {
  const FieldShares truth = {0.2, 0.1, 0.4, 0.05};
  LagCorrelations correlations{};
  for (std::size_t l = 0; l < kFieldLags.size(); ++l)
    for (std::size_t k = 0; k < kFieldOctaves; ++k)
      correlations[l] += truth[k] * octave_correlation(k, kFieldLags[l]);
  const FieldShares found = shares_of(correlations);
  for (std::size_t k = 0; k < kFieldOctaves; ++k) EXPECT_NEAR(found[k], truth[k], 0.01);
  EXPECT_EQ(octave_correlation(0, 0), 1);
  EXPECT_EQ(octave_correlation(0, 6), 0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959964, 1e-5);
}

}  // namespace
}  // namespace adasplats
