// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/pointwise_item.h"
#include "adasplats/io/laz/predictions.h"

namespace adasplats {
namespace {

// The 20 bytes that formats 0 to 5 share ("LAS specification 1.4 - R15", table 7).
constexpr std::size_t kPoint10Bytes = 20;
constexpr std::size_t kYByte = 4, kZByte = 8, kIntensityByte = 12, kReturnsByte = 14,
                      kClassByte = 15, kAngleByte = 16, kUserDataByte = 17, kSourceByte = 18;

using Point10Bytes = std::array<std::byte, kPoint10Bytes>;

/// Bytes that depend on the previous one: a model for each of its values.
class ByteAfterByte {
 public:
  void decode(RangeDecoder& decoder, std::byte& value) {
    value = static_cast<std::byte>(models_[std::to_integer<std::size_t>(value)].decode(decoder));
  }

 private:
  std::vector<SymbolModel> models_ = std::vector<SymbolModel>(256, SymbolModel(256));
};

void decode_u16(IntegerModel& integers, RangeDecoder& decoder, std::byte* value) {
  store_value(value, static_cast<std::uint16_t>(
                         integers.decode(decoder, load_value<std::uint16_t>(value))));
}

/// Adds modulo 2^32: damaged files contain any numbers.
std::int32_t wrapped_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

unsigned even(unsigned number) { return number & ~1U; }

/// The method of LASzip since 2.0.
class Point10V2 final : public PointwiseItem {
 public:
  void start(const std::byte* first) override {
    std::copy_n(first, kPoint10Bytes, last_.begin());
    // The first record predicts no intensity.
    store_value(&last_[kIntensityByte], std::uint16_t{0});
  }

  void decode(RangeDecoder& decoder, std::byte* item) override {
    const unsigned changed = changed_.decode(decoder);
    if ((changed & 32) != 0) returns_.decode(decoder, last_[kReturnsByte]);
    const auto bits = std::to_integer<unsigned>(last_[kReturnsByte]);
    const unsigned number = bits & 7, returns = (bits >> 3) & 7;
    const std::size_t group = group_of_return(returns, number);
    decode_attributes(decoder, changed, group);
    const unsigned is_single = returns == 1 ? 1 : 0;
    decode_position(decoder, group, depth_of_return(returns, number), is_single);
    std::copy(last_.begin(), last_.end(), item);
  }

 private:
  void decode_attributes(RangeDecoder& decoder, unsigned changed, std::size_t group) {
    if (changed == 0) return;
    std::uint16_t& intensity = intensities_[group];
    if ((changed & 16) != 0) {
      intensity = static_cast<std::uint16_t>(intensity_.decode(
          decoder, intensity, static_cast<unsigned>(std::min<std::size_t>(group, 3))));
    }
    store_value(&last_[kIntensityByte], intensity);
    if ((changed & 8) != 0) class_.decode(decoder, last_[kClassByte]);
    if ((changed & 4) != 0) {
      const bool goes_back = (std::to_integer<unsigned>(last_[kReturnsByte]) & 64) != 0;
      const std::uint32_t step = angle_steps_[goes_back ? 1 : 0].decode(decoder);
      last_[kAngleByte] =
          static_cast<std::byte>(std::to_integer<std::uint32_t>(last_[kAngleByte]) + step);
    }
    if ((changed & 2) != 0) user_data_.decode(decoder, last_[kUserDataByte]);
    if ((changed & 1) != 0) decode_u16(source_, decoder, &last_[kSourceByte]);
  }

  void decode_position(RangeDecoder& decoder, std::size_t group, std::size_t depth,
                       unsigned is_single) {
    const std::int32_t dx = dx_.decode_signed(decoder, x_steps_[group].get(), is_single);
    x_steps_[group].add(dx);
    store_value(&last_[0], wrapped_sum(load_value<std::int32_t>(&last_[0]), dx));
    const unsigned x_bits = dx_.last_bits();
    const std::int32_t dy =
        dy_.decode_signed(decoder, y_steps_[group].get(), is_single + std::min(even(x_bits), 20U));
    y_steps_[group].add(dy);
    store_value(&last_[kYByte], wrapped_sum(load_value<std::int32_t>(&last_[kYByte]), dy));
    const unsigned mean_bits = (x_bits + dy_.last_bits()) / 2;
    heights_[depth] =
        z_.decode_signed(decoder, heights_[depth], is_single + std::min(even(mean_bits), 18U));
    store_value(&last_[kZByte], heights_[depth]);
  }

