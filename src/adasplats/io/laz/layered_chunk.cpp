// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/layered_item.h"
#include "adasplats/io/laz/packed_chunk.h"
#include "adasplats/io/laz/point14.h"

namespace adasplats {
namespace {

/// The first record uncompressed, the number of points, the sizes of the layers, then the layers.
class LayeredChunk final : public PackedChunk {
 public:
  LayeredChunk(const LazPacking& packing, std::span<const std::byte> bytes)
      : bytes_(bytes), record_bytes_(packing.record_bytes), version_(packing.items[0].version) {
    std::size_t at = packing.items[0].bytes;
    for (std::size_t k = 1; k < packing.items.size(); ++k) {
      items_.push_back({at, make_layered_item(packing.items[k])});
      at += packing.items[k].bytes;
    }
    find_layers();
  }

  std::size_t decode(std::byte* records, std::size_t count) override {
    std::size_t row = 0;
    if (count > 0 && !point_ && !is_broken_) {
      begin(records);
      row = 1;
    }
    // Any other attribute may be constant, but x and y are always stored.
    if (row < count && !is_broken_) is_broken_ = layers_[0].empty();
    for (; row < count && !is_broken_; ++row) {
      std::byte* const record = records + row * record_bytes_;
      const std::size_t channel = point_->decode(record);
      for (const Item& item : items_) item.decoder->decode(record + item.at, channel);
      if (is_broken_) return row;
    }
    return row;
  }

  std::size_t bytes() const override { return used_bytes_; }

 private:
  struct Item {
    std::size_t at;
    std::unique_ptr<LayeredItem> decoder;
  };

  void find_layers() {
    std::size_t count = Point14Decoder::kLayers;
    for (const Item& item : items_) count += item.decoder->layers();
    const std::size_t sizes_at = record_bytes_ + sizeof(std::uint32_t);
    used_bytes_ = sizes_at + count * sizeof(std::uint32_t);
    is_broken_ = bytes_.size() < used_bytes_;
    for (std::size_t k = 0; k < count && !is_broken_; ++k) {
      const std::size_t size = load_value<std::uint32_t>(bytes_.data() + sizes_at + 4 * k);
      is_broken_ = bytes_.size() - used_bytes_ < size;
      if (is_broken_) break;
      layers_.push_back(bytes_.subspan(used_bytes_, size));
      used_bytes_ += size;
    }
    used_bytes_ = std::min(used_bytes_, bytes_.size());
  }

  void begin(std::byte* record) {
    std::copy_n(bytes_.begin(), record_bytes_, record);
    std::span<const std::span<const std::byte>> layers = layers_;
    point_.emplace(version_, record, layers.first(Point14Decoder::kLayers), is_broken_);
    layers = layers.subspan(Point14Decoder::kLayers);
    for (const Item& item : items_) {
      const std::size_t count = item.decoder->layers();
      item.decoder->start(record + item.at, point_->channel(), layers.first(count), is_broken_);
      layers = layers.subspan(count);
    }
  }

  std::span<const std::byte> bytes_;
  std::size_t record_bytes_;
  unsigned version_;
  std::vector<Item> items_;
  std::vector<std::span<const std::byte>> layers_;
  std::size_t used_bytes_ = 0;
  std::optional<Point14Decoder> point_;
  bool is_broken_ = false;
};

}  // namespace

std::unique_ptr<PackedChunk> make_layered_chunk(const LazPacking& packing,
                                                std::span<const std::byte> bytes) {
  return std::make_unique<LayeredChunk>(packing, bytes);
}

std::unique_ptr<PackedChunk> make_packed_chunk(const LazPacking& packing,
                                               std::span<const std::byte> bytes) {
  return packing.compressor == LazCompressor::layered ? make_layered_chunk(packing, bytes)
                                                      : make_pointwise_chunk(packing, bytes);
}

}  // namespace adasplats
