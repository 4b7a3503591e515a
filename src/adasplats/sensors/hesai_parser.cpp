// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Packets of Hesai sensors: layouts and sources in hesai_bytes.h.

#include <algorithm>
#include <chrono>
#include <cmath>

#include "adasplats/core/words.h"
#include "adasplats/sensors/hesai_bytes.h"
#include "adasplats/sensors/hesai_models.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/packet_parser.h"

namespace adasplats {
namespace {

/// A packet whose size was checked.
class HesaiPacket {
 public:
  HesaiPacket(const PacketSensor& sensor, std::string_view payload)
      : layout_(layout_of(sensor.format)), bytes_(layout_, payload), payload_(payload) {}

  const HesaiLayout& layout() const { return layout_; }
  const HesaiBytes& bytes() const { return bytes_; }
  std::size_t block(std::size_t number) const { return layout_.head + number * bytes_.block; }
  /// Of the rotor or the mirror, degrees.
  double azimuth_deg(std::size_t number) const { return azimuth_steps(number) / kStepsPerDegree; }
  double azimuth_steps(std::size_t number) const {
    const std::size_t at = block(number) + layout_.block_head;
    if (layout_.format == PacketFormat::at_128)
      return value_at<std::uint16_t>(payload_, at - 3) +
             value_at<std::uint8_t>(payload_, at - 1) / 256.0;
    return value_at<std::uint16_t>(payload_, at - 2);
  }
  /// 1 mm: the unit of Hesai's ranges is a whole number of them.
  std::uint32_t unit_mm() const {
    if (layout_.head == 0) return 4;
    return value_at<std::uint8_t>(payload_, layout_.head == kLongHead ? 9 : 5);
  }
  unsigned mode() const { return in_tail<std::uint8_t>(layout_.tail.mode); }
  /// The number of blocks per firing; 0: an unknown mode.
  std::size_t returns() const {
    switch (mode()) {
      case 0x33:
      case 0x34:
      case 0x37:
      case 0x38: return 1;
      case 0x39:
      case 0x3A:
      case 0x3B:
      case 0x3C:
      case 0x3E: return 2;
      case 0x3D: return 3;
      default: return 0;
    }
  }
  std::size_t columns() const { return layout_.blocks / returns(); }
  std::uint32_t micros() const { return in_tail<std::uint32_t>(layout_.tail.micros); }
  /// Degrees per second.
  double speed() const { return 6.0 * in_tail<std::uint16_t>(layout_.tail.speed); }
  std::int64_t time_ns() const { return (seconds() * 1'000'000 + std::int64_t{micros()}) * 1000; }
  /// Of an OT128: whether it measures at twice the resolution, and the state of a block.
  bool is_fine() const { return in_tail<std::uint8_t>(kOperationByte) == 0; }
  unsigned azimuth_state(std::size_t number) const {
    return in_tail<std::uint16_t>(kAzimuthFlagByte) >> (14 - 2 * number) & 3U;
  }
  /// Of a QT128: the firing sequence of a column, 0 or 1.
  unsigned sequence(std::size_t k) const {
    return (in_tail<std::uint8_t>(kModeFlagByte) + k + 1) % 2;
  }
  std::int64_t step_ns() const {
    const bool is_slow = layout_.format == PacketFormat::ot_128 && !is_fine();
    return is_slow ? 2 * layout_.step_ns : layout_.step_ns;
  }

 private:
  template <class T>
  T in_tail(std::size_t at) const {
    return value_at<T>(payload_, bytes_.tail + at);
  }
  /// Since 1970: year (since 1900 or 2000), month, day, hour, minute, second; if the first byte is
  /// 0, big-endian seconds. A sensor without a clock sends zeros.
  std::int64_t seconds() const {
    const auto at = [&](std::size_t i) {
      return unsigned{in_tail<std::uint8_t>(layout_.tail.date + i)};
    };
    if (at(0) == 0 && layout_.head == kLongHead)
      return std::int64_t{at(2)} << 24 | at(3) << 16 | at(4) << 8 | at(5);
    if (at(1) < 1 || at(1) > 12) return 0;
    const auto year = static_cast<int>(at(0) + (at(0) < 70 ? 2000 : 1900));
    const std::chrono::sys_days month{std::chrono::year(year) / static_cast<int>(at(1)) / 1};
    const std::int64_t days = month.time_since_epoch().count() + at(2) - 1;
    return ((days * 24 + at(3)) * 60 + at(4)) * 60 + at(5);
  }

