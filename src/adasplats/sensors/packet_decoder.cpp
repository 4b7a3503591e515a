// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/packet_decoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adasplats/core/words.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/packet_bytes.h"
#include "adasplats/sensors/packet_parser.h"

namespace adasplats {
namespace {

constexpr std::size_t kVelodyneTail = kVelodyneBlocks * kBlockBytes;

std::uint16_t azimuth_of_block(std::string_view payload, std::size_t block) {
  return value_at<std::uint16_t>(payload, block * kBlockBytes + 2);
}

/// The number of blocks per firing of all lasers; 1 if a block holds several firings.
std::size_t blocks_of_firing(std::size_t lasers) {
  return std::max<std::size_t>(1, lasers / kBlockChannels);
}

/// Checks the factory bytes of sensors other than the HDL-64E: return mode and model.
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
      return "are from model " + hexadecimal(model) + ", " +
             std::string(word_of(other, kPacketFormats));
  // Sensors that predate return modes send 0.
  if (mode != kStrongest && mode != kLast && mode != kDualMode && mode != 0)
    return "have mode " + hexadecimal(mode) +
           " of returns, expected strongest (0x37), last (0x38) or both (0x39)";
  return std::nullopt;
}

/// Maps the blocks of a packet with one return to those of a packet with one or two.
struct VelodyneBlocks {
  PacketFormat format;
  bool is_dual;

