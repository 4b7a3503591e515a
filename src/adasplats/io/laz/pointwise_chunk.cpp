// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "adasplats/io/laz/packed_chunk.h"
#include "adasplats/io/laz/pointwise_item.h"

namespace adasplats {
namespace {

/// The first record uncompressed, then the others in one stream, item by item.
class PointwiseChunk final : public PackedChunk {
 public:
  PointwiseChunk(const LazPacking& packing, std::span<const std::byte> bytes)
      : bytes_(bytes), record_bytes_(packing.record_bytes) {
    std::size_t at = 0;
    for (const LazItem& item : packing.items) {
      std::unique_ptr<PointwiseItem> decoder = make_pointwise_item(item);
      items_.push_back({at, std::move(decoder)});
      at += item.bytes;
    }
  }

  std::size_t decode(std::byte* records, std::size_t count) override {
    std::size_t row = 0;
    if (count > 0 && !has_begun_) row += begin(records) ? 1 : 0;
    for (; row < count && !is_broken_; ++row) {
      std::byte* const record = records + row * record_bytes_;
      for (const Item& item : items_) item.decoder->decode(decoder_, record + item.at);
      // The record just decoded may be beyond the end.
      if (is_broken_) return row;
    }
    return row;
  }

  std::size_t bytes() const override {
    return has_stream_ ? static_cast<std::size_t>(decoder_.place() - bytes_.data())
                       : std::min(record_bytes_, bytes_.size());
  }

 private:
  struct Item {
    std::size_t at;
    std::unique_ptr<PointwiseItem> decoder;
  };

  bool begin(std::byte* record) {
    has_begun_ = true;
    is_broken_ = bytes_.size() < record_bytes_;
    if (is_broken_) return false;
    std::copy_n(bytes_.begin(), record_bytes_, record);
    for (const Item& item : items_) item.decoder->start(record + item.at);
    decoder_ = RangeDecoder(bytes_.subspan(record_bytes_), is_broken_);
    has_stream_ = true;
    return true;
  }

  std::span<const std::byte> bytes_;
  std::size_t record_bytes_;
  std::vector<Item> items_;
  RangeDecoder decoder_;
  bool has_begun_ = false;
  bool has_stream_ = false;
  bool is_broken_ = false;
};

}  // namespace

std::unique_ptr<PackedChunk> make_pointwise_chunk(const LazPacking& packing,
                                                  std::span<const std::byte> bytes) {
  return std::make_unique<PointwiseChunk>(packing, bytes);
}

}  // namespace adasplats
