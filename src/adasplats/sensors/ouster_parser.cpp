// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Ouster's packets: byte offsets and sources in packet_bytes.h.

#include <array>
#include <cstdio>
#include <string>

#include "adasplats/sensors/packet_bytes.h"
#include "adasplats/sensors/packet_parser.h"

namespace adasplats {
namespace {

OusterBytes bytes_of(const PacketSensor& sensor) {
  const PacketLayout& layout = *sensor.model.packets;
  return {sensor.format, sensor.lasers(), sensor.facts.columns, layout.has_safety_head};
}

/// "1024x10".
std::string mode_of(const LidarModel& model) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%ux%g", model.columns, model.rotation_hz);
  return text.data();
}

/// The head of a measured column.
struct ColumnHead {
  std::uint32_t step = 0;
  std::int64_t time_ns = 0;
  std::uint32_t ticks = 0;  ///< of the encoder, profile LEGACY only
};

class OusterParser final : public PacketParser {
 public:
  PacketTraits traits(const PacketSensor& /*sensor*/) const override {
    return {.has_frames = true};
  }
  std::uint32_t steps_per_turn(const PacketSensor& sensor) const override {
    return sensor.model.columns;
  }
  std::optional<std::string> objection(const PacketSensor& sensor,
                                       std::string_view payload) const override;
  std::optional<std::string> contradiction(const PacketSensor& sensor,
                                           std::string_view payload) const override;
  bool is_dual(const PacketSensor& sensor, std::string_view /*payload*/) const override {
    return ouster_channel(sensor.format).is_dual;
  }
  std::vector<MeasuredColumn> columns(const PacketSensor& sensor,
                                      std::string_view payload) const override;
  LaserReturns returns_at(const PacketSensor& sensor, std::string_view payload, std::size_t k,
                          std::size_t laser) const override;
};

std::optional<std::string> OusterParser::objection(const PacketSensor& sensor,
                                                   std::string_view payload) const {
  constexpr std::uint64_t kLongest_ns = 1'000'000'000, kLatest_ns = std::uint64_t{1} << 62U;
  const OusterBytes bytes = bytes_of(sensor);
  const auto first_ns = value_at<std::uint64_t>(payload, bytes.head);
  for (std::size_t k = 0; k < bytes.columns; ++k) {
    const auto time_ns = value_at<std::uint64_t>(payload, bytes.column_at(k));
    if (time_ns > kLatest_ns || (time_ns != 0 && time_ns + kLongest_ns < first_ns) ||
        time_ns > first_ns + kLongest_ns)
      return "have columns with times more than 1 s apart";
  }
  return std::nullopt;
}

/// How the head of a packet contradicts the metadata: the type and the serial number.
std::optional<std::string> contradiction_of_head(const PacketSensor& sensor,
                                                 std::string_view payload) {
  const OusterBytes bytes = bytes_of(sensor);
  if (bytes.head == 0) return std::nullopt;
  constexpr unsigned kLidarType = 1;
  const unsigned type = bytes.type_bytes == 1 ? value_at<std::uint8_t>(payload, 0)
                                              : value_at<std::uint16_t>(payload, 0);
  if (type != kLidarType)
    return "begin with the packet type " + std::to_string(type) +
           ", expected 1: another profile or header type than in " + sensor.model.name;
  std::uint64_t serial = 0;
  std::memcpy(&serial, payload.data() + bytes.serial, kOusterSerialBytes);
  const std::uint64_t stated = sensor.model.packets->serial;
  if (serial == 0 || stated == 0 || serial == stated) return std::nullopt;
  return "have the serial number " + std::to_string(serial) + ", but " + sensor.model.name +
         " is of " + std::to_string(stated) + " (prod_sn)";
}

/// How the columns between the first and the last of a packet contradict the mode: their times and,
/// in profile LEGACY, the encoder.
std::optional<std::string> contradiction_of_mode(const PacketSensor& sensor,
                                                 const ColumnHead& first, const ColumnHead& last) {
  constexpr double kFar = 1.4;  // modes differ by a factor of 2
  const LidarModel& model = sensor.model;
  const double steps = static_cast<double>(last.step) - first.step;
  if (!(steps > 0)) return std::nullopt;
  const auto is_off = [](double found, double expected) {
    return found * kFar < expected || found > kFar * expected;
  };
  if (sensor.format == PacketFormat::ouster_legacy) {
    const double ticks = (last.ticks + kEncoderTicks - first.ticks) % kEncoderTicks / steps;
    if (is_off(ticks, static_cast<double>(kEncoderTicks) / model.columns))
      return "have " + std::to_string(std::lround(ticks)) +
             " encoder counts per column, but mode " + mode_of(model) + " of " + model.name +
             " has " + std::to_string(kEncoderTicks / model.columns);
  }
  const double column_us = 1e-3 * static_cast<double>(last.time_ns - first.time_ns) / steps;
  if (!is_off(column_us, 1e6 * sensor.column_s())) return std::nullopt;
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f us per column, but mode %s of ", column_us,
                mode_of(model).c_str());
  return "take " + (text.data() + model.name) + " takes " +
         std::to_string(std::lround(1e6 * sensor.column_s()));
}

