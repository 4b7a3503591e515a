// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "adasplats/io/laz/laz_item.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

/// The bytes of one attribute of a chunk; empty if it is the same for all points.
struct PackedLayer {
  PackedLayer() = default;
  PackedLayer(std::span<const std::byte> bytes, bool& is_broken)
      : decoder(bytes.empty() ? RangeDecoder() : RangeDecoder(bytes, is_broken)),
        is_packed(!bytes.empty()) {}

  RangeDecoder decoder;
  bool is_packed = false;
};

/// Decodes one part, other than the point itself, of the records of a layered chunk (formats 6-10).
class LayeredItem {
 public:
  LayeredItem() = default;
  virtual ~LayeredItem() = default;
  LayeredItem(const LayeredItem&) = delete;
  LayeredItem& operator=(const LayeredItem&) = delete;

  /// Number of layers, in file order.
  virtual std::size_t layers() const = 0;
  /// Starts with the item of the first record, which is stored uncompressed, and the layers.
  virtual void start(const std::byte* first, std::size_t channel,
                     std::span<const std::span<const std::byte>> layers, bool& is_broken) = 0;
  /// Writes the item of the next record.
  virtual void decode(std::byte* item, std::size_t channel) = 0;
};

/// The decoder of an item of formats 6 to 10 other than the point.
std::unique_ptr<LayeredItem> make_layered_item(const LazItem& item);

/// Models and last items of the four scanner channels.
template <class Models, class Last>
class ScannerChannels {
 public:
  explicit ScannerChannels(unsigned version) : version_(version) {}

  void start(std::size_t channel, Models fresh, Last first) {
    fresh_ = std::move(fresh);
    current_ = channel;
    models_[channel] = *fresh_;
    lasts_[channel] = std::move(first);
  }

  /// The models for a point of `channel`, and the last item, to be used and replaced. On return to
  /// a channel version 3 continues with the last item of the previous channel; this mistake, which
  /// files depend on, is fixed in version 4.
  std::pair<Models&, Last&> select(std::size_t channel) {
    std::size_t last = current_;
    if (channel != current_) {
      current_ = channel;
      if (!models_[channel]) {
        models_[channel] = *fresh_;
        lasts_[channel] = lasts_[last];
        last = channel;
      } else if (version_ >= 4) {
        last = channel;
      }
    }
    return {*models_[current_], lasts_[last]};
  }

 private:
  unsigned version_;
  std::size_t current_ = 0;
  std::optional<Models> fresh_;
  std::array<std::optional<Models>, 4> models_;
  std::array<Last, 4> lasts_{};
};

}  // namespace adasplats
