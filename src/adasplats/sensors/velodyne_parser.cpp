// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Velodyne's packets: byte offsets and sources in packet_bytes.h.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "adasplats/core/words.h"
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

/// A VLP-16 Hi-Res has the packets of a VLP-16 and beams up to 10 degrees instead of 15 (its
/// addendum 63-9318 to the manual).
std::optional<std::string> objection_to_hi_res(const LidarModel& sensor, std::uint8_t model) {
  constexpr std::uint8_t kUsual = 0x22, kHiRes = 0x24;
  constexpr double kBetween_rad = 12.5 * std::numbers::pi / 180;
  const bool is_hi_res = std::ranges::max(sensor.elevations_rad) < kBetween_rad;
  if (model == kHiRes && !is_hi_res)
    return "are from a VLP-16 Hi-Res (0x24), whose beams end at 10 degrees; give its calibration";
  if (model == kUsual && is_hi_res)
    return "are from a VLP-16 (0x22), whose beams end at 15 degrees, not from a Hi-Res";
  return std::nullopt;
}

/// Checks the factory bytes of sensors other than the HDL-64E: return mode and model.
std::optional<std::string> objection_to_factory(const PacketSensor& sensor,
                                                std::string_view payload) {
  constexpr std::uint8_t kStrongest = 0x37, kLast = 0x38;
  constexpr std::pair<PacketFormat, std::uint8_t> kModels[] = {{PacketFormat::hdl_32e, 0x21},
                                                               {PacketFormat::vlp_16, 0x22},
                                                               {PacketFormat::vlp_16, 0x24},
                                                               {PacketFormat::vlp_32c, 0x28},
                                                               {PacketFormat::vls_128, 0xA1}};
  const auto mode = value_at<std::uint8_t>(payload, kVelodyneTail + 4);
  const auto model = value_at<std::uint8_t>(payload, kVelodyneTail + 5);
  constexpr std::uint8_t kHdl32e = 0x21;
  for (const auto& [other, code] : kModels)
    if (code == model && other != sensor.format && !(sensor.states_hdl_32e && model == kHdl32e))
      return "are from model " + hexadecimal(model) + ", " +
             std::string(word_of(other, kPacketFormats));
  if (sensor.format == PacketFormat::vlp_16)
    if (auto objection = objection_to_hi_res(sensor.model, model)) return objection;
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
  return objection_to_factory(sensor, payload);
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

/// Rotation of the head from each firing block to the next, in steps. A sensor set to part of the
/// view (Field of View in the manuals) measures nothing elsewhere, and a packet can contain the end
/// of one revolution and the start of the next.
struct HeadSteps {
  double usual = 0;           ///< without the pauses
  double pause_s = 0;         ///< duration of a turn of one step in a pause
  std::vector<double> turns;  ///< from each block to the next

  bool is_pause(std::size_t block) const {
    constexpr double kMost = 4;  // rotation rates differ by less
    return turns[block] > kMost * nominal_ + 1;
  }

  /// `azimuths` of the blocks; `nominal` steps and `block_s` between two of them.
  HeadSteps(const std::vector<std::uint32_t>& azimuths, double nominal, double block_s)
      : nominal_(nominal) {
    std::size_t count = 0;
    for (std::size_t block = 0; block + 1 < azimuths.size(); ++block) {
      turns.push_back((azimuths[block + 1] + kAzimuthSteps - azimuths[block]) % kAzimuthSteps);
      if (is_pause(block)) continue;
      usual += turns.back();
      ++count;
    }
    usual = count == 0 ? nominal : usual / static_cast<double>(count);
    // Rates are set in revolutions per second, which says more than a few rounded azimuths.
    const double rate_hz = std::max(1.0, std::round(usual / (kAzimuthSteps * block_s)));
    pause_s = 1 / (rate_hz * kAzimuthSteps);
  }

 private:
  double nominal_;
};

std::vector<MeasuredColumn> VelodyneParser::columns(const PacketSensor& sensor,
                                                    std::string_view payload) const {
  const std::size_t lasers = sensor.lasers(), apart = blocks_of_firing(lasers);
  const std::size_t firings_of_block = std::max<std::size_t>(1, kBlockChannels / lasers);
  const VelodyneBlocks blocks{sensor.format, is_dual(sensor, payload)};
  const double first_steps = -sensor.model.first_azimuth_rad / kWholeTurn_rad * kAzimuthSteps;
  const auto micros = value_at<std::uint32_t>(payload, kVelodyneTail);
  std::vector<std::uint32_t> azimuths;
  for (std::size_t block = 0; block + apart <= blocks.count(); block += apart)
    azimuths.push_back(azimuth_of_block(payload, blocks.first(block)));
  const auto parts = static_cast<double>(firings_of_block);
  // The last block repeats the step of the previous one.
  double turned = static_cast<double>(kAzimuthSteps) / sensor.model.columns * parts;
  const HeadSteps head(azimuths, turned, sensor.column_s() * parts);
  double paused_s = 0;
  std::vector<MeasuredColumn> columns;
  for (std::size_t block = 0; block < azimuths.size(); ++block) {
    const bool pauses = block < head.turns.size() && head.is_pause(block);
    if (block < head.turns.size()) turned = pauses ? head.usual : head.turns[block];
    for (std::size_t part = 0; part < firings_of_block; ++part) {
      const double per_firing = turned / parts;
      const double steps = azimuths[block] + static_cast<double>(part) * per_firing;
      // Rounding must not move step 0 to the end of the previous revolution.
      double since_begin = std::fmod(steps - first_steps + 1e-6, kAzimuthSteps);
      if (since_begin < 0) since_begin += kAzimuthSteps;
      MeasuredColumn column;
      column.time_ns =
          std::int64_t{micros} * 1000 - stamp_after_first_ns(sensor.format) +
          std::llround((static_cast<double>(columns.size()) * sensor.column_s() + paused_s) *
                       kNanosecondsInOne_s);
      column.head_rad = -steps / kAzimuthSteps * kWholeTurn_rad;
      column.turn_rad_s = -per_firing / kAzimuthSteps * kWholeTurn_rad / sensor.column_s();
      column.step = static_cast<std::uint32_t>(since_begin);
      columns.push_back(column);
    }
    if (pauses) paused_s += (head.turns[block] - head.usual) * head.pause_s;
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

}  // namespace

const PacketParser& velodyne_parser() {
  static constexpr VelodyneParser kVelodyne;
  return kVelodyne;
}

}  // namespace adasplats
