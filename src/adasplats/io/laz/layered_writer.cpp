// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/layered_writer.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/colours.h"
#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/layered_item.h"
#include "adasplats/io/laz/point14_encoder.h"

namespace adasplats {
namespace {

constexpr std::size_t kPointBytes = 30;
constexpr unsigned kItemsVersion = 3;

/// Each byte is a separate layer of differences to the last point.
class ExtraBytesEncoder {
 public:
  ExtraBytesEncoder(std::span<const std::byte> first, std::size_t channel)
      : layers_(first.size()), channels_(kItemsVersion) {
    channels_.start(channel, std::vector<SymbolModel>(first.size(), SymbolModel(256)),
                    {first.begin(), first.end()});
  }

  void encode(std::span<const std::byte> item, std::size_t channel) {
    const auto [models, last] = channels_.select(channel);
    for (std::size_t k = 0; k < layers_.size(); ++k) {
      const auto difference =
          std::to_integer<std::uint8_t>(item[k]) - std::to_integer<std::uint8_t>(last[k]);
      models[k].encode(layers_[k].encoder, static_cast<std::uint8_t>(difference));
      if (difference != 0) layers_[k].is_needed = true;
    }
    std::ranges::copy(item, last.begin());
  }

  void finish(std::vector<std::string>& layers) {
    for (LayerEncoder& layer : layers_) layers.push_back(layer.finish());
  }

 private:
  std::vector<LayerEncoder> layers_;
  ScannerChannels<std::vector<SymbolModel>, std::vector<std::byte>> channels_;
};

/// Colours, and near infrared if the item has 8 bytes; one layer each.
class ColourEncoder {
 public:
  ColourEncoder(std::span<const std::byte> first, std::size_t channel)
      : bytes_(first.size()), channels_(kItemsVersion) {
    channels_.start(channel, {}, last_of(first));
  }

  void encode(std::span<const std::byte> item, std::size_t channel) {
    const auto [models, last] = channels_.select(channel);
    const Last next = last_of(item);
    models.rgb.encode(rgb_.encoder, last.rgb, next.rgb);
    models.infrared.encode(infrared_.encoder, last.infrared, next.infrared);
    rgb_.is_needed |= next.rgb != last.rgb;
    infrared_.is_needed |= next.infrared != last.infrared;
    last = next;
  }

  void finish(std::vector<std::string>& layers) {
    layers.push_back(rgb_.finish());
    if (bytes_ > kRgbBytes) layers.push_back(infrared_.finish());
  }

 private:
  static constexpr std::size_t kRgbBytes = 6;
  struct Models {
    RgbModels rgb;
    InfraredModels infrared;
  };
  struct Last {
    Rgb rgb{};
    std::uint16_t infrared = 0;
  };
  static Last last_of(std::span<const std::byte> item) {
    return {load_value<Rgb>(item.data()), item.size() > kRgbBytes
                                              ? load_value<std::uint16_t>(item.data() + kRgbBytes)
                                              : std::uint16_t{0}};
  }

  std::size_t bytes_;
  LayerEncoder rgb_, infrared_;
  ScannerChannels<Models, Last> channels_;
};

void append_u32(std::string& bytes, std::size_t number) {
  for (unsigned shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(number >> shift);
}

}  // namespace

std::string pack_layered_chunk(const std::byte* records, std::size_t count,
                               std::size_t record_bytes, std::size_t colour_bytes) {
  Point14Encoder points(records);
  const std::size_t extras_at = kPointBytes + colour_bytes;
  const auto part_of = [&](std::size_t row, std::size_t begin, std::size_t end) {
    return std::span(records + row * record_bytes + begin, end - begin);
  };
  std::optional<ColourEncoder> colours;
  if (colour_bytes > 0) colours.emplace(part_of(0, kPointBytes, extras_at), points.channel());
  ExtraBytesEncoder extras(part_of(0, extras_at, record_bytes), points.channel());
  for (std::size_t row = 1; row < count; ++row) {
    const std::size_t channel = points.encode(records + row * record_bytes);
    if (colours) colours->encode(part_of(row, kPointBytes, extras_at), channel);
    extras.encode(part_of(row, extras_at, record_bytes), channel);
  }
  std::vector<std::string> layers;
  for (std::string& layer : points.finish()) layers.push_back(std::move(layer));
  if (colours) colours->finish(layers);
  extras.finish(layers);
  std::string chunk(reinterpret_cast<const char*>(records), record_bytes);
  append_u32(chunk, count);
  for (const std::string& layer : layers) append_u32(chunk, layer.size());
  for (const std::string& layer : layers) chunk += layer;
  return chunk;
}

std::string pack_chunk_table(std::span<const std::uint32_t> chunk_bytes) {
  RangeEncoder encoder;
  IntegerModel integers(32, 2);
  std::uint32_t last = 0;
  for (const std::uint32_t bytes : chunk_bytes) {
    integers.encode(encoder, last, bytes, 1);
    last = bytes;
  }
  return encoder.finish();
}

}  // namespace adasplats
