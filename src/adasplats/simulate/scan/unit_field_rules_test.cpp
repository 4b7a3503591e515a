// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/unit_field_rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "adasplats/simulate/scan/edge_runs.h"
#include "adasplats/simulate/scan/intensity_rules.h"

namespace adasplats {
namespace {

/// Two turns of 3 rings and 1000 columns: bytes 0 and 3 are the ring, byte 1 the column by its last
/// digits.
std::vector<std::uint8_t> numbered_fields() {
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t turn = 0; turn < 2; ++turn)
    for (std::uint32_t ring = 0; ring < 3; ++ring)
      for (std::uint32_t column = 0; column < 1000; ++column) {
        bytes.push_back(static_cast<std::uint8_t>(ring));
        bytes.push_back(static_cast<std::uint8_t>(column % 250));
        bytes.push_back(static_cast<std::uint8_t>(128 + 127 * turn));
        bytes.push_back(static_cast<std::uint8_t>(10 * ring));
      }
  return bytes;
}

// Oracle: by hand from what the bytes mean.
TEST(SensorFields, AreOneTurnTurnedBySomeColumns) {
  const std::vector<std::uint8_t> bytes = numbered_fields();
  const UnitFieldRules rules = {bytes.data(), 2, 3, 1000};
  std::set<double> firsts, noises_m;
  for (std::uint64_t scan = 0; scan < 50; ++scan) {
    const BeamFields first = beam_fields(rules, 1, scan, 2, 0, 0);
    const auto start = static_cast<std::uint32_t>(std::floor(first.intensity * 256));
    firsts.insert(first.intensity);
    noises_m.insert(first.noise_m);
    for (std::uint32_t column = 0; column < 1000; ++column) {
      const BeamFields beam = beam_fields(rules, 1, scan, 2, column, 0);
      ASSERT_DOUBLE_EQ(beam.drop, 2.5 * 2.5 / 65536);
      ASSERT_DOUBLE_EQ(beam.zero, 20.5 * 20.5 / 65536);
      ASSERT_DOUBLE_EQ(beam.intensity, ((start + column) % 250 + 0.5) / 256);
      ASSERT_EQ(beam.noise_m, first.noise_m);
    }
    // Later returns have other numbers; rings that no field has, those of others.
    EXPECT_NE(beam_fields(rules, 1, scan, 2, 0, 1).intensity, first.intensity);
    EXPECT_DOUBLE_EQ(beam_fields(rules, 1, scan, 5, 0, 0).drop, first.drop);
  }
  EXPECT_GT(firsts.size(), 25U);
  EXPECT_EQ(noises_m, (std::set<double>{0, kMaxFieldNoise_m}));
  EXPECT_NE(beam_fields(rules, 1, 0, 0, 0, 0).intensity,
            beam_fields(rules, 2, 0, 0, 0, 0).intensity);
}

/// Two levels, a gain a ring, textures of half to one and a half of the level.
struct DrawnUnit {
  SensorIntensity unit;
  IntensityRules rules;

  DrawnUnit() {
    unit.step = 0.25;
    unit.highest = 1.25;
    unit.ring_nodes = 2;
    unit.ring_expected = {0, 1, 0, 1};
    unit.ring_level = {0, 1, 0, 0.5F};
    unit.levels = {0, 1};
    unit.zero_share = {1, 0};
    for (const float one : unit.levels)
      for (std::uint32_t k = 0; k < kTextureNodes; ++k)
        unit.reported.push_back(one * (0.5F + texture_node(k)));
    rules = intensity_rules(unit);
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
                0.5F * (0.5F + texture_node(k)), 1e-6F);
  EXPECT_EQ(converted(unit.rules, 0.6F), 0.5F);
  EXPECT_EQ(converted(unit.rules, 9), 1.25F);
  EXPECT_EQ(converted(unit.rules, -1), 0);
  // Of level 0.5 half report zero; the middle of the others is the level.
  EXPECT_EQ(unit_intensity(unit.rules, 0, 0.5F, {0.49, 0.5}), 0);
  EXPECT_EQ(unit_intensity(unit.rules, 0, 0.5F, {0.51, 0.02}), 0.25F);
  EXPECT_EQ(unit_intensity(unit.rules, 0, 0.5F, {0.51, 0.5}), 0.5F);
  EXPECT_EQ(unit_intensity(unit.rules, 0, 0, {0.99, 0.99}), 0);
  EXPECT_EQ(unit_intensity(unit.rules, 0, 1, {0, 0}), 0.5F);
}

/// A ring of 4000 firings that meets a wall 10 m away, behind every tenth beam one 20 m away for
/// five beams.
struct SteppedWall {
  std::vector<Firing> firings;
  std::vector<Hit> hits;

  SteppedWall() {
    for (std::uint32_t column = 0; column < 4000; ++column) {
      firings.push_back(
          {{1, 0, 0}, static_cast<std::uint16_t>(column / 1000), column % 1000, 0, {}});
      hits.push_back({column / 5 % 2 == 0 ? 10.0F : 20.0F, 0});
    }
  }
  ScanHits all() const { return {hits.data(), 1, 0, static_cast<std::uint32_t>(hits.size())}; }
};

// Oracle: the shares that are asked for. Runs of one are on either side of an edge; of four rings
// one above the other they are the same beams.
TEST(EdgeRuns, HaveTheRequestedFrequencies) {
  const SteppedWall wall;
  EdgeRunRules rules;
  rules.on = true;
  rules.shares[0] = 0.4;
  std::size_t lost = 0, edges = 0;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    edges += i + 1 < 4000 && is_edge(wall.firings.data(), wall.all(), i) ? 1 : 0;
    const bool here = lost_at_edge(rules, wall.firings.data(), wall.all(), 1, 2, i);
    lost += here ? 1 : 0;
    const std::uint32_t of_five = i % 5;
    EXPECT_TRUE(!here || of_five == 0 || of_five == 4) << i;
    EXPECT_EQ(here, lost_at_edge(rules, wall.firings.data(), wall.all(), 1, 2, i % 1000)) << i;
  }
  EXPECT_EQ(edges, 4U * 199);
  EXPECT_NEAR(static_cast<double>(lost) / static_cast<double>(edges), 0.4, 0.1);
}

// Oracle: none may depend on which hits beside the needed ones are there.
TEST(EdgeRuns, NeedOnlyTheNeighbouringHits) {
  const SteppedWall wall;
  EdgeRunRules rules;
  rules.on = true;
  rules.shares[0] = 0.3;
  rules.shares[5] = 0.3;
  for (std::uint32_t i = 100; i < 500; ++i) {
    const ScanHits few = {wall.hits.data() + i - kMaxEdgeRun, 1, i - kMaxEdgeRun,
                          i + kMaxEdgeRun + 1};
    EXPECT_EQ(lost_at_edge(rules, wall.firings.data(), few, 1, 2, i),
              lost_at_edge(rules, wall.firings.data(), wall.all(), 1, 2, i));
  }
}

}  // namespace
}  // namespace adasplats
