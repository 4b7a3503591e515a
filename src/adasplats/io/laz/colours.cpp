// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/colours.h"

#include <algorithm>

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/pointwise_item.h"

namespace adasplats {
namespace {

constexpr std::uint32_t kGreenAndBlueDiffer = 64;  // from red

/// The lower (0) or the upper (1) byte of a colour's channel.
int half_of(std::uint16_t value, std::size_t half) { return half == 0 ? value & 0xff : value >> 8; }

}  // namespace

std::uint16_t RgbModels::byte(RangeDecoder& decoder, std::size_t model, int expected) {
  const auto near = static_cast<std::uint32_t>(std::clamp(expected, 0, 255));
  return static_cast<std::uint16_t>((near + differences_[model].decode(decoder)) & 0xff);
}

Rgb RgbModels::decode(RangeDecoder& decoder, const Rgb& last) {
  const std::uint32_t changed = changed_.decode(decoder);
  std::array<std::array<std::uint16_t, 2>, 3> halves{};  // [channel][half]
  // Bit and model of a channel's half: 2 * channel + half.
  const auto decode_half = [&](std::size_t channel, std::size_t half, int change) {
    const int before = half_of(last[channel], half);
    const std::size_t model = 2 * channel + half;
    halves[channel][half] = (changed & (1U << model)) != 0 ? byte(decoder, model, before + change)
                                                           : static_cast<std::uint16_t>(before);
  };
  const auto change_of = [&](std::size_t channel, std::size_t half) {
    return halves[channel][half] - half_of(last[channel], half);
  };
  decode_half(0, 0, 0);
  decode_half(0, 1, 0);
  if ((changed & kGreenAndBlueDiffer) == 0) {
    halves[1] = halves[2] = halves[0];
  } else {
    for (const std::size_t half : {0U, 1U}) {
      const int red = change_of(0, half);
      decode_half(1, half, red);
      decode_half(2, half, (red + change_of(1, half)) / 2);
    }
  }
  Rgb colour;
  for (std::size_t channel = 0; channel < 3; ++channel)
    colour[channel] = static_cast<std::uint16_t>(halves[channel][0] | (halves[channel][1] << 8));
  return colour;
}

void RgbModels::encode(RangeEncoder& encoder, const Rgb& last, const Rgb& colour) {
  const auto change_of = [&](std::size_t channel, std::size_t half) {
    return half_of(colour[channel], half) - half_of(last[channel], half);
  };
  std::uint32_t changed =
      colour[1] == colour[0] && colour[2] == colour[0] ? 0 : kGreenAndBlueDiffer;
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (const std::size_t half : {0U, 1U})
      if (change_of(channel, half) != 0) changed |= 1U << (2 * channel + half);
  changed_.encode(encoder, changed);
  const auto encode_half = [&](std::size_t channel, std::size_t half, int change) {
    const std::size_t model = 2 * channel + half;
    if ((changed & (1U << model)) == 0) return;
    const int near = std::clamp(half_of(last[channel], half) + change, 0, 255);
    differences_[model].encode(encoder,
                               static_cast<std::uint8_t>(half_of(colour[channel], half) - near));
  };
  encode_half(0, 0, 0);
  encode_half(0, 1, 0);
  if ((changed & kGreenAndBlueDiffer) == 0) return;
  for (const std::size_t half : {0U, 1U}) {
    const int red = change_of(0, half);
    encode_half(1, half, red);
    encode_half(2, half, (red + change_of(1, half)) / 2);
  }
}

std::uint16_t InfraredModels::decode(RangeDecoder& decoder, std::uint16_t last) {
  const std::uint32_t changed = changed_.decode(decoder);
  std::uint32_t value = 0;
  for (const std::size_t half : {0U, 1U}) {
    auto byte = static_cast<std::uint32_t>(half_of(last, half));
    if ((changed & (1U << half)) != 0) byte = (byte + differences_[half].decode(decoder)) & 0xff;
    value |= byte << (8 * half);
  }
  return static_cast<std::uint16_t>(value);
}

void InfraredModels::encode(RangeEncoder& encoder, std::uint16_t last, std::uint16_t value) {
  std::uint32_t changed = 0;
  for (const std::size_t half : {0U, 1U})
    if (half_of(value, half) != half_of(last, half)) changed |= 1U << half;
  changed_.encode(encoder, changed);
  for (const std::size_t half : {0U, 1U})
    if ((changed & (1U << half)) != 0)
      differences_[half].encode(
          encoder, static_cast<std::uint8_t>(half_of(value, half) - half_of(last, half)));
}

namespace {

/// The method of LASzip since 2.0.
class Rgb12V2 final : public PointwiseItem {
 public:
  void start(const std::byte* first) override { last_ = load_value<Rgb>(first); }
  void decode(RangeDecoder& decoder, std::byte* item) override {
    last_ = models_.decode(decoder, last_);
    store_value(item, last_);
  }

 private:
  Rgb last_{};
  RgbModels models_;
};

/// The method of LASzip before 2.0: each byte separately.
class Rgb12V1 final : public PointwiseItem {
 public:
  void start(const std::byte* first) override { last_ = load_value<Rgb>(first); }

  void decode(RangeDecoder& decoder, std::byte* item) override {
    const std::uint32_t changed = changed_.decode(decoder);
    for (unsigned k = 0; k < 6; ++k) {
      if ((changed & (1U << k)) == 0) continue;
      std::uint16_t& channel = last_[k / 2];
      const unsigned shift = 8 * (k % 2);
      const std::uint32_t byte = bytes_.decode(decoder, (channel >> shift) & 0xffU, k);
      channel = static_cast<std::uint16_t>((channel & (0xff00U >> shift)) | (byte << shift));
    }
    store_value(item, last_);
  }

 private:
  Rgb last_{};
  SymbolModel changed_{64};
  IntegerModel bytes_{8, 6};
};

}  // namespace

std::unique_ptr<PointwiseItem> make_rgb12_v1() { return std::make_unique<Rgb12V1>(); }
std::unique_ptr<PointwiseItem> make_rgb12_v2() { return std::make_unique<Rgb12V2>(); }

}  // namespace adasplats
