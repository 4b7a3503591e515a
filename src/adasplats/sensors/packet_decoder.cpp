// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/packet_decoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <utility>

#include "adasplats/core/words.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/packet_bytes.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "packets are little-endian");

constexpr std::size_t kVelodyneTail = kVelodyneBlocks * kBlockBytes;
constexpr double kWholeTurn_rad = 2.0 * std::numbers::pi;
constexpr double kNanosecondsInOne_s = 1e9;

template <class T>
T value_at(std::string_view bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

std::uint16_t azimuth_of_block(std::string_view payload, std::size_t block) {
  return value_at<std::uint16_t>(payload, block * kBlockBytes + 2);
}

std::string hexadecimal(unsigned value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%02X", value);
  return text.data();
}

/// Blocks that one firing of all lasers takes; 1 where a block has several.
std::size_t blocks_of_firing(std::size_t lasers) {
  return std::max<std::size_t>(1, lasers / kBlockChannels);
}

/// The factory bytes of sensors other than the HDL-64E: the mode of returns, and the model.
std::optional<std::string> objection_to_factory(PacketFormat format, std::string_view payload) {
  constexpr std::uint8_t kStrongest = 0x37, kLast = 0x38;
  constexpr std::pair<PacketFormat, std::uint8_t> kModels[] = {{PacketFormat::hdl_32e, 0x21},
                                                               {PacketFormat::vlp_16, 0x22},
                                                               {PacketFormat::vlp_32c, 0x28},
                                                               {PacketFormat::vls_128, 0xA1}};
  const auto mode = value_at<std::uint8_t>(payload, kVelodyneTail + 4);
  const auto model = value_at<std::uint8_t>(payload, kVelodyneTail + 5);
  for (const auto& [other, code] : kModels)
    if (code == model && other != format)
      return "are of model " + hexadecimal(model) + ", " +
             std::string(word_of(other, kPacketFormats));
  // Sensors of before there were several modes say 0.
  if (mode != kStrongest && mode != kLast && mode != 0)
    return "have mode " + hexadecimal(mode) +
           " of returns, expected strongest (0x37) or last (0x38); two returns a firing are not "
           "read";
  return std::nullopt;
}

}  // namespace

std::uint32_t PacketDecoder::steps_per_turn() const {
  return is_ouster(sensor_.format) ? sensor_.model.columns : std::uint32_t{kAzimuthSteps};
}

std::optional<std::string> PacketDecoder::objection(std::string_view payload) const {
  if (is_ouster(sensor_.format)) {
    constexpr std::uint64_t kLongest_ns = 1'000'000'000, kLatest_ns = std::uint64_t{1} << 62U;
    const OusterBytes bytes(sensor_.format, sensor_.lasers());
    const auto first_ns = value_at<std::uint64_t>(payload, bytes.head);
    for (std::size_t k = 0; k < OusterBytes::kColumns; ++k) {
      const auto id = value_at<std::uint16_t>(payload, bytes.head + k * bytes.column() + 8);
      const auto time_ns = value_at<std::uint64_t>(payload, bytes.head + k * bytes.column());
      if (time_ns > kLatest_ns || (time_ns != 0 && time_ns + kLongest_ns < first_ns) ||
          time_ns > first_ns + kLongest_ns)
        return "have columns that are not of one time";
      if (id >= sensor_.model.columns)
        return "have a column " + std::to_string(id) + " of a revolution of " +
               std::to_string(sensor_.model.columns);
    }
    return std::nullopt;
  }
  const std::size_t blocks = blocks_of_firing(sensor_.lasers());
  for (std::size_t block = 0; block < kVelodyneBlocks; ++block) {
    const auto flag = value_at<std::uint16_t>(payload, block * kBlockBytes);
    if (flag != kBlockFlags[block % blocks])
      return "begin their block " + std::to_string(block) + " with " + hexadecimal(flag) +
             ", expected " + hexadecimal(kBlockFlags[block % blocks]);
    if (azimuth_of_block(payload, block) >= kAzimuthSteps)
      return "have an azimuth of " + std::to_string(azimuth_of_block(payload, block)) +
             " hundredths of a degree";
  }
  if (sensor_.format != PacketFormat::hdl_64e) return objection_to_factory(sensor_.format, payload);
  bool is_dual = true;
  for (std::size_t block = 0; block < kVelodyneBlocks; block += 4)
    is_dual = is_dual && azimuth_of_block(payload, block) == azimuth_of_block(payload, block + 2);
  if (is_dual) return "have each azimuth twice: two returns a firing are not read";
  return std::nullopt;
}

std::vector<MeasuredColumn> PacketDecoder::columns(std::string_view payload) const {
  return is_ouster(sensor_.format) ? ouster_columns(payload) : velodyne_columns(payload);
}

