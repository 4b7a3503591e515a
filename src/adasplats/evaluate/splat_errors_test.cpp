// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/evaluate/error_points.h"

namespace adasplats {
namespace {

ErrorPoints beams(std::vector<float> errors_m, std::vector<std::uint32_t> splats,
                  std::size_t count) {
  ErrorPoints points;
  points.errors_m = std::move(errors_m);
  points.primitives = std::move(splats);
  points.primitive_count = count;
  return points;
}

// Analytic: means of errors of at most half a metre; splats without a beam have none.
TEST(SplatErrors, AreTheMeansOfTheBeamsThatHitThem) {
  SplatErrors errors(3);
  errors.add(beams({0.1F, 0.3F, -9, kNaN}, {0, 0, 2, Hit::kNone}, 3), "e.ply");
  const std::vector<float> means_m = errors.means_m();
  ASSERT_EQ(means_m.size(), 3U);
  EXPECT_NEAR(means_m[0], 0.2, 1e-6);
  EXPECT_TRUE(std::isnan(means_m[1]));
  EXPECT_NEAR(means_m[2], -0.5, 1e-6);
}

// Analytic: the mean is over the beams of all files, not over the files.
TEST(SplatErrors, FilesAddUp) {
  SplatErrors errors(1);
  errors.add(beams({0.1F, 0.1F, 0.1F}, {0, 0, 0}, 1), "a.ply");
  errors.add(beams({0.5F}, {0}, 1), "b.ply");
  EXPECT_NEAR(errors.means_m()[0], 0.2, 1e-6);
  EXPECT_TRUE(SplatErrors(0).means_m().empty());
}

TEST(SplatErrors, RejectBeamsOfOtherModels) {
  SplatErrors errors(4);
  expect_error(ErrorKind::data, {"e.ply", "another model", "3 splats", "4"},
               [&] { errors.add(beams({0.1F}, {0}, 3), "e.ply"); });
  expect_error(ErrorKind::data, {"e.ply", "splat 4 of 4"}, [&] {
    errors.add(beams({0.1F, 0.2F}, {0, 4}, 4), "e.ply");
  });
  expect_error(ErrorKind::data, {"e.ply", "adasplats.model_splats"},
               [&] { errors.add(beams({0.1F}, {0}, 0), "e.ply"); });
  const ErrorPoints old = beams({0.1F}, {}, 0);
  EXPECT_FALSE(has_splat_hits(old));
  expect_error(ErrorKind::data, {"e.ply", "'splat'"}, [&] { errors.add(old, "e.ply"); });
  for (const float mean_m : errors.means_m()) EXPECT_TRUE(std::isnan(mean_m)) << "nothing counts";
}

}  // namespace
}  // namespace adasplats
