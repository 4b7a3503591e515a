// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/packet_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <numbers>
#include <stdexcept>

#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/sensors/hesai_bytes.h"
#include "adasplats/sensors/packet_bytes.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kNanosecondsPerMicrosecond = 1000;
constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::uint32_t kWrittenUnit_mm = 4;  // of Hesai's ranges

template <class T>
void put_at(std::string& packet, std::size_t byte, T value) {
  std::memcpy(packet.data() + byte, &value, sizeof value);
}

/// The head's azimuth at the start of a column, clockwise from `zero` before the sensor's x axis
/// (forward), in steps of 0.01 degrees; `zero` is a fraction of a turn.
std::uint16_t azimuth_steps(const LidarModel& model, std::uint32_t column, double zero = 0) {
  const double turn = 2.0 * std::numbers::pi;
  const double ahead = zero - model.first_azimuth_rad / turn;
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

std::tm utc_of(std::uint64_t time_ns) {
  const auto seconds = static_cast<std::time_t>(time_ns / kNanosecondsPerSecond);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return utc;
}

/// An HDL-64E cycles through status values, one per packet: a letter and its value (manual, "status
/// byte"): time and date (UTC), GPS (0: none), temperature (degrees), firmware.
std::pair<std::uint8_t, std::uint8_t> status_bytes(std::uint64_t time_ns, std::uint64_t index) {
  const std::tm utc = utc_of(time_ns);
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
    if (sensor.model.fires_in(column.column))
      put_at(packet, head + bytes.column() - bytes.column_foot, kOusterValid);
  }
  return packet;
}

bool is_written(PacketFormat format) {
  if (is_hesai(format)) return format != PacketFormat::qt_128 && format != PacketFormat::at_128;
  return format <= PacketFormat::ouster_legacy;
}

/// Without optional fields but an OT128's flags; the header of models without one is empty.
std::string hesai_head(const HesaiLayout& layout) {
  const auto lasers = static_cast<char>(layout.lasers), blocks = static_cast<char>(layout.blocks);
  const auto unit = static_cast<char>(kWrittenUnit_mm);
  std::string head("\xEE\xFF");
  if (layout.head == 0) return {};
  if (layout.major == 0) return head + lasers + blocks + '\0' + unit + std::string(2, '\0');
  constexpr char kFirstReturn = 1, kReturns = 1;
  head += {static_cast<char>(layout.major), static_cast<char>(layout.minor), '\0', '\0'};
  return head + lasers + blocks + kFirstReturn + unit + kReturns + '\0';
}

void put_hesai_block(std::string& packet, std::size_t at, const HesaiLayout& layout,
                     std::size_t unit, std::uint16_t azimuth,
                     std::span<const PacketReturn> returns) {
  if (layout.head == 0) put_at(packet, at, kBlockStart);
  put_at(packet, at + layout.block_head - 2, azimuth);
  for (std::size_t laser = 0; laser < returns.size(); ++laser) {
    const std::size_t place = at + layout.block_head + laser * unit;
    put_at(packet, place, static_cast<std::uint16_t>(returns[laser].counts));
    put_at(packet, place + 2,
           static_cast<std::uint8_t>(std::lround(returns[laser].intensity / 257.0)));
  }
}

/// Time, speed and mode. Years count from 1900; in a Pandar40P and 64 from 2000, which cannot hold
/// earlier ones.
void put_hesai_tail(std::string& packet, std::size_t at, const HesaiLayout& layout,
                    std::uint64_t time_us, double rotation_hz) {
  constexpr std::uint8_t kStrongest = 0x37;
  constexpr int kYear2000 = 100;
  const std::tm utc = utc_of(time_us * kNanosecondsPerMicrosecond);
  const bool counts_from_2000 = layout.major == 0 && utc.tm_year >= kYear2000;
  const int date[] = {utc.tm_year - (counts_from_2000 ? kYear2000 : 0),
                      utc.tm_mon + 1,
                      utc.tm_mday,
                      utc.tm_hour,
                      utc.tm_min,
                      utc.tm_sec};
  const HesaiTail& tail = layout.tail;
  for (std::size_t i = 0; i < std::size(date); ++i)
    put_at(packet, at + tail.date + i, static_cast<std::uint8_t>(date[i]));
  put_at(packet, at + tail.micros, static_cast<std::uint32_t>(time_us % 1'000'000));
  put_at(packet, at + tail.speed, static_cast<std::uint16_t>(std::lround(60 * rotation_hz)));
  put_at(packet, at + tail.mode, kStrongest);
}