std::vector<MeasuredColumn> PacketDecoder::velodyne_columns(std::string_view payload) const {
  const std::size_t lasers = sensor_.lasers(), apart = blocks_of_firing(lasers);
  const std::size_t firings_of_block = std::max<std::size_t>(1, kBlockChannels / lasers);
  const double first_steps = -sensor_.model.first_azimuth_rad / kWholeTurn_rad * kAzimuthSteps;
  const auto micros = value_at<std::uint32_t>(payload, kVelodyneTail);
  std::vector<MeasuredColumn> columns;
  std::uint32_t turned = 0;  // in steps, from one block to the next; the last one as the one before
  for (std::size_t block = 0; block < kVelodyneBlocks; block += apart) {
    const std::uint32_t azimuth = azimuth_of_block(payload, block);
    if (block + apart < kVelodyneBlocks)
      turned = (azimuth_of_block(payload, block + apart) + kAzimuthSteps - azimuth) % kAzimuthSteps;
    for (std::size_t part = 0; part < firings_of_block; ++part) {
      const double per_firing = static_cast<double>(turned) / static_cast<double>(firings_of_block);
      const double steps = azimuth + static_cast<double>(part) * per_firing;
      // What is 0 but for rounding is 0, and not the end of the revolution before.
      double since_begin = std::fmod(steps - first_steps + 1e-6, kAzimuthSteps);
      if (since_begin < 0) since_begin += kAzimuthSteps;
      MeasuredColumn column;
      column.time_ns =
          std::int64_t{micros} * 1000 - stamp_after_first_ns(sensor_.format) +
          std::llround(static_cast<double>(columns.size()) * column_s() * kNanosecondsInOne_s);
      column.head_rad = -steps / kAzimuthSteps * kWholeTurn_rad;
      column.turn_rad_s = -per_firing / kAzimuthSteps * kWholeTurn_rad / column_s();
      column.step = static_cast<std::uint32_t>(since_begin);
      columns.push_back(column);
    }
  }
  return columns;
}

std::vector<MeasuredColumn> PacketDecoder::ouster_columns(std::string_view payload) const {
  const OusterBytes bytes(sensor_.format, sensor_.lasers());
  const LidarModel& model = sensor_.model;
  std::vector<MeasuredColumn> columns;
  for (std::size_t k = 0; k < OusterBytes::kColumns; ++k) {
    const std::size_t head = bytes.head + k * bytes.column();
    MeasuredColumn column;
    column.time_ns = value_at<std::int64_t>(payload, head);
    column.step = value_at<std::uint16_t>(payload, head + 8);
    column.head_rad =
        model.first_azimuth_rad - kWholeTurn_rad * column.step / static_cast<double>(model.columns);
    if (sensor_.format == PacketFormat::ouster_legacy) {
      column.frame = value_at<std::uint16_t>(payload, head + 10);
      column.is_valid = value_at<std::uint32_t>(
                            payload, head + bytes.column() - bytes.column_foot) == kOusterValid;
    } else {
      column.frame = value_at<std::uint16_t>(payload, 2);
      column.is_valid = (value_at<std::uint16_t>(payload, head + 10) & 1U) != 0;
    }
    columns.push_back(column);
  }
  return columns;
}

PacketReturn PacketDecoder::return_at(std::string_view payload, std::size_t k,
                                      std::size_t laser) const {
  if (!is_ouster(sensor_.format)) {
    const std::size_t place = VelodynePlace(sensor_.lasers(), k, laser).byte();
    return {value_at<std::uint16_t>(payload, place), value_at<std::uint8_t>(payload, place + 2)};
  }
  const OusterBytes bytes(sensor_.format, sensor_.lasers());
  const std::size_t place =
      bytes.head + k * bytes.column() + bytes.column_head + laser * OusterBytes::kChannel;
  const std::uint32_t counts = value_at<std::uint32_t>(payload, place) & sensor_.facts.most;
  if (sensor_.format == PacketFormat::ouster_single)
    return {counts, value_at<std::uint8_t>(payload, place + 4)};
  return {counts, value_at<std::uint16_t>(payload, place + 4)};
}

bool PacketDecoder::has_returns(std::string_view payload, std::size_t k) const {
  for (std::size_t laser = 0; laser < sensor_.lasers(); ++laser)
    if (return_at(payload, k, laser).counts != 0) return true;
  return false;
}

void PacketDecoder::add_points(std::string_view payload, std::size_t k,
                               const MeasuredColumn& column, PacketPoints& points) const {
  const LidarModel& model = sensor_.model;
  for (std::size_t laser = 0; laser < sensor_.lasers(); ++laser) {
    const PacketReturn found = return_at(payload, k, laser);
    if (found.counts == 0) continue;
    const std::size_t ring = sensor_.ring_of_laser[laser];
    const double late_s = model.firing_times_s.empty() ? 0.0 : model.firing_times_s[ring];
    const Firing firing = firing_at(model, ring, column.head_rad + column.turn_rad_s * late_s);
    const double range_m = found.counts * sensor_.facts.quantum_m + sensor_.range_offsets_m[ring];
    points.positions.push_back(vec_cast<double>(firing.origin) +
                               range_m * vec_cast<double>(firing.direction));
    points.late_s.push_back(late_s);
    points.intensities.push_back(found.intensity);
    points.rings.push_back(firing.ring);
  }
}

}  // namespace adasplats