std::optional<std::string> OusterParser::contradiction(const PacketSensor& sensor,
                                                       std::string_view payload) const {
  if (auto found = contradiction_of_head(sensor, payload)) return found;
  const bool is_legacy = sensor.format == PacketFormat::ouster_legacy;
  std::optional<ColumnHead> first, last;
  const OusterBytes bytes = bytes_of(sensor);
  for (std::size_t k = 0; const MeasuredColumn& column : columns(sensor, payload)) {
    const std::size_t ticks_at = bytes.column_at(k++) + 12;
    if (!column.is_valid) continue;
    if (column.step >= sensor.model.columns)
      return "have a column " + std::to_string(column.step) + ", but mode " +
             mode_of(sensor.model) + " of " + sensor.model.name + " has " +
             std::to_string(sensor.model.columns);
    last = ColumnHead{column.step, column.time_ns,
                      is_legacy ? value_at<std::uint32_t>(payload, ticks_at) : 0};
    if (!first) first = last;
  }
  if (!first) return std::nullopt;
  return contradiction_of_mode(sensor, *first, *last);
}

std::vector<MeasuredColumn> OusterParser::columns(const PacketSensor& sensor,
                                                  std::string_view payload) const {
  const OusterBytes bytes = bytes_of(sensor);
  const LidarModel& model = sensor.model;
  std::vector<MeasuredColumn> columns;
  for (std::size_t k = 0; k < bytes.columns; ++k) {
    const std::size_t head = bytes.column_at(k);
    MeasuredColumn column;
    column.time_ns = value_at<std::int64_t>(payload, head);
    column.step = value_at<std::uint16_t>(payload, head + 8);
    column.head_rad =
        model.first_azimuth_rad - kWholeTurn_rad * column.step / static_cast<double>(model.columns);
    if (sensor.format == PacketFormat::ouster_legacy) {
      column.frame = value_at<std::uint16_t>(payload, head + 10);
      column.is_valid = value_at<std::uint32_t>(
                            payload, head + bytes.column() - bytes.column_foot) == kOusterValid;
    } else {
      column.frame = bytes.frame_bytes == 4 ? value_at<std::uint32_t>(payload, bytes.frame)
                                            : value_at<std::uint16_t>(payload, bytes.frame);
      column.is_valid = (value_at<std::uint16_t>(payload, head + 10) & 1U) != 0;
    }
    columns.push_back(column);
  }
  return columns;
}

LaserReturns OusterParser::returns_at(const PacketSensor& sensor, std::string_view payload,
                                      std::size_t k, std::size_t laser) const {
  const OusterBytes bytes = bytes_of(sensor);
  const OusterChannel& channel = bytes.channel;
  const std::size_t byte = bytes.column_at(k) + bytes.column_head + laser * channel.bytes;
  const auto return_at = [&](std::size_t at) -> PacketReturn {
    const std::uint32_t counts = value_at<std::uint32_t>(payload, at) & sensor.facts.max_counts;
    if (sensor.format == PacketFormat::ouster_legacy)
      return {counts, value_at<std::uint16_t>(payload, at + channel.reflectivity)};
    return {counts, value_at<std::uint8_t>(payload, at + channel.reflectivity)};
  };
  LaserReturns returns;
  add_return(returns, return_at(byte));
  if (channel.is_dual) add_return(returns, return_at(byte + 4));
  return returns;
}

}  // namespace

const PacketParser& ouster_parser() {
  static constexpr OusterParser kOuster;
  return kOuster;
}

}  // namespace adasplats
