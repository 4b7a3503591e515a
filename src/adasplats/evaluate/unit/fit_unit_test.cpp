// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/unit/fit_unit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/unit/beam_shares.h"
#include "adasplats/simulate/scan/firing_report.h"

namespace adasplats {
namespace {

constexpr std::uint16_t kRings = 16;
constexpr std::uint32_t kColumns = 1000, kScans = 8;
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// A sensor with known parameters.
struct Truth {
  SensorIntensity unit;
  IntensityRules rules;

  Truth() {
    unit.step = 0.01;
    unit.highest = 0.8;
    unit.levels = {0, 1};
    unit.zero_share = {0.6F, 0};
    for (const float level : unit.levels)
      for (std::uint32_t k = 0; k < kTextureNodes; ++k)
        unit.reported.push_back(0.05F + level * (0.1F + 0.8F * texture_node(k)));
    rules = intensity_rules(unit);
  }
};

double noise_m_of(std::uint32_t ring) { return 0.004 + 0.001 * ring; }

constexpr double kLostShare = 0.1, kLostAtEdge = 0.3;

/// The common value of four successive beams.
double patchy_share(std::uint32_t scan, std::uint16_t ring, std::uint32_t column,
                    std::uint64_t stream) {
  return Random(scan, stream, std::uint64_t{ring} << 32 | column / 4).uniform();
}

/// Simulated beams of scans: walls with varying reflectance, 10 to 30 m away, and
/// one in sixteen farther than the unit sees. Every fifty beams a wall steps forward or back: of
/// these edges some lose one beam.
std::vector<SensorBeam> measured_by(const Truth& truth) {
  std::vector<SensorBeam> beams;
  for (std::uint32_t scan = 0; scan < kScans; ++scan)
    for (std::uint16_t ring = 0; ring < kRings; ++ring)
      for (std::uint32_t column = 0; column < kColumns; ++column) {
        Random random(9, scan, std::uint64_t{ring} * kColumns + column);
        SensorBeam beam;
        beam.scan = beam.place = scan;
        beam.ring = ring;
        beam.column = column;
        beam.hit = true;
        const double turn = 0.01 * column + 0.3 * ring;
        beam.expected_m =
            static_cast<float>(20 + 9 * std::sin(0.1 * turn) + (column / 50 % 2 == 0 ? 1 : -1));
        if (column % 160 == 75) beam.expected_m = 60;
        beam.expected_intensity = static_cast<float>(0.5 + 0.45 * std::sin(turn + scan));
        beam.reflectance = beam.expected_intensity;
        beam.direction = {1, 0, 0};
        const bool at_edge = column > 0 && column % 50 == 0 && random.uniform() < kLostAtEdge;
        const bool lost = at_edge || patchy_share(scan, ring, column, 1) < kLostShare;
        beam.range_m = beam.expected_m + static_cast<float>(noise_m_of(ring) * random.normal());
        beam.intensity = unit_intensity(
            truth.rules, ring, beam.expected_intensity,
            {patchy_share(scan, ring, column, 3), patchy_share(scan, ring, column, 2)});
        if (lost || beam.expected_m > 50) beam.range_m = beam.intensity = kNothing;
        beams.push_back(beam);
      }
  return beams;
}

constexpr UnitPattern kPattern = {kRings, kColumns, 50};

/// Share of the pairs so far apart that are on one side of the half.
double alike_share(const SensorFields& fields, SensorField field, std::size_t apart) {
  const auto high = [&](std::size_t beam) {
    return fields.bytes[beam * kSensorFields + static_cast<std::size_t>(field)] >= 128;
  };
  double alike = 0, pairs = 0;
  for (std::size_t beam = 0; beam + apart < fields.bytes.size() / kSensorFields; ++beam) {
    alike += high(beam) == high(beam + apart) ? 1 : 0;
    ++pairs;
  }
  return alike / pairs;
}

class FitUnit : public testing::Test {
 protected:
  Truth truth_;
  std::vector<SensorBeam> beams_ = measured_by(truth_);
};

// Oracle: the noise that was drawn. 6 %: five deviations of a ring's 7,000 differences, which
// overlap, and the middle half contains half of their information.
TEST_F(FitUnit, FindsTheNoiseOfEachRing) {
  const std::vector<double> noise_m = fit_ring_noise_m(beams_, kRings);
  ASSERT_EQ(noise_m.size(), kRings);
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    EXPECT_NEAR(noise_m[ring] / noise_m_of(ring), 1, 0.06) << ring;
}

// Oracle: the unit that was drawn.
TEST_F(FitUnit, FindsTheIntensityModel) {
  const auto fit = fit_unit_intensity(beams_, kRings);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->unit.step, 0.01, 1e-6);
  EXPECT_NEAR(fit->unit.highest, 0.8, 1e-6);
  // What the fitted unit makes of the same beams: as many zeros, the same mean, as much spread; and
  // of the shares that it found the very intensities, but for what is between its nodes.
  const IntensityRules rules = intensity_rules(fit->unit);
  double zeros[2] = {0, 0}, sums[2] = {0, 0}, squares[2] = {0, 0}, count = 0, errors = 0;
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    const SensorBeam& beam = beams_[i];
    if (!beam.returned()) continue;
    ASSERT_EQ(fit->zeros[i], fit->zeros[i]);
    ASSERT_EQ(fit->shares[i] == fit->shares[i], beam.intensity > 0);
    const auto again = [&](double zero, double below) {
      return unit_intensity(rules, beam.ring, beam.expected_intensity, {zero, below});
    };
    Random random(77, 0, i);
    const double zero = random.uniform();
    const float values[2] = {beam.intensity, again(zero, random.uniform())};
    const auto below = static_cast<double>(beam.intensity > 0 ? fit->shares[i] : 0.5F);
    const float repeated = again(static_cast<double>(fit->zeros[i]), below);
    EXPECT_EQ(repeated == 0, beam.intensity == 0);
    errors += std::fabs(static_cast<double>(beam.intensity - repeated));
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
  EXPECT_LT(errors / count, 0.03);  // shares are drawn together
}

// Oracle: beams with expected intensities that jump from one to the next, as models' do and
// measured ones do not: their shares have the opposite jumps, and in another scene both would
// appear.
TEST_F(FitUnit, SmoothsSharesWhereTheModelJumps) {
  const std::vector<SensorBeam> smooth = beams_;
  std::vector<float> shares = fit_unit_intensity(smooth, kRings)->shares;
  const std::vector<float> as_fitted = shares;
  EXPECT_GT(damp_shares(smooth, fit_unit_intensity(smooth, kRings)->unit, shares), 0.8);
  for (std::size_t i = 0; i < beams_.size(); ++i)
    beams_[i].expected_intensity += 0.15F * static_cast<float>(Random(5, 0, i).normal());
  const auto fit = fit_unit_intensity(beams_, kRings);
  const auto roughness = [](const std::vector<float>& of) {
    double sum = 0, count = 0;
    for (std::size_t i = 2; i < of.size(); ++i) {
      const float second = of[i] - 2 * of[i - 1] + of[i - 2];
      if (second != second) continue;
      sum += std::fabs(static_cast<double>(second));
      ++count;
    }
    return sum / count;
  };
  std::vector<float> again = fit->shares;
  EXPECT_LT(damp_shares(beams_, fit->unit, again), 1);
  EXPECT_LT(roughness(again), roughness(fit->shares));
}

// Oracle: the shares that were drawn. 0.04: five deviations of 2,400 edges.
TEST_F(FitUnit, FindsLostBeams) {
  const auto drop = fit_unit_drop(beams_, 50);
  ASSERT_TRUE(drop.has_value());
  // A tenth of the edges has lost its neighbours anyhow, and runs are longer there.
  ASSERT_EQ(drop->model.edge_runs.size(), kMaxEdgeRun);
  EXPECT_NEAR(drop->model.edge_runs[0], kLostAtEdge * (1 - 2 * kLostShare), 0.04);
  EXPECT_NEAR(drop_probability(drop->model, {20, 1, 0.5F, {}}), kLostShare, 0.03);
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    const float share = drop->shares[i];
    if (share != share) continue;
    const double chance = drop_probability(
        drop->model, {beams_[i].expected_m, 1, beams_[i].reflectance, beams_[i].direction});
    ASSERT_EQ(static_cast<double>(share) < chance, !beams_[i].returned()) << i;
  }
}