std::string hesai_packet(const PacketSensor& sensor, std::span<const PacketColumn> columns) {
  const HesaiLayout& layout = layout_of(sensor.format);
  const HesaiBytes bytes(layout, 0U);
  std::string packet = hesai_head(layout);
  packet.resize(bytes.packet);
  // Azimuths are those of the block's time and start a quarter of a turn before the x axis.
  const double shot_s = static_cast<double>(layout.first_shot_ns) / kNanosecondsInOne_s;
  const double zero = 0.25 - sensor.model.rotation_hz * shot_s;
  for (std::size_t k = 0; k < columns.size(); ++k)
    put_hesai_block(packet, layout.head + k * bytes.block, layout, bytes.unit,
                    azimuth_steps(sensor.model, columns[k].column, zero), columns[k].returns);
  const std::size_t stamped = layout.counts_on ? 0 : columns.size() - 1;
  const std::int64_t time_ns = static_cast<std::int64_t>(columns.front().time_ns) +
                               static_cast<std::int64_t>(stamped) * layout.step_ns -
                               layout.block_ns - layout.first_shot_ns;
  put_hesai_tail(packet, bytes.tail, layout,
                 static_cast<std::uint64_t>(std::max<std::int64_t>(time_ns + 500, 0)) /
                     kNanosecondsPerMicrosecond,
                 sensor.model.rotation_hz);
  if (layout.format == PacketFormat::ot_128) {
    // The azimuth state of a block: 0 in even columns, 1 in odd ones.
    const unsigned first = columns[0].column % 2;
    put_at(packet, bytes.tail + kAzimuthFlagByte,
           static_cast<std::uint16_t>(first << 14U | (1U - first) << 12U));
  }
  if (!layout.has_checksums()) return packet;
  const std::string_view all = packet;
  put_at(packet, layout.head + bytes.body, hesai_checksum(all.substr(layout.head, bytes.body)));
  put_at(packet, bytes.end, hesai_checksum(all.substr(bytes.tail, bytes.end - bytes.tail)));
  return packet;
}

}  // namespace

PacketSensor written_sensor(const LidarModel& model) {
  PacketSensor sensor = packet_sensor(model);
  if (!is_written(sensor.format)) {
    std::string written;
    for (const auto& [word, format] : kPacketFormats)
      if (is_written(format)) written += (written.empty() ? "" : ", ") + std::string(word);
    throw Error(ErrorKind::usage, "cannot write packets of sensor '" + model.name + "': packets " +
                                      std::string(word_of(sensor.format, kPacketFormats)) +
                                      " are only read; those that are written: " + written);
  }
  if (!is_hesai(sensor.format)) return sensor;
  sensor.facts.columns = layout_of(sensor.format).blocks;
  sensor.facts.quantum_m *= kWrittenUnit_mm;
  sensor.facts.max_counts = UINT16_MAX;
  return sensor;
}

double written_column_s(PacketFormat format) {
  return static_cast<double>(layout_of(format).step_ns) / kNanosecondsInOne_s;
}

std::string encode_packet(const PacketSensor& sensor, std::span<const PacketColumn> columns,
                          std::uint64_t packet_index) {
  if (columns.size() != sensor.facts.columns || !is_written(sensor.format))
    throw std::logic_error("encode_packet: wrong number of columns, or a format that is read only");
  if (is_hesai(sensor.format)) return hesai_packet(sensor, columns);
  return is_ouster(sensor.format) ? ouster_packet(sensor, columns)
                                  : velodyne_packet(sensor, columns, packet_index);
}

}  // namespace adasplats