  Point10Bytes last_{};
  SymbolModel changed_{64};
  ByteAfterByte returns_, class_, user_data_;
  std::array<SymbolModel, 2> angle_steps_ = {SymbolModel(256), SymbolModel(256)};
  IntegerModel intensity_{16, 4}, source_{16};
  IntegerModel dx_{32, 2}, dy_{32, 22}, z_{32, 20};
  std::array<std::uint16_t, 16> intensities_{};
  std::array<RunningMedian, 16> x_steps_, y_steps_;
  std::array<std::int32_t, 8> heights_{};
};

/// The method of LASzip before 2.0.
class Point10V1 final : public PointwiseItem {
 public:
  void start(const std::byte* first) override { std::copy_n(first, kPoint10Bytes, last_.begin()); }

  void decode(RangeDecoder& decoder, std::byte* item) override {
    const std::int32_t dx = dx_.decode_signed(decoder, median(x_steps_));
    const unsigned x_bits = dx_.last_bits();
    const std::int32_t dy =
        dy_.decode_signed(decoder, median(y_steps_), std::min(x_bits, kMaxBits));
    const unsigned mean_bits = (x_bits + dy_.last_bits()) / 2;
    const std::int32_t z = z_.decode_signed(decoder, load_value<std::int32_t>(&last_[kZByte]),
                                            std::min(mean_bits, kMaxBits));
    store_value(&last_[0], wrapped_sum(load_value<std::int32_t>(&last_[0]), dx));
    store_value(&last_[kYByte], wrapped_sum(load_value<std::int32_t>(&last_[kYByte]), dy));
    store_value(&last_[kZByte], z);
    decode_attributes(decoder, mean_bits);
    x_steps_[oldest_] = dx;
    y_steps_[oldest_] = dy;
    oldest_ = (oldest_ + 1) % 3;
    std::copy(last_.begin(), last_.end(), item);
  }

 private:
  static constexpr unsigned kMaxBits = 19;
  using Steps = std::array<std::int32_t, 3>;

  static std::int32_t median(Steps steps) {
    std::sort(steps.begin(), steps.end());
    return steps[1];
  }

  void decode_attributes(RangeDecoder& decoder, unsigned mean_bits) {
    const unsigned changed = changed_.decode(decoder);
    if ((changed & 32) != 0) decode_u16(intensity_, decoder, &last_[kIntensityByte]);
    if ((changed & 16) != 0) returns_.decode(decoder, last_[kReturnsByte]);
    if ((changed & 8) != 0) class_.decode(decoder, last_[kClassByte]);
    if ((changed & 4) != 0) {
      last_[kAngleByte] = static_cast<std::byte>(angle_.decode(
          decoder, std::to_integer<std::uint32_t>(last_[kAngleByte]), mean_bits < 3 ? 1 : 0));
    }
    if ((changed & 2) != 0) user_data_.decode(decoder, last_[kUserDataByte]);
    if ((changed & 1) != 0) decode_u16(source_, decoder, &last_[kSourceByte]);
  }

  Point10Bytes last_{};
  SymbolModel changed_{64};
  ByteAfterByte returns_, class_, user_data_;
  IntegerModel dx_{32}, dy_{32, 20}, z_{32, 20};
  IntegerModel intensity_{16}, angle_{8, 2}, source_{16};
  Steps x_steps_{}, y_steps_{};
  std::size_t oldest_ = 0;
};

}  // namespace

std::unique_ptr<PointwiseItem> make_point10_v1() { return std::make_unique<Point10V1>(); }
std::unique_ptr<PointwiseItem> make_point10_v2() { return std::make_unique<Point10V2>(); }

}  // namespace adasplats