// Oracle: patches of four beams: three in four of neighbours are of one patch, the others are alike
// as often as not.
TEST_F(FitUnit, KeepsSimilarityOfNeighbours) {
  const UnitFit fit = fit_unit(beams_, kPattern);
  ASSERT_TRUE(fit.fields.has_value());
  EXPECT_EQ(fit.fields->rings, kRings);
  EXPECT_EQ(fit.fields->columns, kColumns);
  ASSERT_EQ(fit.fields->bytes.size(),
            std::size_t{fit.fields->turns} * kRings * kColumns * kSensorFields);
  EXPECT_GT(alike_share(*fit.fields, SensorField::intensity, 1), 0.8);
  EXPECT_NEAR(alike_share(*fit.fields, SensorField::intensity, 8), 0.5, 0.05);
  EXPECT_NEAR(alike_share(*fit.fields, SensorField::noise, 1), 0.5, 0.05);
}

// Oracle: the noise that was drawn, from the numbers as a scan reads them.
TEST_F(FitUnit, FieldsHaveTheNoiseOfEachRing) {
  const UnitFit fit = fit_unit(beams_, kPattern);
  ASSERT_TRUE(fit.fields.has_value());
  const UnitFieldRules rules = {fit.fields->bytes.data(), fit.fields->turns, fit.fields->rings,
                                fit.fields->columns};
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    double squares = 0;
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const double noise_m = beam_fields(rules, 3, 8, ring, column, 0).noise_m;
      squares += noise_m * noise_m;
    }
    EXPECT_NEAR(std::sqrt(squares / kColumns) / noise_m_of(ring), 1, 0.15) << ring;
  }
}

