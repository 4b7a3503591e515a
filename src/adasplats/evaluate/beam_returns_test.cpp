// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/beam_returns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/constants.h"
#include "adasplats/evaluate/beam_accuracy_internal.h"

namespace adasplats {
namespace {

EmptyBeamHits empty_beams(std::size_t beams, double ghosts) { return {beams, ghosts, 40.0}; }

// Oracle: counted by hand. Of 8 beams that returned 2 hit nothing, of 5 that did not 1 hits.
TEST(BeamReturns, GhostsAndHolesBecomePrecisionAndRecall) {
  const BeamAccuracy returned = accuracy_of({0, 1, -1, 0, 0, 30, kNoHitError, kNoHitError});
  const BeamReturns returns = beam_returns(returned, empty_beams(5, 1.0 / 5));
  EXPECT_EQ(returns.returned, 8U);
  EXPECT_EQ(returns.empty, 5U);
  EXPECT_DOUBLE_EQ(returns.holes, 2.0 / 8);
  EXPECT_DOUBLE_EQ(returns.ghosts, 1.0 / 5);
  EXPECT_DOUBLE_EQ(returns.precision, 6.0 / 7);
  EXPECT_DOUBLE_EQ(returns.recall, 6.0 / 8);
  const double harmonic = 2 / (7.0 / 6 + 8.0 / 6);
  EXPECT_DOUBLE_EQ(returns.f1, harmonic);
}

TEST(BeamReturns, WithoutEmptyBeamsOnlyHolesAreDefined) {
  const BeamReturns returns =
      beam_returns(accuracy_of({0, 0, 0, kNoHitError}), empty_beams(0, kNaN));
  EXPECT_DOUBLE_EQ(returns.holes, 1.0 / 4);
  EXPECT_TRUE(std::isnan(returns.ghosts));
  EXPECT_TRUE(std::isnan(returns.precision));
  EXPECT_TRUE(std::isnan(returns.recall));
  EXPECT_TRUE(std::isnan(returns.f1));
}

TEST(BeamReturns, NoBeamsAndNoCorrectPrediction) {
  const BeamReturns none = beam_returns(accuracy_of({}), empty_beams(0, kNaN));
  EXPECT_EQ(none.returned, 0U);
  EXPECT_TRUE(std::isnan(none.holes));
  const BeamReturns wrong = beam_returns(accuracy_of({kNoHitError}), empty_beams(3, 1.0));
  EXPECT_DOUBLE_EQ(wrong.precision, 0.0);
  EXPECT_DOUBLE_EQ(wrong.recall, 0.0);
  EXPECT_DOUBLE_EQ(wrong.f1, 0.0);
  const BeamReturns unseen = beam_returns(accuracy_of({kNoHitError}), empty_beams(3, 0.0));
  EXPECT_TRUE(std::isnan(unseen.precision));  // no return was predicted
  EXPECT_DOUBLE_EQ(unseen.f1, 0.0);
}

}  // namespace
}  // namespace adasplats
