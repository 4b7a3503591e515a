// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/network/network.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/segment/network/network_text_test.h"
#include "adasplats/segment/network/run_network.h"

namespace adasplats {
namespace {

using network_test::has_products;
using network_test::NetworkText;
using network_test::pole_network;
using network_test::pole_network_of_8_bits;
using nlohmann::json;

TEST(Network, ReadsFilesAndRejectsInvalidOnes) {
  const Network network = parse_network(pole_network().text(), "n");
  EXPECT_EQ(network.classes, (std::vector<std::string>{"road", "pole"}));
  Sha256 hash;
  hash.add(pole_network().text());
  EXPECT_EQ(network.sha256, hash.digest());
  EXPECT_EQ(network.weights[0].values, (std::vector<float>{1, 0, 0, 1}));

  const auto rejected = [](const std::string& text, const std::string& why) {
    expect_error(ErrorKind::data, {"n: ", why}, [&] { parse_network(text, "n"); });
  };
  rejected("", "not a network");
  rejected("adasplats-network\n\1\0\0\0", "not a network");
  rejected(pole_network().text().substr(0, 60), "truncated");
  NetworkText wrong = pole_network();
  wrong.header["version"] = 2;
  rejected(wrong.text(), "version 2, expected 1");
  wrong = pole_network();
  rejected(wrong.text().substr(0, wrong.text().size() - 2), "beyond the end");
  wrong.data[1] = 0x7c;  // infinity
  rejected(wrong.text(), "not finite");
  for (const auto& [key, value, why] :
       {std::tuple<std::string, json, std::string>{"input", 7, "input 7 does not exist"},
        {"weight", 1, "do not match"},
        {"level", 1, "do not match"},
        {"level", 5, "level 5 does not exist"},
        {"kind", "dense", "'dense' is unknown"}}) {
    wrong = pole_network();
    wrong.header["layers"][0][key] = value;
    rejected(wrong.text(), why);
  }
  wrong = pole_network();
  wrong.header.erase("classes");
  rejected(wrong.text(), "damaged");
  wrong = pole_network();
  wrong.header["layers"][0]["slope"] = 1e300;
  rejected(wrong.text(), "slope is not finite");
  wrong = pole_network();
  wrong.header["weights"][0]["shape"] = {std::uint64_t{1} << 32, std::uint64_t{1} << 32};
  rejected(wrong.text(), "beyond the end");
}

TEST(Network, ReadsWeightsOf8BitsAndRejectsInvalidOnes) {
  EXPECT_EQ(parse_network(pole_network_of_8_bits().text(), "n").weights[0].values,
            (std::vector<float>{1, 0, 0, 1}));
  NetworkText wrong = pole_network_of_8_bits();
  const std::string text = wrong.text();
  expect_error(ErrorKind::data, {"n: ", "beyond the end"},
               [&] { parse_network(text.substr(0, text.size() - 1), "n"); });
  wrong.header["weights"][0]["bits"] = 4;
  expect_error(ErrorKind::data, {"n: ", "of 4 bits"}, [&] { parse_network(wrong.text(), "n"); });
  wrong = pole_network_of_8_bits();
  wrong.data[wrong.data.size() - 9] = '\xff';  // a step that is no number
  wrong.data[wrong.data.size() - 10] = '\xff';
  expect_error(ErrorKind::data, {"n: ", "not finite"}, [&] { parse_network(wrong.text(), "n"); });
}

TEST(Network, RejectsShapesOutOfRange) {
  const auto rejected = [](const char* key, const json& value, const std::string& why) {
    NetworkText wrong = pole_network();
    (wrong.header["shape"].contains(key) ? wrong.header["shape"] : wrong.header)[key] = value;
    expect_error(ErrorKind::data, {"n: ", why}, [&] { parse_network(wrong.text(), "n"); });
  };
  for (const char* const key : {"cell_m", "radius", "height_unit_m"})
    for (const json& value : {json(0), json(-1), json(1e9), json(1e-9)})
      rejected(key, value, "out of range");
  for (const json& value : {json(0), json(-1), json(9)}) rejected("levels", value, "out of range");
  rejected("neighbors", 0, "out of range");
  rejected("neighbors", 100'000, "out of range");
  rejected("kernel", json::array(), "out of range");
  rejected("kernel", {{0, 0, 1e300}}, "out of range");
  rejected("features", json::array(), "out of range");
  rejected("layers", json::array(), "no layers");
  rejected("classes", {"road", "road"}, "'road' occurs twice");
  rejected("classes", {"road", "pole", "tree"}, "do not match");
  rejected("classes", "road", "damaged");
  rejected("values", 1, "out of range");
}

/// A value that every layer makes twice as wide.
TEST(Network, WidthsAreBounded) {
  NetworkText wide = pole_network();
  json layers = json::array();
  for (std::size_t k = 0; k < 70; ++k)
    layers.push_back(
        {{"kind", "join"}, {"level", 0}, {"input", k}, {"second", k}, {"output", k + 1}});
  wide.header["layers"] = layers;
  wide.header["values"] = 71;
  expect_error(ErrorKind::data, {"do not match"}, [&] { parse_network(wide.text(), "n"); });
}

TEST(Network, DefaultNetworkIsValid) {
  const Network network = default_network();
  EXPECT_EQ(network.classes.size(), 19U);
  EXPECT_FALSE(network.card.empty());
}

TEST(Network, ConvolutionsMatchTheirDefinition) {
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

}  // namespace
}  // namespace adasplats
