// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/layered_item.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/colours.h"
#include "adasplats/io/laz/wave_packets.h"

namespace adasplats {
namespace {

using Layers = std::span<const std::span<const std::byte>>;

class Rgb14 final : public LayeredItem {
 public:
  explicit Rgb14(unsigned version) : channels_(version) {}
  std::size_t layers() const override { return 1; }

  void start(const std::byte* first, std::size_t channel, Layers layers, bool& broken) override {
    layer_ = PackedLayer(layers[0], broken);
    channels_.start(channel, {}, load_value<Rgb>(first));
  }

  void decode(std::byte* item, std::size_t channel) override {
    const auto [models, last] = channels_.select(channel);
    if (layer_.is_packed) last = models.decode(layer_.decoder, last);
    store_value(item, last);
  }

 private:
  PackedLayer layer_;
  ScannerChannels<RgbModels, Rgb> channels_;
};

class RgbNir14 final : public LayeredItem {
 public:
  explicit RgbNir14(unsigned version) : channels_(version) {}
  std::size_t layers() const override { return 2; }

  void start(const std::byte* first, std::size_t channel, Layers layers, bool& broken) override {
    rgb_ = PackedLayer(layers[0], broken);
    infrared_ = PackedLayer(layers[1], broken);
    channels_.start(channel, {}, load_value<Last>(first));
  }

  void decode(std::byte* item, std::size_t channel) override {
    const auto [models, last] = channels_.select(channel);
    if (rgb_.is_packed) last.rgb = models.rgb.decode(rgb_.decoder, last.rgb);
    if (infrared_.is_packed)
      last.infrared = models.infrared.decode(infrared_.decoder, last.infrared);
    store_value(item, last);
  }

 private:
  struct Models {
    RgbModels rgb;
    InfraredModels infrared;
  };
  struct Last {
    Rgb rgb{};
    std::uint16_t infrared = 0;
  };
  static_assert(sizeof(Last) == 8);

  PackedLayer rgb_, infrared_;
  ScannerChannels<Models, Last> channels_;
};

class WavePacket14 final : public LayeredItem {
 public:
  explicit WavePacket14(unsigned version) : channels_(version) {}
  std::size_t layers() const override { return 1; }

  void start(const std::byte* first, std::size_t channel, Layers layers, bool& broken) override {
    layer_ = PackedLayer(layers[0], broken);
    channels_.start(channel, {}, load_value<WavePacket>(first));
  }

  void decode(std::byte* item, std::size_t channel) override {
    const auto [models, last] = channels_.select(channel);
    if (layer_.is_packed) last = models.decode(layer_.decoder, last);
    store_value(item, last);
  }

 private:
  PackedLayer layer_;
  ScannerChannels<WavePacketModels, WavePacket> channels_;
};

/// Each byte is a separate layer.
class ExtraBytes14 final : public LayeredItem {
 public:
  ExtraBytes14(unsigned version, std::size_t bytes) : layers_(bytes), channels_(version) {}
  std::size_t layers() const override { return layers_.size(); }

  void start(const std::byte* first, std::size_t channel, Layers layers, bool& broken) override {
    for (std::size_t k = 0; k < layers_.size(); ++k) layers_[k] = PackedLayer(layers[k], broken);
    channels_.start(channel, std::vector<SymbolModel>(layers_.size(), SymbolModel(256)),
                    {first, first + layers_.size()});
  }

  void decode(std::byte* item, std::size_t channel) override {
    const auto [models, last] = channels_.select(channel);
    for (std::size_t k = 0; k < layers_.size(); ++k) {
      if (!layers_[k].is_packed) continue;
      last[k] = static_cast<std::byte>(std::to_integer<std::uint32_t>(last[k]) +
                                       models[k].decode(layers_[k].decoder));
    }
    std::copy(last.begin(), last.end(), item);
  }

 private:
  std::vector<PackedLayer> layers_;
  ScannerChannels<std::vector<SymbolModel>, std::vector<std::byte>> channels_;
};

}  // namespace

std::unique_ptr<LayeredItem> make_layered_item(const LazItem& item) {
  switch (item.type) {
    case LazItemType::rgb14: return std::make_unique<Rgb14>(item.version);
    case LazItemType::rgb_nir14: return std::make_unique<RgbNir14>(item.version);
    case LazItemType::wave_packet14: return std::make_unique<WavePacket14>(item.version);
    case LazItemType::extra_bytes14:
      return std::make_unique<ExtraBytes14>(item.version, item.bytes);
    default: throw std::logic_error("an item of points one by one in a layered chunk");
  }
}

}  // namespace adasplats