  /// The number of blocks of a packet with one return that hold the same firings.
  std::size_t count() const { return is_dual ? kVelodyneBlocks / 2 : kVelodyneBlocks; }
  /// The block with the last return, or with the only one.
  std::size_t first(std::size_t block) const {
    return is_dual ? dual_blocks(format, block).first : block;
  }
  std::size_t second(std::size_t block) const { return dual_blocks(format, block).second; }
};

PacketReturn velodyne_return(std::string_view payload, std::size_t block, std::size_t channel) {
  const std::size_t byte = channel_byte(block, channel);
  return {value_at<std::uint16_t>(payload, byte), value_at<std::uint8_t>(payload, byte + 2)};
}

class VelodyneParser final : public PacketParser {
 public:
  PacketTraits traits(const PacketSensor& sensor) const override {
    return {.is_hourly = true, .has_cut = sensor.model.first_azimuth_rad != 0};
  }
  std::uint32_t steps_per_turn(const PacketSensor& /*sensor*/) const override {
    return kAzimuthSteps;
  }
  std::optional<std::string> objection(const PacketSensor& sensor,
                                       std::string_view payload) const override;
  bool is_dual(const PacketSensor& sensor, std::string_view payload) const override;
  std::vector<MeasuredColumn> columns(const PacketSensor& sensor,
                                      std::string_view payload) const override;
  LaserReturns returns_at(const PacketSensor& sensor, std::string_view payload, std::size_t k,
                          std::size_t laser) const override;
};

class OusterParser final : public PacketParser {
 public:
  PacketTraits traits(const PacketSensor& /*sensor*/) const override {
    return {.has_frames = true, .has_cut = true};
  }
  std::uint32_t steps_per_turn(const PacketSensor& sensor) const override {
    return sensor.model.columns;
  }
  std::optional<std::string> objection(const PacketSensor& sensor,
                                       std::string_view payload) const override;
  bool is_dual(const PacketSensor& sensor, std::string_view /*payload*/) const override {
    return sensor.format == PacketFormat::ouster_dual;
  }
  std::vector<MeasuredColumn> columns(const PacketSensor& sensor,
                                      std::string_view payload) const override;
  LaserReturns returns_at(const PacketSensor& sensor, std::string_view payload, std::size_t k,
                          std::size_t laser) const override;
};

std::optional<std::string> VelodyneParser::objection(const PacketSensor& sensor,
                                                     std::string_view payload) const {
  const VelodyneBlocks blocks{sensor.format, is_dual(sensor, payload)};
  const std::size_t of_firing = blocks_of_firing(sensor.lasers());
  const auto check = [&](std::size_t block, std::size_t flag_of) -> std::optional<std::string> {
    const auto flag = value_at<std::uint16_t>(payload, block * kBlockBytes);
    if (flag != kBlockFlags[flag_of])
      return "begin their block " + std::to_string(block) + " with " + hexadecimal(flag) +
             ", expected " + hexadecimal(kBlockFlags[flag_of]);
    if (azimuth_of_block(payload, block) >= kAzimuthSteps)
      return "have an azimuth of " + std::to_string(azimuth_of_block(payload, block)) +
             " hundredths of a degree";
    return std::nullopt;
  };
  for (std::size_t block = 0; block < blocks.count() / of_firing * of_firing; ++block) {
    const std::size_t first = blocks.first(block), flag_of = block % of_firing;
    if (auto objection = check(first, flag_of)) return objection;
    if (!blocks.is_dual) continue;
    const std::size_t second = blocks.second(block);
    if (auto objection = check(second, flag_of)) return objection;
    if (azimuth_of_block(payload, first) != azimuth_of_block(payload, second))
      return "have two returns per firing, but different azimuths in blocks " +
             std::to_string(first) + " and " + std::to_string(second);
  }
  if (sensor.format == PacketFormat::hdl_64e) return std::nullopt;
  return objection_to_factory(sensor.format, payload);
}

bool VelodyneParser::is_dual(const PacketSensor& sensor, std::string_view payload) const {
  if (sensor.format != PacketFormat::hdl_64e)
    return value_at<std::uint8_t>(payload, kVelodyneTail + 4) == kDualMode;
  // A head that does not rotate repeats its azimuth in either mode: treated as single.
  bool is_dual = azimuth_of_block(payload, 0) != azimuth_of_block(payload, 4);
  for (std::size_t block = 0; block < kVelodyneBlocks; block += 4)
    is_dual = is_dual && azimuth_of_block(payload, block) == azimuth_of_block(payload, block + 2);
  return is_dual;
}

std::vector<MeasuredColumn> VelodyneParser::columns(const PacketSensor& sensor,
                                                    std::string_view payload) const {
  const std::size_t lasers = sensor.lasers(), apart = blocks_of_firing(lasers);
  const std::size_t firings_of_block = std::max<std::size_t>(1, kBlockChannels / lasers);
  const VelodyneBlocks blocks{sensor.format, is_dual(sensor, payload)};
  const auto azimuth_at = [&](std::size_t block) {
    return std::uint32_t{azimuth_of_block(payload, blocks.first(block))};
  };
  const double first_steps = -sensor.model.first_azimuth_rad / kWholeTurn_rad * kAzimuthSteps;
  const auto micros = value_at<std::uint32_t>(payload, kVelodyneTail);
  std::vector<MeasuredColumn> columns;
  // Steps between blocks; the last block repeats the value of the previous one.
  double turned = static_cast<double>(kAzimuthSteps) / sensor.model.columns *
                  static_cast<double>(firings_of_block);
  for (std::size_t block = 0; block + apart <= blocks.count(); block += apart) {
    const std::uint32_t azimuth = azimuth_at(block);
    if (block + 2 * apart <= blocks.count())
      turned = (azimuth_at(block + apart) + kAzimuthSteps - azimuth) % kAzimuthSteps;
    for (std::size_t part = 0; part < firings_of_block; ++part) {
      const double per_firing = turned / static_cast<double>(firings_of_block);
      const double steps = azimuth + static_cast<double>(part) * per_firing;
      // Rounding must not move step 0 to the end of the previous revolution.
      double since_begin = std::fmod(steps - first_steps + 1e-6, kAzimuthSteps);
      if (since_begin < 0) since_begin += kAzimuthSteps;
      MeasuredColumn column;
      column.time_ns = std::int64_t{micros} * 1000 - stamp_after_first_ns(sensor.format) +
                       std::llround(static_cast<double>(columns.size()) * sensor.column_s() *
                                    kNanosecondsInOne_s);
      column.head_rad = -steps / kAzimuthSteps * kWholeTurn_rad;
      column.turn_rad_s = -per_firing / kAzimuthSteps * kWholeTurn_rad / sensor.column_s();
      column.step = static_cast<std::uint32_t>(since_begin);
      columns.push_back(column);
    }
  }
  return columns;
}

LaserReturns VelodyneParser::returns_at(const PacketSensor& sensor, std::string_view payload,
                                        std::size_t k, std::size_t laser) const {
  LaserReturns returns;
  const VelodyneBlocks blocks{sensor.format, is_dual(sensor, payload)};
  const VelodyneSlot slot(sensor.lasers(), k, laser);
  add_return(returns, velodyne_return(payload, blocks.first(slot.block), slot.channel));
  if (blocks.is_dual)
    add_return(returns, velodyne_return(payload, blocks.second(slot.block), slot.channel));
  return returns;
}

std::optional<std::string> OusterParser::objection(const PacketSensor& sensor,
                                                   std::string_view payload) const {
  constexpr std::uint64_t kLongest_ns = 1'000'000'000, kLatest_ns = std::uint64_t{1} << 62U;
  const OusterBytes bytes(sensor.format, sensor.lasers());
  const auto first_ns = value_at<std::uint64_t>(payload, bytes.head);
  for (std::size_t k = 0; k < OusterBytes::kColumns; ++k) {
    const auto id = value_at<std::uint16_t>(payload, bytes.head + k * bytes.column() + 8);
    const auto time_ns = value_at<std::uint64_t>(payload, bytes.head + k * bytes.column());
    if (time_ns > kLatest_ns || (time_ns != 0 && time_ns + kLongest_ns < first_ns) ||
        time_ns > first_ns + kLongest_ns)
      return "have columns with times more than 1 s apart";
    if (id >= sensor.model.columns)
      return "have a column " + std::to_string(id) + ", but a revolution has " +
             std::to_string(sensor.model.columns);
  }
  return std::nullopt;
}

std::vector<MeasuredColumn> OusterParser::columns(const PacketSensor& sensor,
                                                  std::string_view payload) const {
  const OusterBytes bytes(sensor.format, sensor.lasers());
  const LidarModel& model = sensor.model;
  std::vector<MeasuredColumn> columns;
  for (std::size_t k = 0; k < OusterBytes::kColumns; ++k) {
    const std::size_t head = bytes.head + k * bytes.column();
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
      column.frame = value_at<std::uint16_t>(payload, 2);
      column.is_valid = (value_at<std::uint16_t>(payload, head + 10) & 1U) != 0;
    }
    columns.push_back(column);
  }
  return columns;
}

