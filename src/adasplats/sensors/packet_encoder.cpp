// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/packet_encoder.h"

#include <cmath>
#include <cstring>
#include <ctime>
#include <numbers>
#include <stdexcept>

#include "adasplats/sensors/packet_bytes.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kNanosecondsPerMicrosecond = 1000;
constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;

template <class T>
void put_at(std::string& packet, std::size_t byte, T value) {
  std::memcpy(packet.data() + byte, &value, sizeof value);
}

/// Clockwise from the sensor's x axis (forward), in steps of 0.01 degrees.
std::uint16_t azimuth_steps(const LidarModel& model, std::uint32_t column) {
  const double turn = 2.0 * std::numbers::pi;
  const double ahead = -model.first_azimuth_rad / turn;
  const double share = ahead + static_cast<double>(column) / model.columns;
  const auto steps = std::llround((share - std::floor(share)) * kAzimuthSteps);
  return static_cast<std::uint16_t>(steps % kAzimuthSteps);
}

/// Return mode (strongest) and model as in the manuals.
std::pair<std::uint8_t, std::uint8_t> factory_bytes(PacketFormat format) {
  constexpr std::uint8_t kStrongest = 0x37;
  switch (format) {
    case PacketFormat::hdl_32e: return {kStrongest, 0x21};
    case PacketFormat::vlp_16: return {kStrongest, 0x22};
    case PacketFormat::vlp_32c: return {kStrongest, 0x28};
    case PacketFormat::vls_128: return {kStrongest, 0xA1};
    default: break;
  }
  throw std::logic_error("factory_bytes: a format without factory bytes");
}

/// An HDL-64E cycles through status values, one per packet: a letter and its value (manual, "status
/// byte"): time and date (UTC), GPS (0: none), temperature (degrees), firmware.
std::pair<std::uint8_t, std::uint8_t> status_bytes(std::uint64_t time_ns, std::uint64_t index) {
  const auto seconds = static_cast<std::time_t>(time_ns / kNanosecondsPerSecond);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  constexpr int kDegrees = 25, kFirmware = 0x47;
  const std::pair<char, int> all[] = {
      {'H', utc.tm_hour}, {'M', utc.tm_min},     {'S', utc.tm_sec},
      {'D', utc.tm_mday}, {'N', utc.tm_mon + 1}, {'Y', utc.tm_year % 100},
      {'G', 0},           {'T', kDegrees},       {'V', kFirmware}};
  const auto& [letter, value] = all[index % std::size(all)];
  return {static_cast<std::uint8_t>(letter), static_cast<std::uint8_t>(value)};
}

std::string velodyne_packet(const PacketSensor& sensor, std::span<const PacketColumn> columns,
                            std::uint64_t index) {
  std::string packet(kVelodyneBytes, '\0');
  const std::size_t lasers = sensor.lasers();
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      const VelodyneSlot slot(lasers, k, laser);
      if (slot.channel == 0) {
        const std::size_t head = slot.block * kBlockBytes;
        put_at(packet, head, kBlockFlags[laser / kBlockChannels]);
        put_at(packet, head + 2, azimuth_steps(sensor.model, columns[k].column));
      }
      const PacketReturn& found = columns[k].returns[laser];
      put_at(packet, slot.byte(), static_cast<std::uint16_t>(found.counts));
      put_at(packet, slot.byte() + 2,
             static_cast<std::uint8_t>(std::lround(found.intensity / 257.0)));
    }
  const std::uint64_t time_ns =
      columns.front().time_ns + static_cast<std::uint64_t>(stamp_after_first_ns(sensor.format));
  constexpr std::size_t kTail = kVelodyneBlocks * kBlockBytes;
  put_at(packet, kTail,
         static_cast<std::uint32_t>(time_ns / kNanosecondsPerMicrosecond % kMicrosecondsPerHour));
  const auto [first, second] = sensor.format == PacketFormat::hdl_64e
                                   ? status_bytes(time_ns, index)
                                   : factory_bytes(sensor.format);
  put_at(packet, kTail + 4, first);
  put_at(packet, kTail + 5, second);
  return packet;
}

std::string ouster_packet(const PacketSensor& sensor, std::span<const PacketColumn> columns) {
  const OusterBytes bytes(sensor.format, sensor.lasers(), sensor.facts.columns, false);
  std::string packet(bytes.packet(), '\0');
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const PacketColumn& column = columns[k];
    const std::size_t head = k * bytes.column();
    put_at(packet, head, column.time_ns);
    put_at(packet, head + 8, static_cast<std::uint16_t>(column.column));
    put_at(packet, head + 10, column.frame);
    put_at(packet, head + 12, column.column * (kEncoderTicks / sensor.model.columns));
    for (std::size_t laser = 0; laser < sensor.lasers(); ++laser) {
      const std::size_t byte = head + bytes.column_head + laser * bytes.channel.bytes;
      const PacketReturn& found = column.returns[laser];
      put_at(packet, byte, found.counts);
      put_at(packet, byte + 4, static_cast<std::uint16_t>(std::lround(found.intensity / 257.0)));
      put_at(packet, byte + 6, found.intensity);
    }
    put_at(packet, head + bytes.column() - bytes.column_foot, kOusterValid);
  }
  return packet;
}

}  // namespace

std::string encode_packet(const PacketSensor& sensor, std::span<const PacketColumn> columns,
                          std::uint64_t packet_index) {
  if (columns.size() != sensor.facts.columns || sensor.format > PacketFormat::ouster_legacy)
    throw std::logic_error("encode_packet: wrong number of columns, or a format that is read only");
  return is_ouster(sensor.format) ? ouster_packet(sensor, columns)
                                  : velodyne_packet(sensor, columns, packet_index);
}

}  // namespace adasplats
