// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/point_colors.h"

#include <gtest/gtest.h>

#include <limits>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

// An attribute with one value shows nothing: the next one is chosen.
TEST(DefaultColor, SkipsAttributesWithOneValue) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  const LabelScheme* const labels = &asprs_labels();
  EXPECT_EQ(default_color(cloud, labels), ImageColor::height);
  cloud.intensities = {0, 0, std::numeric_limits<float>::quiet_NaN()};
  cloud.classes = {1, 1, 1};
  EXPECT_EQ(default_color(cloud, labels), ImageColor::height);
  cloud.intensities = {0, 1, 0};
  EXPECT_EQ(default_color(cloud, labels), ImageColor::intensity);
  cloud.classes = {1, 2, 1};
  EXPECT_EQ(default_color(cloud, labels), ImageColor::semantic);
  EXPECT_EQ(default_color(cloud, nullptr), ImageColor::intensity);
}

TEST(DefaultColor, ColoursOfTheFileComeFirst) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {1, 1, 1}};
  cloud.intensities = {0, 1};
  EXPECT_THROW(point_colors(cloud, nullptr, ImageColor::rgb, {}), Error);
  const std::vector<std::uint16_t> red = {256, 65280};
  cloud.others.columns = {{"red", red}, {"green", red}, {"blue", red}};
  EXPECT_EQ(default_color(cloud, nullptr), ImageColor::rgb);
  EXPECT_EQ(point_colors(cloud, nullptr, std::nullopt, {}),
            (std::vector<Rgb>{{1, 1, 1}, {255, 255, 255}}));
  for (Column& column : cloud.others.columns) column.values = std::vector<std::uint16_t>{0, 0};
  EXPECT_EQ(default_color(cloud, nullptr), ImageColor::intensity);
}

}  // namespace
}  // namespace adasplats