  const HesaiLayout& layout_;
  HesaiBytes bytes_;
  std::string_view payload_;
};

/// "XT32 (protocol 6.1, 32 lasers, 6 blocks)".
std::string description_of(const HesaiLayout& layout) {
  return std::string(layout.name) + " (" +
         (layout.major != 0 ? "protocol " + std::to_string(layout.major) + "." +
                                  std::to_string(layout.minor) + ", "
                            : "") +
         std::to_string(layout.lasers) + " lasers, " + std::to_string(layout.blocks) + " blocks)";
}

std::string known_models() {
  std::string list;
  for (const HesaiLayout& layout : kHesaiLayouts)
    list += (list.empty() ? "" : ", ") + description_of(layout);
  return list;
}

/// Lasers and blocks in the header, and the protocol version, if it has one.
struct HesaiHead {
  unsigned major = 0, minor = 0, lasers = 0, blocks = 0;

  explicit HesaiHead(std::string_view payload) {
    const auto byte = [&](std::size_t at) {
      return unsigned{at < payload.size() ? static_cast<std::uint8_t>(payload[at])
                                          : std::uint8_t{0}};
    };
    lasers = byte(2);
    blocks = byte(3);
    // Protocols number less than the lasers of a Pandar64.
    if (lasers >= 20) return;
    major = lasers;
    minor = blocks;
    lasers = byte(6);
    blocks = byte(7);
  }
};

/// Nothing if a payload is of this model.
std::optional<std::string> objection_to_model(const HesaiLayout& layout, std::string_view payload) {
  if (value_at<std::uint16_t>(payload, 0) == kBlockStart) {
    if (layout.head == 0) return std::nullopt;
    const std::size_t bytes = HesaiBytes(kHesaiLayouts[0], 0U).packet;
    if (payload.size() != bytes && payload.size() != bytes + kSequenceBytes)
      return "begin with 0xFF 0xEE, expected 0xEE 0xFF";
    return "are from Hesai model " + description_of(kHesaiLayouts[0]) + ", expected " +
           description_of(layout);
  }
  const HesaiHead head(payload);
  if (head.major == layout.major && head.minor == layout.minor && head.lasers == layout.lasers &&
      head.blocks == layout.blocks && layout.head != 0) {
    // Hesai's SDK: models with protocol 1.4 differ in the version of their status.
    constexpr std::uint8_t kFirstOfJt128 = 137;
    if (layout.format == PacketFormat::ot_128 &&
        value_at<std::uint8_t>(payload, 4) >= kFirstOfJt128)
      return "are from Hesai model JT128, expected " + description_of(layout);
    return std::nullopt;
  }
  for (const HesaiLayout& other : kHesaiLayouts)
    if (other.head != 0 && other.major == head.major && other.minor == head.minor &&
        other.lasers == head.lasers && other.blocks == head.blocks)
      return "are from Hesai model " + description_of(other) + ", expected " +
             description_of(layout);
  return "have Hesai protocol " + std::to_string(head.major) + "." + std::to_string(head.minor) +
         " with " + std::to_string(head.lasers) + " lasers in " + std::to_string(head.blocks) +
         " blocks; those that are read: " + known_models();
}

std::optional<std::string> objection_to_size(const HesaiLayout& layout, std::string_view payload) {
  const std::size_t expected = HesaiBytes(layout, payload).packet;
  if (payload.size() == expected) return std::nullopt;
  if (layout.head != kLongHead && payload.size() == expected + kSequenceBytes) return std::nullopt;
  return "have " + std::to_string(payload.size()) + " bytes, expected " + std::to_string(expected) +
         " of a " + std::string(layout.name);
}

std::optional<std::string> objection_to_checksums(const HesaiPacket& packet,
                                                  std::string_view payload) {
  if (!packet.layout().has_checksums()) return std::nullopt;
  const HesaiBytes& bytes = packet.bytes();
  const std::size_t head = packet.layout().head;
  if (hesai_checksum(payload.substr(head, bytes.body)) !=
      value_at<std::uint32_t>(payload, head + bytes.body))
    return "have a wrong checksum of their blocks";
  if (hesai_checksum(payload.substr(bytes.tail, bytes.end - bytes.tail)) !=
      value_at<std::uint32_t>(payload, bytes.end))
    return "have a wrong checksum of their tail";
  return std::nullopt;
}

std::optional<std::string> objection_to_blocks(const HesaiPacket& packet,
                                               std::string_view payload) {
  const std::size_t returns = packet.returns();
  double last = 0;
  for (std::size_t block = 0; block < packet.layout().blocks; ++block) {
    const double azimuth = packet.azimuth_steps(block);
    if (packet.layout().head == 0 &&
        value_at<std::uint16_t>(payload, packet.block(block)) != kBlockStart)
      return "do not begin their block " + std::to_string(block) + " with 0xFF 0xEE";
    if (azimuth >= kHesaiSteps)
      return "have an azimuth of " + std::to_string(std::llround(azimuth)) +
             " hundredths of a degree";
    if (block % returns != 0 && azimuth != last)
      return "have several returns per firing, but different azimuths in blocks " +
             std::to_string(block - 1) + " and " + std::to_string(block);
    // A quarter of a turn: azimuths decrease at the end of one.
    if (block != 0 && azimuth < last && azimuth + kHesaiSteps / 4.0 > last)
      return "are from a head that rotates counter-clockwise";
    last = azimuth;
  }
  return std::nullopt;
}

class HesaiParser final : public PacketParser {
 public:
  PacketTraits traits(const PacketSensor& sensor) const override {
    if (sensor.format == PacketFormat::at_128) return {.has_frames = true, .has_pauses = true};
    return {.has_cut = cut_deg(sensor) != 0};
  }
  std::uint32_t steps_per_turn(const PacketSensor& sensor) const override {
    if (sensor.mirror() == nullptr) return kHesaiSteps;
    const MirrorAngles& mirror = *sensor.mirror();
    double longest_deg = 0;
    for (std::size_t frame = 0; frame < mirror.frame_starts.size(); ++frame)
      longest_deg = std::max(
          longest_deg, std::fmod(mirror.frame_ends[frame] - mirror.frame_starts[frame] + 720, 360));
    return static_cast<std::uint32_t>(kStepsPerDegree * longest_deg) + 1;
  }
  bool has_size(const PacketSensor& /*sensor*/, std::string_view payload) const override {
    if (payload.size() < 2) return false;
    const auto start = value_at<std::uint16_t>(payload, 0);
    return start == kPacketStart || start == kBlockStart;
  }
  std::optional<std::string> objection(const PacketSensor& sensor,
                                       std::string_view payload) const override;
  bool is_dual(const PacketSensor& sensor, std::string_view payload) const override {
    return HesaiPacket(sensor, payload).returns() > 1;
  }
  std::vector<MeasuredColumn> columns(const PacketSensor& sensor,
                                      std::string_view payload) const override;
  LaserReturns returns_at(const PacketSensor& sensor, std::string_view payload, std::size_t k,
                          std::size_t laser) const override;
  LaserShot shot_at(const PacketSensor& sensor, std::string_view payload, std::size_t k,
                    const MeasuredColumn& column, std::size_t laser) const override;

