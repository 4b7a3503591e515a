// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/sensors/packet_decoder.h"

namespace adasplats {

// Private to sensors/: the parts of PacketDecoder that depend on the manufacturer.

static_assert(std::endian::native == std::endian::little, "packets are little-endian");

inline constexpr double kWholeTurn_rad = 2.0 * std::numbers::pi;
inline constexpr double kNanosecondsInOne_s = 1e9;

template <class T>
T value_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

inline std::string hexadecimal(unsigned value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%02X", value);
  return text.data();
}

/// The ray of one laser in one column.
struct LaserShot {
  Firing firing;
  double late_s = 0;  ///< since the start of the column
};

/// The functions are documented in PacketDecoder.
class PacketParser {
 public:
  virtual PacketTraits traits(const PacketSensor& sensor) const = 0;
  virtual std::uint32_t steps_per_turn(const PacketSensor& sensor) const = 0;
  virtual bool has_size(const PacketSensor& sensor, std::string_view payload) const {
    return payload.size() == sensor.payload_bytes();
  }
  virtual std::optional<std::string> objection(const PacketSensor& sensor,
                                               std::string_view payload) const = 0;
  virtual std::optional<std::string> contradiction(const PacketSensor& /*sensor*/,
                                                   std::string_view /*payload*/) const {
    return std::nullopt;
  }
  virtual bool is_dual(const PacketSensor& sensor, std::string_view payload) const = 0;
  virtual std::vector<MeasuredColumn> columns(const PacketSensor& sensor,
                                              std::string_view payload) const = 0;
  virtual LaserReturns returns_at(const PacketSensor& sensor, std::string_view payload,
                                  std::size_t k, std::size_t laser) const = 0;
  /// By the model's beams and firing times.
  virtual LaserShot shot_at(const PacketSensor& sensor, std::string_view payload, std::size_t k,
                            const MeasuredColumn& column, std::size_t laser) const;

 protected:
  ~PacketParser() = default;
};

/// Adds a return unless it is empty or equal to another one; the nearest comes first.
void add_return(LaserReturns& returns, PacketReturn found);

// Static objects; parser_of() in packet_decoder.cpp chooses.
const PacketParser& velodyne_parser();
const PacketParser& ouster_parser();
const PacketParser& hesai_parser();
/// Without optional fields.
std::size_t hesai_payload_bytes(PacketFormat format);
std::size_t hesai_lasers(PacketFormat format);

}  // namespace adasplats
