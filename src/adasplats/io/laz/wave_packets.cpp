// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/wave_packets.h"

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/pointwise_item.h"

namespace adasplats {
namespace {

constexpr std::size_t kOffsetAt = 1, kSizeAt = 9, kReturnPointAt = 13, kDirectionAt = 17;

}  // namespace

WavePacket WavePacketModels::decode(RangeDecoder& decoder, const WavePacket& last) {
  const auto number = [&last](std::size_t at) { return load_value<std::uint32_t>(&last[at]); };
  WavePacket packet{};
  packet[0] = static_cast<std::byte>(index_.decode(decoder));
  store_value(&packet[kOffsetAt],
              offset(decoder, load_value<std::uint64_t>(&last[kOffsetAt]), number(kSizeAt)));
  // Floating-point numbers are encoded by their bits.
  store_value(&packet[kSizeAt], sizes_.decode(decoder, number(kSizeAt)));
  store_value(&packet[kReturnPointAt], return_points_.decode(decoder, number(kReturnPointAt)));
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::size_t at = kDirectionAt + std::size_t{4} * axis;
    store_value(&packet[at], directions_.decode(decoder, number(at), axis));
  }
  return packet;
}

std::uint64_t WavePacketModels::offset(RangeDecoder& decoder, std::uint64_t last,
                                       std::uint32_t last_size) {
  last_kind_ = offset_kinds_[last_kind_].decode(decoder);
  switch (last_kind_) {
    case 0: return last;
    case 1: return last + last_size;
    case 2:
      last_difference_ = differences_.decode_signed(decoder, last_difference_);
      return last + static_cast<std::uint64_t>(std::int64_t{last_difference_});
    default: return decoder.bits64();
  }
}

namespace {

class WavePacket13 final : public PointwiseItem {
 public:
  void start(const std::byte* first) override { last_ = load_value<WavePacket>(first); }
  void decode(RangeDecoder& decoder, std::byte* item) override {
    last_ = models_.decode(decoder, last_);
    store_value(item, last_);
  }

 private:
  WavePacket last_{};
  WavePacketModels models_;
};

}  // namespace

std::unique_ptr<PointwiseItem> make_wave_packet13() { return std::make_unique<WavePacket13>(); }

}  // namespace adasplats
