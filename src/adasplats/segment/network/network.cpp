// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/network/network.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"

namespace adasplats {
namespace {

using nlohmann::json;

constexpr std::string_view kMagic = "adasplats-network\n";
constexpr int kVersion = 1;
constexpr std::uint64_t kMaxRows = std::uint64_t{1} << 31;  // products of two fit 64 bits
constexpr std::size_t kMaxWidth = 65536;

/// Converts IEEE 754 binary16 to float.
float from_half(std::uint16_t half) {
  const std::uint32_t sign = std::uint32_t{half & 0x8000U} << 16;
  const std::uint32_t exponent = half >> 10 & 0x1fU, fraction = half & 0x3ffU;
  if (exponent == 0) {
    const float tiny = std::ldexp(static_cast<float>(fraction), -24);
    return sign != 0 ? -tiny : tiny;
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + 112;
  return std::bit_cast<float>(sign | wide << 23 | fraction << 13);
}

const std::vector<std::string_view> kKinds = {"convolution", "unary",    "largest",
                                              "add",         "upsample", "join"};
const std::vector<std::string_view> kFeatures = {"one", "height", "intensity", "has_intensity"};

template <class T>
T word_in(const std::vector<std::string_view>& words, const std::string& word) {
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) throw std::runtime_error("'" + word + "' is unknown");
  return static_cast<T>(found - words.begin());
}

std::size_t index_below(const json& object, const char* key, std::size_t count) {
  const auto index = object.at(key).get<std::size_t>();
  if (index >= count)
    throw std::runtime_error(std::string(key) + " " + std::to_string(index) + " does not exist");
  return index;
}

Layer layer_of(const json& object, const Network& network) {
  Layer layer;
  layer.kind = word_in<LayerKind>(kKinds, object.at("kind").get<std::string>());
  layer.level = object.at("level").get<int>();
  if (layer.level < 0 || layer.level >= network.shape.levels)
    throw std::runtime_error("level " + std::to_string(layer.level) + " does not exist");
  layer.strided = object.value("strided", false);
  layer.input = index_below(object, "input", network.values);
  layer.output = index_below(object, "output", network.values);
  if (layer.kind == LayerKind::add || layer.kind == LayerKind::join)
    layer.second = index_below(object, "second", network.values);
  if (layer.kind == LayerKind::convolution || layer.kind == LayerKind::unary) {
    layer.weight = index_below(object, "weight", network.weights.size());
    layer.bias = index_below(object, "bias", network.weights.size());
  }
  layer.slope = object.value("slope", 1.0F);
  if (!std::isfinite(layer.slope)) throw std::runtime_error("a slope is not finite");
  return layer;
}

template <class T>
T number_at(std::string_view data, std::size_t offset) {
  T number{};
  std::memcpy(&number, data.data() + offset, sizeof(T));
  return number;
}

/// Reads weights of 16 bits.
void read_halves(Weights& weights, std::string_view data) {
  for (std::size_t i = 0; i < weights.values.size(); ++i)
    weights.values[i] = from_half(number_at<std::uint16_t>(data, 2 * i));
}

/// Reads weights of 8 bits: the step of each column (float), then the multiples of it (signed).
void read_steps(Weights& weights, std::string_view data) {
  const std::string_view counts = data.substr(4 * weights.columns);
  for (std::size_t i = 0; i < weights.values.size(); ++i)
    weights.values[i] = number_at<float>(data, 4 * (i % weights.columns)) *
                        static_cast<float>(number_at<std::int8_t>(counts, i));
}

Weights weights_of(const json& object, std::string_view data) {
  Weights weights;
  weights.rows = object.at("shape").at(0).get<std::size_t>();
  weights.columns = object.at("shape").at(1).get<std::size_t>();
  const auto offset = object.at("offset").get<std::size_t>();
  const int bits = object.value("bits", 16);
  if (bits != 16 && bits != 8)
    throw std::runtime_error("weights of " + std::to_string(bits) + " bits are not supported");
  const std::size_t count = weights.rows * weights.columns;
  const std::size_t bytes = bits == 16 ? 2 * count : count + 4 * weights.columns;
  if (weights.rows > kMaxRows || weights.columns > kMaxRows || offset > data.size() ||
      bytes > data.size() - offset)
    throw std::runtime_error("weights are beyond the end of the file");
  weights.values.resize(count);
  (bits == 16 ? read_halves : read_steps)(weights, data.substr(offset));
  for (const float value : weights.values)
    if (!std::isfinite(value)) throw std::runtime_error("a weight is not finite");
  return weights;
}

void require_shape(const Network& network) {
  const PyramidShape& shape = network.shape;
  const auto within = [](auto value, auto min, auto max) {
    return value >= min && value <= max;  // false for NaN
  };
  const bool fits =
      within(shape.cell_m, 0.01F, 100.0F) && within(shape.radius, 0.5F, 8.0F) &&
      within(network.sigma, 0.01F, 100.0F) && within(network.height_unit_m, 0.01F, 1000.0F) &&
      within(shape.levels, 1, 8) && within(shape.neighbors, 1U, 256U) &&
      within(network.kernel.size(), std::size_t{1}, std::size_t{64}) &&
      within(network.classes.size(), std::size_t{1}, std::size_t{255}) &&
      within(network.values, std::size_t{2}, std::size_t{100'000}) && !network.features.empty();
  const bool is_finite_kernel =
      std::ranges::all_of(network.kernel, [](Vec3f p) { return is_finite(p); });
  if (!fits || !is_finite_kernel) throw std::runtime_error("a value of the shape is out of range");
  std::vector<std::string> names = network.classes;
  std::ranges::sort(names);
  if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
    throw std::runtime_error("class '" + *twice + "' occurs twice");
}

/// Tracks widths and levels of the values, layer by layer.
class LayerCheck {
 public:
  explicit LayerCheck(const Network& network)
      : network_(network), widths_(network.values, 0), levels_(network.values, -1) {
    widths_[0] = network.features.size();
    levels_[0] = 0;
  }

  void check(const Layer& layer) {
    const std::size_t width = width_of(layer.input);
    const int from = level_below(layer);
    require(levels_[layer.input] == from);
    std::size_t result = width;
    if (layer.kind == LayerKind::convolution) {
      result = weighted(layer, width * network_.kernel.size());
    } else if (layer.kind == LayerKind::unary) {
      result = weighted(layer, width);
    } else if (layer.kind == LayerKind::add || layer.kind == LayerKind::join) {
      const std::size_t second = width_of(layer.second);
      require(levels_[layer.second] == layer.level);
      if (layer.kind == LayerKind::add) require(second == width);
      if (layer.kind == LayerKind::join) result = width + second;
    }
    require(result <= kMaxWidth);
    widths_[layer.output] = result;
    levels_[layer.output] = layer.level;
  }

  void check_logits(const Layer& last) const {
    require(last.level == 0 && widths_[last.output] == network_.classes.size());
  }

 private:
  static void require(bool fits) {
    if (!fits) throw std::runtime_error("the layers do not match");
  }
  std::size_t width_of(std::size_t value) const {
    require(widths_[value] > 0);
    return widths_[value];
  }
  int level_below(const Layer& layer) const {
    const bool strided = layer.strided || layer.kind == LayerKind::largest;
    int from = layer.level;
    if (layer.kind == LayerKind::upsample) ++from;
    if (strided) --from;
    require(from >= 0 && from < network_.shape.levels);
    return from;
  }
  std::size_t weighted(const Layer& layer, std::size_t rows) const {
    const Weights& weight = network_.weights[layer.weight];
    const Weights& bias = network_.weights[layer.bias];
    require(weight.rows == rows && weight.columns > 0 && bias.rows == 1 &&
            bias.columns == weight.columns);
    return weight.columns;
  }

  const Network& network_;
  std::vector<std::size_t> widths_;
  std::vector<int> levels_;
};

Network network_of(const json& header, std::string_view data) {
  Network network;
  const json& shape = header.at("shape");
  network.shape.cell_m = shape.at("cell_m").get<float>();
  network.shape.levels = shape.at("levels").get<int>();
  network.shape.radius = shape.at("radius").get<float>();
  network.shape.neighbors = shape.at("neighbors").get<std::uint32_t>();
  network.sigma = shape.at("sigma").get<float>();
  network.height_unit_m = shape.at("height_unit_m").get<float>();
  for (const json& point : header.at("kernel"))
    network.kernel.push_back(
        {point.at(0).get<float>(), point.at(1).get<float>(), point.at(2).get<float>()});
  for (const json& name : header.at("features"))
    network.features.push_back(word_in<PointFeature>(kFeatures, name.get<std::string>()));
  network.classes = header.at("classes").get<std::vector<std::string>>();
  network.card = header.value("card", std::string());
  network.values = header.at("values").get<std::size_t>();
  require_shape(network);
  for (const json& weights : header.at("weights"))
    network.weights.push_back(weights_of(weights, data));
  for (const json& layer : header.at("layers")) network.layers.push_back(layer_of(layer, network));
  if (network.layers.empty()) throw std::runtime_error("the network has no layers");
  LayerCheck check(network);
  for (const Layer& layer : network.layers) check.check(layer);
  check.check_logits(network.layers.back());
  return network;
}

}  // namespace

Network parse_network(std::string_view content, const std::string& name) {
  const auto fail = [&](const std::string& why) {
    return Error(ErrorKind::data, name + ": " + why);
  };
  const std::size_t ahead = kMagic.size() + 8;
  if (!content.starts_with(kMagic) || content.size() < ahead)
    throw fail("not a network file of adasplats");
  std::uint64_t length = 0;
  std::memcpy(&length, content.data() + kMagic.size(), 8);
  if (length > content.size() - ahead) throw fail("the header is truncated");
  try {
    const json header = json::parse(content.substr(ahead, length));
    const int version = header.at("version").get<int>();
    if (version != kVersion)
      throw std::runtime_error("version " + std::to_string(version) + ", expected " +
                               std::to_string(kVersion));
    Network network = network_of(header, content.substr(ahead + length));
    Sha256 hash;
    hash.add(content);
    network.sha256 = hash.digest();
    return network;
  } catch (const json::exception& error) {
    throw fail(std::string("the header is damaged: ") + error.what());
  } catch (const std::runtime_error& error) {
    throw fail(error.what());
  }
}

std::vector<std::size_t> last_uses(const Network& network) {
  std::vector<std::size_t> last(network.values, 0);
  for (std::size_t k = 0; k < network.layers.size(); ++k) {
    const Layer& layer = network.layers[k];
    last[layer.input] = k;
    if (layer.kind == LayerKind::add || layer.kind == LayerKind::join) last[layer.second] = k;
  }
  return last;
}

Network read_network(const std::filesystem::path& file) {
  return parse_network(read_file(file), file.string());
}

}  // namespace adasplats
