// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/segment_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/segment/network/network_text_test.h"

namespace adasplats {
namespace {

using network_test::has_products;
using network_test::NetworkText;
using network_test::pole_network;

/// Ground of 30 m by 30 m, and a pole of 3 m on it.
PointCloud ground_and_pole() {
  PointCloud cloud;
  Random random(1, 0, 0);
  for (int i = 0; i < 20'000; ++i)
    cloud.positions.push_back({static_cast<float>(random.uniform(-15, 15)),
                               static_cast<float>(random.uniform(-15, 15)),
                               static_cast<float>(random.uniform(0, 0.05))});
  for (int i = 0; i < 300; ++i)
    cloud.positions.push_back({0.1F, 0.1F, 0.01F * static_cast<float>(i)});
  return cloud;
}

TEST(SegmentCloud, ClassifiesByHeight) {
  if (!has_products()) GTEST_SKIP() << "built without OpenBLAS";
  const Network network = parse_network(pole_network().text(), "n");
  const PointCloud cloud = ground_and_pole();
  SegmentOptions options;
  options.confidences = true;
  const Segmentation whole = segment_cloud(cloud, network, options, Executor(1));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float height_m = cloud.positions[i].z;
    const bool is_clear = std::fabs(height_m - 1) > 0.5F;
    if (is_clear) {
      EXPECT_EQ(whole.classes[i], height_m > 1 ? 1 : 0);
    }
    EXPECT_GE(whole.confidences[i], 0.5F);
    EXPECT_LE(whole.confidences[i], 1.0F);
  }
  EXPECT_EQ(segment_cloud(cloud, network, options, Executor(2)).classes, whole.classes);
  options.tile_m = 7;
  const Segmentation tiled = segment_cloud(cloud, network, options, Executor(2));
  EXPECT_GT(tiled.tiles, whole.tiles);
  EXPECT_EQ(tiled.classes, whole.classes);
}

TEST(SegmentCloud, ReturnsProbabilitiesOfAllClasses) {
  if (!has_products()) GTEST_SKIP() << "built without OpenBLAS";
  const Network network = parse_network(pole_network().text(), "n");
  const PointCloud cloud = ground_and_pole();
  SegmentOptions options;
  options.confidences = true;
  options.probabilities = true;
  const Segmentation found = segment_cloud(cloud, network, options, Executor(2));
  ASSERT_EQ(found.probabilities.size(), 2 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float road = found.probabilities[2 * i], pole = found.probabilities[2 * i + 1];
    EXPECT_NEAR(road + pole, 1, 1e-6);
    EXPECT_EQ(found.confidences[i], std::max(road, pole));
    EXPECT_EQ(found.classes[i], pole > road ? 1 : 0);
  }
}

TEST(SegmentCloud, ContextHelpsAndGetsNoClasses) {
  if (!has_products()) GTEST_SKIP() << "built without OpenBLAS";
  const Network network = parse_network(pole_network().text(), "n");
  PointCloud cloud = ground_and_pole();
  // The pole first: without the ground around it, its foot would be the ground.
  std::ranges::reverse(cloud.positions);
  for (std::size_t i = 0; i < 300; ++i) cloud.positions[i].z += 5;
  SegmentOptions options;
  options.wanted = 300;
  options.confidences = true;
  options.probabilities = true;
  const Segmentation found = segment_cloud(cloud, network, options, Executor(1));
  EXPECT_EQ(found.classes, std::vector<std::uint8_t>(300, 1));
  EXPECT_EQ(found.confidences.size(), 300U);
  EXPECT_EQ(found.probabilities.size(), 600U);
  options.tile_m = 4;
  const std::size_t tiles = segment_cloud(cloud, network, options, Executor(1)).tiles;
  options.wanted = cloud.size();
  EXPECT_LT(tiles, segment_cloud(cloud, network, options, Executor(1)).tiles);
}

/// Half precision holds 65504: three layers of it are beyond floats.
TEST(SegmentCloud, OverflowingLogitsGiveValidLabels) {
  if (!has_products()) GTEST_SKIP() << "built without OpenBLAS";
  NetworkText text;
  const std::size_t weight = text.weights(2, {65504, 65504, 65504, 65504}),
                    bias = text.weights(1, {0, 0});
  for (std::size_t k = 0; k < 9; ++k)
    text.header["layers"].push_back({{"kind", "unary"},
                                     {"level", 0},
                                     {"input", k},
                                     {"output", k + 1},
                                     {"weight", weight},
                                     {"bias", bias}});
  text.header["values"] = 10;
  SegmentOptions options;
  options.confidences = true;
  options.probabilities = true;
  const Segmentation found =
      segment_cloud(ground_and_pole(), parse_network(text.text(), "n"), options, Executor(1));
  for (const std::uint8_t c : found.classes) EXPECT_LT(c, 2);
  for (const float value : found.confidences) EXPECT_EQ(value, 0);
  for (const float value : found.probabilities) EXPECT_EQ(value, 0);
}

TEST(SegmentCloud, RejectsPositionsOutOfRange) {
  const Network network = parse_network(pole_network().text(), "n");
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 1e6F}) {
    PointCloud cloud;
    cloud.positions = {{0, 0, 0}, {0, 0, bad}};
    expect_error(ErrorKind::data, {"point 1 "},
                 [&] { segment_cloud(cloud, network, {}, Executor(1)); });
  }
}

TEST(SegmentCloud, AcceptsAnyCloud) {
  if (!has_products()) GTEST_SKIP() << "built without OpenBLAS";
  const Network network = default_network();
  const Executor executor(1);
  EXPECT_TRUE(segment_cloud({}, network, {}, executor).classes.empty());
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  EXPECT_EQ(segment_cloud(cloud, network, {}, executor).classes.size(), 1U);
  cloud.intensities = {std::numeric_limits<float>::quiet_NaN()};
  EXPECT_LT(segment_cloud(cloud, network, {}, executor).classes[0], 19);
  cloud.positions.assign(1000, {7, 7, 7});  // all equal
  cloud.intensities.clear();
  const std::vector<std::uint8_t> classes = segment_cloud(cloud, network, {}, executor).classes;
  EXPECT_EQ(classes, std::vector<std::uint8_t>(1000, classes[0]));
  PointCloud plane = ground_and_pole();
  for (Vec3f& p : plane.positions) p.z = 0;
  EXPECT_EQ(segment_cloud(plane, network, {}, executor).classes.size(), plane.size());
}

}  // namespace
}  // namespace adasplats
