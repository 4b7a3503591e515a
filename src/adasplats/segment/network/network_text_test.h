// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/segment/network/run_network.h"

// Small network files for tests.
namespace adasplats::network_test {

using nlohmann::json;

/// Converts a float to IEEE 754 binary16, for values that small networks need.
inline std::uint16_t half_of(float value) {
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

  std::string text() const { return text_of(header.dump(), data); }

  /// A file with the given header, which may be invalid.
  static std::string text_of(const std::string& head, const std::string& data) {
    const std::uint64_t length = head.size();
    std::string text = "adasplats-network\n";
    text.append(reinterpret_cast<const char*>(&length), sizeof(length));
    return text + head + data;
  }
};

/// Classifies points above one metre as pole.
inline NetworkText pole_network() {
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

/// The same with its matrix in 8 bits: steps of the columns, then how many of these.
inline NetworkText pole_network_of_8_bits() {
  NetworkText network = pole_network();
  network.header["weights"][0] = {{"shape", {2, 2}}, {"offset", network.data.size()}, {"bits", 8}};
  const float steps[] = {0.5F, 0.125F};
  network.data.append(reinterpret_cast<const char*>(steps), sizeof(steps));
  network.data.append({2, 0, 0, 8});
  return network;
}

/// Every kind of layer, on two levels.
inline NetworkText network_of_all_layers() {
  NetworkText network;
  const std::size_t first = network.weights(4, {1, 0, 0, 1, 0.5, 0, 0, 0.5}),
                    strided = network.weights(4, {1, 0, 0, 1, 0.5, 0, 0, 0.5}),
                    last = network.weights(4, {1, 0, 0, 1, 1, 0, 0, 1}),
                    bias = network.weights(1, {0, 0.25});
  const auto layer = [&](const char* kind, int level, int input, int output, json more) {
    more.update({{"kind", kind}, {"level", level}, {"input", input}, {"output", output}});
    network.header["layers"].push_back(more);
  };
  layer("convolution", 0, 0, 1, {{"weight", first}, {"bias", bias}, {"slope", 0.1}});
  layer("convolution", 1, 1, 2, {{"weight", strided}, {"bias", bias}, {"strided", true}});
  layer("largest", 1, 1, 3, json::object());
  layer("add", 1, 2, 4, {{"second", 3}, {"slope", 0.1}});
  layer("upsample", 0, 4, 5, json::object());
  layer("join", 0, 5, 6, {{"second", 1}});
  layer("unary", 0, 6, 7, {{"weight", last}, {"bias", bias}});
  network.header["values"] = 8;
  return network;
}

inline bool has_products() {
  try {
    require_products();
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace adasplats::network_test
