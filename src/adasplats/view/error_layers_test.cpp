// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/error_layers.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "adasplats/core/constants.h"

namespace adasplats {
namespace {

PointCloud line(std::size_t count) {
  PointCloud cloud;
  cloud.origin = {1000, 0, 0};
  for (std::size_t i = 0; i < count; ++i) cloud.positions.push_back({static_cast<float>(i), 0, 0});
  return cloud;
}

// Oracle: by hand.
TEST(ErrorLayers, PointsAreInThePartOfTheirError) {
  const std::vector<float> errors_m = {0.05F, -0.05F, -0.2F, 0.3F, 0.4F, -2, kNaN, kNaN, kNaN};
  const std::vector<ViewLayer> layers =
      error_part_layers(line(errors_m.size()), errors_m, {}, {}, Executor(1));
  ASSERT_EQ(layers.size(), 4U);
  const std::vector<std::pair<std::string, std::size_t>> expected = {
      {"early", 1}, {"late", 2}, {"ghosts", 1}, {"holes", 3}};
  for (std::size_t k = 0; k < layers.size(); ++k) {
    EXPECT_EQ(layers[k].part, expected[k].first);
    EXPECT_EQ(layers[k].tree.input_size(), expected[k].second) << layers[k].part;
  }
  EXPECT_NEAR(layers[0].tree.nodes().front().low.x, 1002, 1e-3F);
  EXPECT_EQ(layers[3].tree.elements(0)[0].error, 0) << "unknown";
}

TEST(ErrorLayers, DistancesHaveNoParts) {
  const std::vector<float> distances_m = {0.05F, 0.7F, kNaN};
  EXPECT_TRUE(error_part_layers(line(3), distances_m, {}, {}, Executor(1)).empty());
}

}  // namespace
}  // namespace adasplats