// Oracle: no return is from beyond 30 m, where a sixteenth of the beams meet something.
TEST_F(FitUnit, FindsTheMaximumRange) {
  const auto limit_m = fit_max_range_m(beams_);
  ASSERT_TRUE(limit_m.has_value());
  EXPECT_GE(*limit_m, 30);
  EXPECT_LE(*limit_m, 30.2);
  for (SensorBeam& beam : beams_) beam.expected_m = std::min(beam.expected_m, 30.0F);
  EXPECT_FALSE(fit_max_range_m(beams_).has_value());
}

// Oracle: what was put there. A roof 1.5 m away in half a degree of one ring, from which two beams
// in three return; a car behind for one scan; a wall that the model has.
TEST_F(FitUnit, FindsTheBodyOfTheVehicle) {
  const auto look = [](double azimuth_deg) {
    const double azimuth = azimuth_deg * kDegree;
    return Vec3f{static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth)), 0};
  };
  std::size_t roofs = 0, of_roof = 0;
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    SensorBeam& beam = beams_[i];
    beam.direction = look(360.0 * (beam.column + 0.5) / kColumns - 180);
    const bool on_roof = beam.ring == 3 && body_column(beam.direction) == 400;
    if (on_roof) {
      ++roofs;
      if (i % 3 == 0) continue;
      ++of_roof;
      beam.range_m = 1.5F + 0.01F * static_cast<float>(i % 2);
      beam.intensity = 0.25F;
    }
    if (beam.ring == 5 && body_column(beam.direction) == 100 && beam.scan == 1) beam.range_m = 3;
    if (beam.ring == 6 && body_column(beam.direction) == 100) beam.range_m = beam.expected_m = 3;
  }
  ASSERT_GT(of_roof, 3U);
  const std::optional<VehicleBody> body = fit_vehicle_body(beams_);
  ASSERT_TRUE(body.has_value());
  ASSERT_EQ(body->cells.size(), 1U);
  const BodyCell& cell = body->cells[0];
  EXPECT_EQ(cell.ring, 3);
  EXPECT_EQ(cell.column, 400);
  EXPECT_NEAR(cell.share, static_cast<double>(of_roof) / static_cast<double>(roofs), 1e-6);
  EXPECT_NEAR(cell.range_m, 1.505, 0.006);
  EXPECT_EQ(cell.intensity, 0.25F);
  // Two standpoints are not enough: a car behind may be standing, too.
  for (SensorBeam& beam : beams_) beam.place = beam.scan % 2;
  EXPECT_FALSE(fit_vehicle_body(beams_).has_value());
}

TEST(FitUnitOfFew, ReportsThatNothingIsEstimated) {
  const std::vector<SensorBeam> none;
  const UnitFit fit = fit_unit(none, {16, 100, 100});
  EXPECT_TRUE(fit.ring_noise_m.empty());
  EXPECT_FALSE(fit.intensity || fit.drop || fit.fields || fit.max_range_m);
  EXPECT_EQ(fit.not_estimated.size(), 4U);  // blocked directions, too
}

}  // namespace
}  // namespace adasplats
