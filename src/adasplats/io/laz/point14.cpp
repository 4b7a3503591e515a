// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/point14.h"

#include <algorithm>

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/point14_channel.h"
#include "adasplats/io/laz/predictions.h"

namespace adasplats {
namespace {

std::int32_t moved(std::int32_t from, std::int32_t by) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(from) +
                                   static_cast<std::uint32_t>(by));
}

}  // namespace

Point14 load_point14(const std::byte* item) {
  const auto byte = [item](std::size_t at) { return std::to_integer<std::uint8_t>(item[at]); };
  Point14 point;
  point.x = load_value<std::int32_t>(item);
  point.y = load_value<std::int32_t>(item + 4);
  point.z = load_value<std::int32_t>(item + 8);
  point.intensity = load_value<std::uint16_t>(item + 12);
  point.return_number = byte(14) & 0x0f;
  point.number_of_returns = static_cast<std::uint8_t>(byte(14) >> 4);
  point.flags = static_cast<std::uint8_t>((byte(15) & 0x0f) | ((byte(15) >> 2) & 0x30));
  point.scanner_channel = (byte(15) >> 4) & 3;
  point.classification = byte(16);
  point.user_data = byte(17);
  point.scan_angle = load_value<std::int16_t>(item + 18);
  point.point_source = load_value<std::uint16_t>(item + 20);
  point.gps_time = load_value<std::uint64_t>(item + 22);
  return point;
}

void store_point14(std::byte* item, const Point14& point) {
  store_value(item, point.x);
  store_value(item + 4, point.y);
  store_value(item + 8, point.z);
  store_value(item + 12, point.intensity);
  item[14] = static_cast<std::byte>(point.return_number | (point.number_of_returns << 4));
  item[15] = static_cast<std::byte>((point.flags & 0x0f) | (point.scanner_channel << 4) |
                                    ((point.flags & 0x30) << 2));
  item[16] = static_cast<std::byte>(point.classification);
  item[17] = static_cast<std::byte>(point.user_data);
  store_value(item + 18, point.scan_angle);
  store_value(item + 20, point.point_source);
  store_value(item + 22, point.gps_time);
}

Point14Decoder::Point14Decoder(unsigned version, const std::byte* item,
                               std::span<const std::span<const std::byte>> layers, bool& is_broken)
    : version_(version),
      returns_xy_(layers[0], is_broken),
      z_(layers[1], is_broken),
      classification_(layers[2], is_broken),
      flags_(layers[3], is_broken),
      intensity_(layers[4], is_broken),
      scan_angle_(layers[5], is_broken),
      user_data_(layers[6], is_broken),
      point_source_(layers[7], is_broken),
      gps_time_(layers[8], is_broken) {
  const Point14 first = load_point14(item);
  current_ = first.scanner_channel;
  channels_[current_] = std::make_unique<Channel>(first);
}

Point14Decoder::~Point14Decoder() = default;

std::size_t Point14Decoder::decode(std::byte* item) {
  Channel* channel = channels_[current_].get();
  const unsigned changed =
      channel->changed[channel->context_of_change()].decode(returns_xy_.decoder);
  const bool is_other_channel = (changed & kChannelChanged) != 0;
  if (is_other_channel) channel = &switch_channel(*channel);
  decode_returns(*channel, returns_xy_.decoder, changed);
  decode_position(*channel, (changed & kTimeChanged) != 0);
  decode_attributes(*channel, changed);
  store_point14(item, channel->last);
  channel->had_new_time = (changed & kTimeChanged) != 0;
  // In version 3 the other items follow the channel only where it changes, else channel 0.
  return version_ >= 4 || is_other_channel ? current_ : 0;
}

Point14Decoder::Channel& Point14Decoder::switch_channel(Channel& from) {
  const std::uint32_t ahead = from.other_channel.decode(returns_xy_.decoder) + 1;
  current_ = (current_ + ahead) % 4;
  std::unique_ptr<Channel>& channel = channels_[current_];
  if (!channel) channel = std::make_unique<Channel>(from.last);
  channel->last.scanner_channel = static_cast<std::uint8_t>(current_);
  return *channel;
}

