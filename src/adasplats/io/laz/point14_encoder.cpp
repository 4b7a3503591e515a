// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/point14_encoder.h"

#include <algorithm>

#include "adasplats/io/laz/point14_channel.h"
#include "adasplats/io/laz/predictions.h"

namespace adasplats {
namespace {

std::int32_t step_between(std::int32_t from, std::int32_t to) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) -
                                   static_cast<std::uint32_t>(from));
}

template <class T>
void encode_symbol(LayerEncoder& layer, SymbolModel& model, T last, T value) {
  model.encode(layer.encoder, value);
  if (value != last) layer.is_needed = true;
}

}  // namespace

Point14Encoder::Point14Encoder(const std::byte* item) {
  const Point14 first = load_point14(item);
  current_ = first.scanner_channel;
  channels_[current_] = std::make_unique<Point14Channel>(first);
  returns_xy_.is_needed = true;
}

Point14Encoder::~Point14Encoder() = default;

std::size_t Point14Encoder::encode(const std::byte* item) {
  const Point14 point = load_point14(item);
  Point14Channel* channel = channels_[current_].get();
  SymbolModel& change = channel->changed[channel->context_of_change()];
  const bool is_other_channel = point.scanner_channel != current_;
  // A channel begins with the last point of the previous one.
  const Point14Channel* const next = channels_[point.scanner_channel].get();
  const unsigned changed = changes_of(next == nullptr ? channel->last : next->last, point) |
                           (is_other_channel ? kChannelChanged : 0);
  change.encode(returns_xy_.encoder, changed);
  if (is_other_channel) channel = &switch_channel(*channel, point.scanner_channel);
  encode_returns(*channel, point, changed);
  encode_position(*channel, point, (changed & kTimeChanged) != 0);
  encode_attributes(*channel, point, changed);
  channel->last = point;
  channel->had_new_time = (changed & kTimeChanged) != 0;
  // As in Point14Decoder.
  return is_other_channel ? current_ : 0;
}

unsigned Point14Encoder::changes_of(const Point14& last, const Point14& point) {
  unsigned changed = 0;
  if (point.number_of_returns != last.number_of_returns) changed |= kReturnsChanged;
  if (point.scan_angle != last.scan_angle) changed |= kAngleChanged;
  if (point.gps_time != last.gps_time) changed |= kTimeChanged;
  if (point.point_source != last.point_source) changed |= kSourceChanged;
  switch ((point.return_number + 16U - last.return_number) % 16) {
    case 0: return changed;
    case 1: return changed | 1;
    case 15: return changed | 2;
    default: return changed | kReturnNumber;
  }
}

Point14Channel& Point14Encoder::switch_channel(Point14Channel& from, std::size_t to) {
  const std::size_t ahead = (to + 4 - current_) % 4;
  from.other_channel.encode(returns_xy_.encoder, static_cast<std::uint32_t>(ahead - 1));
  current_ = to;
  std::unique_ptr<Point14Channel>& channel = channels_[current_];
  if (!channel) channel = std::make_unique<Point14Channel>(from.last);
  return *channel;
}

void Point14Encoder::encode_returns(Point14Channel& channel, const Point14& point,
                                    unsigned changed) {
  const Point14& last = channel.last;
  RangeEncoder& encoder = returns_xy_.encoder;
  if ((changed & kReturnsChanged) != 0)
    channel.numbers_of_returns[last.number_of_returns].encode(encoder, point.number_of_returns);
  if ((changed & kReturnNumber) != kReturnNumber) return;
  if ((changed & kTimeChanged) != 0)
    channel.return_numbers[last.return_number].encode(encoder, point.return_number);
  else
    channel.return_number_same_time.encode(
        encoder, (point.return_number + 16U - last.return_number) % 16 - 2);
}

void Point14Encoder::encode_position(Point14Channel& channel, const Point14& point,
                                     bool has_new_time) {
  const Point14& last = channel.last;
  const std::size_t group =
      2 * coarse_group_of_return(point.number_of_returns, point.return_number) +
      (has_new_time ? 1 : 0);
  const unsigned is_single = point.number_of_returns == 1 ? 1 : 0;
  RunningMedian& x_steps = channel.x_steps[group];
  const std::int32_t dx = step_between(last.x, point.x);
  channel.dx.encode_signed(returns_xy_.encoder, x_steps.get(), dx, is_single);
  x_steps.add(dx);
  const unsigned x_bits = channel.dx.last_bits();
  RunningMedian& y_steps = channel.y_steps[group];
  const std::int32_t dy = step_between(last.y, point.y);
  channel.dy.encode_signed(returns_xy_.encoder, y_steps.get(), dy,
                           is_single + std::min(x_bits & ~1U, 20U));
  y_steps.add(dy);
  const unsigned mean_bits = (x_bits + channel.dy.last_bits()) / 2;
  std::int32_t& height =
      channel.heights[depth_of_return(point.number_of_returns, point.return_number)];
  channel.z.encode_signed(z_.encoder, height, point.z, is_single + std::min(mean_bits & ~1U, 18U));
  height = point.z;
  if (point.z != last.z) z_.is_needed = true;
}

void Point14Encoder::encode_attributes(Point14Channel& channel, const Point14& point,
                                       unsigned changed) {
  const Point14 last = channel.last;
  channel.last.return_number = point.return_number;
  channel.last.number_of_returns = point.number_of_returns;
  const unsigned kind = channel.kind();
  const unsigned has_new_time = (changed & kTimeChanged) != 0 ? 1 : 0;
  encode_symbol(classification_,
                channel.classes[2 * (last.classification & 0x1fU) + (kind == 3 ? 1 : 0)],
                last.classification, point.classification);
  encode_symbol(flags_, channel.flags[last.flags], last.flags, point.flags);
  std::uint16_t& intensity = channel.intensities[2 * kind + has_new_time];
  channel.intensity.encode(intensity_.encoder, intensity, point.intensity, kind);
  intensity = point.intensity;
  if (point.intensity != last.intensity) intensity_.is_needed = true;
  if ((changed & kAngleChanged) != 0) {
    scan_angle_.is_needed = true;
    channel.scan_angle.encode(scan_angle_.encoder, static_cast<std::uint32_t>(last.scan_angle),
                              static_cast<std::uint32_t>(point.scan_angle), has_new_time);
  }
  encode_symbol(user_data_, channel.user_data[last.user_data / 4], last.user_data, point.user_data);
  if ((changed & kSourceChanged) != 0) {
    point_source_.is_needed = true;
    channel.point_source.encode(point_source_.encoder, last.point_source, point.point_source);
  }
  if (has_new_time != 0) {
    gps_time_.is_needed = true;
    channel.gps_times.encode(gps_time_.encoder, point.gps_time);
  }
}

std::array<std::string, Point14Decoder::kLayers> Point14Encoder::finish() {
  return {
      returns_xy_.finish(), z_.finish(),          classification_.finish(), flags_.finish(),
      intensity_.finish(),  scan_angle_.finish(), user_data_.finish(),      point_source_.finish(),
      gps_time_.finish()};
}

}  // namespace adasplats