 private:
  /// The azimuth at which a sensor file lets revolutions begin, counter-clockwise; 0: unset. Half a
  /// degree is the rotation until the first shot.
  static double cut_deg(const PacketSensor& sensor) {
    const double first_deg = sensor.model.first_azimuth_rad / kWholeTurn_rad * 360;
    return std::fabs(first_deg) > 0.5 ? first_deg : 0;
  }
};

std::optional<std::string> HesaiParser::objection(const PacketSensor& sensor,
                                                  std::string_view payload) const {
  const HesaiLayout& layout = layout_of(sensor.format);
  if (payload.size() < kLongHead) return "have " + std::to_string(payload.size()) + " bytes";
  if (auto objection = objection_to_model(layout, payload)) return objection;
  if (auto objection = objection_to_size(layout, payload)) return objection;
  const HesaiPacket packet(sensor, payload);
  if (auto objection = objection_to_checksums(packet, payload)) return objection;
  if (sensor.format == PacketFormat::qt_128 && (flags_of(layout, payload) & kHasChannelSubset) != 0)
    return "hold selected channels (flags " + hexadecimal(flags_of(layout, payload)) +
           "), which are not read; record all channels";
  if (packet.unit_mm() == 0) return "have a distance unit of 0 mm";
  if (packet.returns() == 0 || layout.blocks % packet.returns() != 0)
    return "have return mode " + hexadecimal(packet.mode()) +
           ", expected 0x33, 0x34, 0x37, 0x38 (single), 0x39 to 0x3C or 0x3E (dual)";
  if (packet.micros() > 1'000'000)
    return "have a time of " + std::to_string(packet.micros()) + " us within a second";
  return objection_to_blocks(packet, payload);
}

std::vector<MeasuredColumn> HesaiParser::columns(const PacketSensor& sensor,
                                                 std::string_view payload) const {
  const HesaiPacket packet(sensor, payload);
  const HesaiLayout& layout = packet.layout();
  const std::size_t count = packet.columns();
  const double cut_steps = kStepsPerDegree * (90 - cut_deg(sensor));
  std::vector<MeasuredColumn> columns;
  for (std::size_t k = 0; k < count; ++k) {
    const double azimuth_deg = packet.azimuth_deg(k * packet.returns());
    const auto later = layout.counts_on
                           ? static_cast<std::int64_t>(k)
                           : static_cast<std::int64_t>(k) - static_cast<std::int64_t>(count - 1);
    const double turned_deg =
        packet.speed() * static_cast<double>(layout.first_shot_ns) / kNanosecondsInOne_s;
    MeasuredColumn column;
    column.lasts_ns = packet.step_ns();
    column.time_ns =
        packet.time_ns() + layout.block_ns + layout.first_shot_ns + later * packet.step_ns();
    // The maker's azimuths are clockwise from +y.
    column.head_rad = (90 - azimuth_deg - turned_deg) / 360 * kWholeTurn_rad;
    column.turn_rad_s = -packet.speed() / 360 * kWholeTurn_rad;
    if (sensor.mirror() != nullptr) {
      const MirrorAngles& mirror = *sensor.mirror();
      const std::size_t frame = mirror.frame_of(azimuth_deg);
      column.is_valid = frame < mirror.frame_starts.size();
      column.frame = static_cast<std::uint32_t>(frame);
      if (column.is_valid)
        column.step = static_cast<std::uint32_t>(
            kStepsPerDegree * std::fmod(azimuth_deg - mirror.frame_starts[frame] + 720, 360));
    } else {
      const double since_cut = std::fmod(
          kStepsPerDegree * azimuth_deg - cut_steps + 2.0 * kHesaiSteps + 1e-6, kHesaiSteps);
      column.step = static_cast<std::uint32_t>(since_cut);
    }
    columns.push_back(column);
  }
  return columns;
}

LaserReturns HesaiParser::returns_at(const PacketSensor& sensor, std::string_view payload,
                                     std::size_t k, std::size_t laser) const {
  const HesaiPacket packet(sensor, payload);
  LaserReturns returns;
  for (std::size_t number = 0; number < packet.returns(); ++number) {
    const std::size_t at = packet.block(k * packet.returns() + number) +
                           packet.layout().block_head + laser * packet.bytes().unit;
    add_return(returns, {packet.unit_mm() * value_at<std::uint16_t>(payload, at),
                         value_at<std::uint8_t>(payload, at + 2)});
  }
  return returns;
}

LaserShot HesaiParser::shot_at(const PacketSensor& sensor, std::string_view payload, std::size_t k,
                               const MeasuredColumn& column, std::size_t laser) const {
  const HesaiPacket packet(sensor, payload);
  const std::size_t ring = sensor.ring_of_laser[laser];
  LaserShot shot;
  switch (sensor.format) {
    case PacketFormat::qt_128: shot.late_s = late_s_of_qt128(packet.sequence(k), laser); break;
    case PacketFormat::ot_128:
      shot.late_s = late_s_of_ot128(sensor.model.firing_times_s[ring], packet.is_fine(),
                                    packet.azimuth_state(k * packet.returns()), laser);
      break;
    case PacketFormat::at_128: {
      shot.late_s = late_s_of_at128(laser);
      const MirrorAngles::Angles angles =
          sensor.mirror()->at(laser, column.frame, packet.azimuth_deg(k * packet.returns()));
      shot.firing.direction = direction_of(radians(90 - angles.azimuth), radians(angles.elevation));
      shot.firing.ring = static_cast<std::uint16_t>(ring);
      return shot;
    }
    default: return PacketParser::shot_at(sensor, payload, k, column, laser);
  }
  shot.firing = firing_at(sensor.model, ring, column.head_rad + column.turn_rad_s * shot.late_s);
  return shot;
}

}  // namespace

const PacketParser& hesai_parser() {
  static constexpr HesaiParser kHesai;
  return kHesai;
}

std::size_t hesai_payload_bytes(PacketFormat format) {
  return HesaiBytes(layout_of(format), 0U).packet;
}

std::size_t hesai_lasers(PacketFormat format) { return layout_of(format).lasers; }

}  // namespace adasplats
