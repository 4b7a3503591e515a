// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/segment_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/segment/network/matrix_product.h"
#include "adasplats/segment/network/run_network.h"

namespace adasplats {
namespace {

using nlohmann::json;

/// Numbers of 16 bits that small networks need.
std::uint16_t half_of(float value) {
  const float size = std::fabs(value);
  if (size == 0) return 0;
  const int exponent = std::ilogb(size);
  const auto fraction = static_cast<int>(std::ldexp(size, 10 - exponent)) & 0x3ff;
  return static_cast<std::uint16_t>((value < 0 ? 0x8000 : 0) | (exponent + 15) << 10 | fraction);
}

/// A network file, layer by layer.
struct NetworkText {
  json header = {{"version", 1},
                 {"shape",
                  {{"cell_m", 0.5},
                   {"levels", 2},
                   {"radius", 2.5},
                   {"neighbors", 32},
                   {"sigma", 1.2},
                   {"height_unit_m", 1.0}}},
                 {"kernel", {{0, 0, 0}, {1, 0, 0}}},
                 {"features", {"one", "height"}},
                 {"classes", {"road", "pole"}},
                 {"values", 2},
                 {"weights", json::array()},
                 {"layers", json::array()}};
  std::string data;

  std::size_t weights(std::size_t rows, const std::vector<float>& values) {
    header["weights"].push_back({{"shape", {rows, values.size() / rows}}, {"offset", data.size()}});
    for (const float value : values) {
      const std::uint16_t half = half_of(value);
      data.append(reinterpret_cast<const char*>(&half), 2);
    }
    return header["weights"].size() - 1;
  }

  std::string text() const {
    const std::string head = header.dump();
    const std::uint64_t length = head.size();
    std::string text = "adasplats-network\n";
    text.append(reinterpret_cast<const char*>(&length), 8);
    return text + head + data;
  }
};

/// What is higher than a metre is a pole.
NetworkText pole_network() {
  NetworkText network;
  const std::size_t weight = network.weights(2, {1, 0, 0, 1}), bias = network.weights(1, {0, 0});
  network.header["layers"] = {{{"kind", "unary"},
                               {"level", 0},
                               {"input", 0},
                               {"output", 1},
                               {"weight", weight},
                               {"bias", bias}}};
  return network;
}

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

bool has_products() {
  try {
    require_products();
    return true;
  } catch (const Error&) {
    return false;
  }
}

TEST(Network, IsReadAndRefusedWhereItIsWrong) {
  const Network network = parse_network(pole_network().text(), "n");
  EXPECT_EQ(network.classes, (std::vector<std::string>{"road", "pole"}));
  EXPECT_EQ(network.weights[0].values, (std::vector<float>{1, 0, 0, 1}));

  const auto refused = [](const std::string& text, const std::string& why) {
    expect_error(ErrorKind::data, {"n: ", why}, [&] { parse_network(text, "n"); });
  };
  refused("", "is no network");
  refused("adasplats-network\n\1\0\0\0", "is no network");
  refused(pole_network().text().substr(0, 60), "cut off");
  NetworkText wrong = pole_network();
  wrong.header["version"] = 2;
  refused(wrong.text(), "version 2, expected 1");
  wrong = pole_network();
  refused(wrong.text().substr(0, wrong.text().size() - 2), "beyond its end");
  wrong.data[1] = 0x7c;  // infinity
  refused(wrong.text(), "not finite");
  for (const auto& [key, value, why] :
       {std::tuple<std::string, json, std::string>{"input", 7, "input 7 does not exist"},
        {"weight", 1, "do not fit"},
        {"level", 1, "do not fit"},
        {"level", 5, "level 5 does not exist"},
        {"kind", "dense", "'dense' is not known"}}) {
    wrong = pole_network();
    wrong.header["layers"][0][key] = value;
    refused(wrong.text(), why);
  }
  wrong = pole_network();
  wrong.header.erase("classes");
  refused(wrong.text(), "damaged");
}

TEST(Network, TheDefaultOneIsSound) {
  const Network network = default_network();
  EXPECT_EQ(network.classes.size(), 19U);
  EXPECT_FALSE(network.card.empty());
}

TEST(Network, ConvolutionsAreThoseOfTheirDefinition) {
  if (!has_products()) GTEST_SKIP() << "built without OpenBLAS";
  NetworkText text;
  text.header["features"] = {"one"};
  const std::size_t weight = text.weights(2, {1, 2, 4, 8}), bias = text.weights(1, {0.5, -20});
  text.header["layers"] = {{{"kind", "convolution"},
                            {"level", 0},
                            {"input", 0},
                            {"output", 1},
                            {"weight", weight},
                            {"bias", bias},
                            {"slope", 0.5}}};
  const Network network = parse_network(text.text(), "n");
  const Executor executor(2);
  const std::vector<PyramidLevel> levels =
      make_pyramid({{0, 0, 0}, {0.5F, 0, 0}, {9, 9, 9}}, network.shape, executor);
  const std::vector<float> logits = run_network(network, levels, {1, 10, 100}, executor);
  // Kernel points in the middle and 0.5 m along x, each as far as 0.6 m.
  const double near = 1 - 0.5 / 0.6;
  const double middle = 1 + 10 * near, along = near + 10;
  EXPECT_NEAR(logits[0], middle + 4 * along + 0.5, 1e-4);
  EXPECT_NEAR(logits[1], 2 * middle + 8 * along - 20, 1e-4);
  EXPECT_NEAR(logits[4], 100 + 4 * 100 * near + 0.5, 1e-3);
}

TEST(SegmentCloud, SeesWhatIsHigh) {
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

TEST(SegmentCloud, TakesAnyCloud) {
  if (!has_products()) GTEST_SKIP() << "built without OpenBLAS";
  const Network network = default_network();
  const Executor executor(1);
  EXPECT_TRUE(segment_cloud({}, network, {}, executor).classes.empty());
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  EXPECT_EQ(segment_cloud(cloud, network, {}, executor).classes.size(), 1U);
  cloud.intensities = {std::numeric_limits<float>::quiet_NaN()};
  EXPECT_LT(segment_cloud(cloud, network, {}, executor).classes[0], 19);
  PointCloud plane = ground_and_pole();
  for (Vec3f& p : plane.positions) p.z = 0;
  EXPECT_EQ(segment_cloud(plane, network, {}, executor).classes.size(), plane.size());
}

}  // namespace
}  // namespace adasplats
