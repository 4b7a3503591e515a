// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/sensors/packet_decoder.h"

namespace adasplats {

// Private to sensors/: the manufacturers' formats behind PacketDecoder.

/// The part of PacketDecoder that depends on the manufacturer; its functions are documented there.
class PacketParser {
 public:
  virtual std::uint32_t steps_per_turn(const PacketSensor& sensor) const = 0;
  virtual bool has_full_time() const = 0;
  virtual bool numbers_revolutions() const = 0;
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

 protected:
  ~PacketParser() = default;
};

// Static objects; parser_of() in packet_decoder.cpp chooses.
const PacketParser& velodyne_parser();
const PacketParser& ouster_parser();

/// Adds a return unless it is empty or equal to the first one; the nearer one comes first.
void add_return(LaserReturns& returns, PacketReturn found);

}  // namespace adasplats