void Point14Decoder::decode_returns(Channel& channel, RangeDecoder& decoder, unsigned changed) {
  Point14& point = channel.last;
  if ((changed & kReturnsChanged) != 0) {
    point.number_of_returns = static_cast<std::uint8_t>(
        channel.numbers_of_returns[point.number_of_returns].decode(decoder));
  }
  std::uint32_t number = point.return_number;
  switch (changed & kReturnNumber) {
    case 0: return;
    case 1: number += 1; break;
    case 2: number += 15; break;
    default:
      if ((changed & kTimeChanged) != 0)
        number = channel.return_numbers[number].decode(decoder);
      else
        number += channel.return_number_same_time.decode(decoder) + 2;
  }
  point.return_number = number % 16;
}

void Point14Decoder::decode_position(Channel& channel, bool has_new_time) {
  Point14& point = channel.last;
  const std::size_t group =
      2 * coarse_group_of_return(point.number_of_returns, point.return_number) +
      (has_new_time ? 1 : 0);
  const unsigned is_single = channel.is_single() ? 1 : 0;
  RunningMedian& x_steps = channel.x_steps[group];
  const std::int32_t dx = channel.dx.decode_signed(returns_xy_.decoder, x_steps.get(), is_single);
  x_steps.add(dx);
  point.x = moved(point.x, dx);
  // The number of bits of x, in pairs, predicts that of y.
  const unsigned x_bits = channel.dx.last_bits();
  RunningMedian& y_steps = channel.y_steps[group];
  const std::int32_t dy = channel.dy.decode_signed(returns_xy_.decoder, y_steps.get(),
                                                   is_single + std::min(x_bits & ~1U, 20U));
  y_steps.add(dy);
  point.y = moved(point.y, dy);
  if (!z_.is_packed) return;
  const unsigned mean_bits = (x_bits + channel.dy.last_bits()) / 2;
  std::int32_t& height =
      channel.heights[depth_of_return(point.number_of_returns, point.return_number)];
  height = channel.z.decode_signed(z_.decoder, height, is_single + std::min(mean_bits & ~1U, 18U));
  point.z = height;
}

void Point14Decoder::decode_attributes(Channel& channel, unsigned changed) {
  Point14& point = channel.last;
  const unsigned kind = channel.kind();
  const unsigned has_new_time = (changed & kTimeChanged) != 0 ? 1 : 0;
  if (classification_.is_packed) {
    const std::size_t before = 2 * (point.classification & 0x1fU) + (kind == 3 ? 1 : 0);
    point.classification =
        static_cast<std::uint8_t>(channel.classes[before].decode(classification_.decoder));
  }
  if (flags_.is_packed)
    point.flags = static_cast<std::uint8_t>(channel.flags[point.flags].decode(flags_.decoder));
  if (intensity_.is_packed) {
    std::uint16_t& intensity = channel.intensities[2 * kind + has_new_time];
    intensity =
        static_cast<std::uint16_t>(channel.intensity.decode(intensity_.decoder, intensity, kind));
    point.intensity = intensity;
  }
  if (scan_angle_.is_packed && (changed & kAngleChanged) != 0) {
    point.scan_angle = static_cast<std::int16_t>(channel.scan_angle.decode(
        scan_angle_.decoder, static_cast<std::uint32_t>(point.scan_angle), has_new_time));
  }
  if (user_data_.is_packed) {
    point.user_data = static_cast<std::uint8_t>(
        channel.user_data[point.user_data / 4].decode(user_data_.decoder));
  }
  if (point_source_.is_packed && (changed & kSourceChanged) != 0) {
    point.point_source = static_cast<std::uint16_t>(
        channel.point_source.decode(point_source_.decoder, point.point_source));
  }
  if (gps_time_.is_packed && has_new_time != 0)
    point.gps_time = channel.gps_times.decode(gps_time_.decoder);
}

}  // namespace adasplats