LaserReturns OusterParser::returns_at(const PacketSensor& sensor, std::string_view payload,
                                      std::size_t k, std::size_t laser) const {
  const OusterBytes bytes(sensor.format, sensor.lasers());
  const std::size_t byte =
      bytes.head + k * bytes.column() + bytes.column_head + laser * bytes.channel;
  const auto counts_at = [&](std::size_t at) {
    return value_at<std::uint32_t>(payload, at) & sensor.facts.max_counts;
  };
  LaserReturns returns;
  if (sensor.format == PacketFormat::ouster_legacy) {
    add_return(returns, {counts_at(byte), value_at<std::uint16_t>(payload, byte + 4)});
  } else if (sensor.format == PacketFormat::ouster_single) {
    add_return(returns, {counts_at(byte), value_at<std::uint8_t>(payload, byte + 4)});
  } else {
    // Each return: 19 bits of range, flags, a byte of reflectivity.
    add_return(returns, {counts_at(byte), value_at<std::uint8_t>(payload, byte + 3)});
    add_return(returns, {counts_at(byte + 4), value_at<std::uint8_t>(payload, byte + 7)});
  }
  return returns;
}

const PacketParser& parser_of(PacketFormat format) {
  static constexpr VelodyneParser kVelodyne;
  static constexpr OusterParser kOuster;
  if (is_hesai(format)) return hesai_parser();
  if (is_ouster(format)) return kOuster;
  return kVelodyne;
}

}  // namespace

void add_return(LaserReturns& returns, PacketReturn found) {
  if (found.counts == 0) return;
  std::size_t at = returns.count;
  for (std::size_t i = 0; i < returns.count; ++i)
    if (returns.all[i].counts == found.counts) return;
  for (; at > 0 && found.counts < returns.all[at - 1].counts; --at)
    returns.all[at] = returns.all[at - 1];
  returns.all[at] = found;
  ++returns.count;
}

LaserShot PacketParser::shot_at(const PacketSensor& sensor, std::string_view /*payload*/,
                                std::size_t /*k*/, const MeasuredColumn& column,
                                std::size_t laser) const {
  const LidarModel& model = sensor.model;
  const std::size_t ring = sensor.ring_of_laser[laser];
  const double late_s = model.firing_times_s.empty() ? 0.0 : model.firing_times_s[ring];
  return {firing_at(model, ring, column.head_rad + column.turn_rad_s * late_s), late_s};
}

PacketDecoder::PacketDecoder(PacketSensor sensor)
    : sensor_(std::move(sensor)),
      parser_(&parser_of(sensor_.format)),
      traits_(parser_->traits(sensor_)) {}

std::uint32_t PacketDecoder::steps_per_turn() const { return parser_->steps_per_turn(sensor_); }

bool PacketDecoder::has_size(std::string_view payload) const {
  return parser_->has_size(sensor_, payload);
}

std::optional<std::string> PacketDecoder::objection(std::string_view payload) const {
  return parser_->objection(sensor_, payload);
}

bool PacketDecoder::is_dual(std::string_view payload) const {
  return parser_->is_dual(sensor_, payload);
}

std::vector<MeasuredColumn> PacketDecoder::columns(std::string_view payload) const {
  return parser_->columns(sensor_, payload);
}

bool PacketDecoder::has_returns(std::string_view payload, std::size_t k) const {
  for (std::size_t laser = 0; laser < sensor_.lasers(); ++laser)
    if (parser_->returns_at(sensor_, payload, k, laser).count > 0) return true;
  return false;
}

void PacketDecoder::add_points(std::string_view payload, std::size_t k,
                               const MeasuredColumn& column, PacketPoints& points) const {
  for (std::size_t laser = 0; laser < sensor_.lasers(); ++laser) {
    const LaserReturns returns = parser_->returns_at(sensor_, payload, k, laser);
    if (returns.count == 0) continue;
    const auto [firing, late_s] = parser_->shot_at(sensor_, payload, k, column, laser);
    const double offset_m = sensor_.range_offsets_m[firing.ring];
    for (std::size_t number = 0; number < returns.count; ++number) {
      const PacketReturn& found = returns.all[number];
      const double range_m = found.counts * sensor_.facts.quantum_m + offset_m;
      points.positions.push_back(vec_cast<double>(firing.origin) +
                                 range_m * vec_cast<double>(firing.direction));
      points.late_s.push_back(late_s);
      points.intensities.push_back(found.intensity);
      points.rings.push_back(firing.ring);
      points.return_numbers.push_back(static_cast<std::uint8_t>(number + 1));
      points.return_counts.push_back(static_cast<std::uint8_t>(returns.count));
    }
  }
}

}  // namespace adasplats
